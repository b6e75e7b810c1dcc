"""Kinematics: leg points, inverse kinematics, support polygon, resting pose."""
