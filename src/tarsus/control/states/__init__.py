"""The states of the robot, what it does in each, and the command that holds across them."""
