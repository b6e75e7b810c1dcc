"""The stages of a walk controller's tick, a file for each: accept the command, estimate, plan, limit, integrate."""
