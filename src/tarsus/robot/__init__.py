"""What the robot is: a value of arrays, its file, the presets and the servo catalogue."""
