"""Ground that is felt or given: contacts in time, body motion, support, reach, roughness, slopes, obstacles, holes."""
