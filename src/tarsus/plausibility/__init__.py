"""Plausibility of robots: values that no real robot has, with their likely cause, and the gaits that are possible."""
