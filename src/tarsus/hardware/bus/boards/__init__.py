"""Boards that send pulses to analogue or digital servos."""
