"""Transports: how bytes travel between a bus and its servos. No transport knows what the bytes mean."""
