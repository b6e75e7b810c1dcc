"""Timelines of commands, and how they are run."""
