"""The ground, as far as it is known, and how the body moves over it."""
