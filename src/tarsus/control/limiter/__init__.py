"""Twist limiters: each returns how much of the commanded twist it allows."""
