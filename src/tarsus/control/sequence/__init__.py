"""Timed sequences of joint motions, and how they are played."""
