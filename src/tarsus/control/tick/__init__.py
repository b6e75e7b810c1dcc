"""The stages of a walk controller's tick, a file for each: validate, estimate, plan, limit, integrate, finish."""
