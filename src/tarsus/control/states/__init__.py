"""The states of the robot, and what it does in each."""
