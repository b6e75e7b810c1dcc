"""Where each foot may be while the robot walks, and how fast that lets it walk."""
