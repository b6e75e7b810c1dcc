"""Stance transitions: another gait, posture or pace, planned incrementally while the robot walks."""
