"""Felt ground: contacts of the feet, their vertical motion, height and tilt of the body, support."""
