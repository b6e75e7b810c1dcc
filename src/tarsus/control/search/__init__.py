"""Feet that find no ground, or are stopped by an obstacle: where they step instead."""
