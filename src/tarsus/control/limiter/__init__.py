"""Speed limiters: each returns how much of the commanded twist, or of the walk's time rate, it allows."""
