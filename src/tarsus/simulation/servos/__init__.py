"""Servo models: from figures of the catalogue to torques at each physics step."""
