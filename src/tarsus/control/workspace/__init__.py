"""Foot workspaces of a stance, its stability, and the velocities and cycle times that they allow."""
