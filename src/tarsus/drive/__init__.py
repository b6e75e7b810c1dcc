"""Driving: what the robot is told over time, and what came of it. So far without servos."""
