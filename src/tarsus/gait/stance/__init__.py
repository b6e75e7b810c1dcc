"""Stances: what the footholds of a robot at rest allow, as functions of geometry."""
