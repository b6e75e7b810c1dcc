"""Gaits, paths and planned motions: pure functions without state."""
