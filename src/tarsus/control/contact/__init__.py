"""Which feet bear load, where they are, and whether they hold the robot."""
