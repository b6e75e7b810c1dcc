"""Foot workspaces of a stance, and the cycle times that they allow."""
