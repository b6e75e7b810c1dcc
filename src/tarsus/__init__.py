"""Tarsus: the toolkit for six-legged robots."""
