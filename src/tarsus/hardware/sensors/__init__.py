"""Sensors beside the servos."""
