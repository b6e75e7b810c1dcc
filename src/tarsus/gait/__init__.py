"""How the robot walks."""
