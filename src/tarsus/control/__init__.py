"""How the robot moves, tick by tick: from a command and sensor readings to joint angles."""
