"""Servo buses: one protocol, `Bus`, and a module for each kind of servo or board."""
