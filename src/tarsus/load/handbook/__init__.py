"""Source 004's hand calculation of torques, line by line, and beside the statics."""
