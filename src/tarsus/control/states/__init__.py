"""What the robot does in each of its states."""
