"""The loop of a controller and a plant, and its recording."""
