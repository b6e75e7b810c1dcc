"""The calibration of one machine: which servo moves which joint, and how angles become commands."""
