"""Validation of sensor readings, ground plane, foot forces."""
