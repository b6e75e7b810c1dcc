"""Physics in the studio: terrain, the planned walk simulated, and a driven robot."""
