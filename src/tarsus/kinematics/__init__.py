"""Where the robot's points are."""
