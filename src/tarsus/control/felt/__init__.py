"""A walk that feels the ground: what it does with readings, tick by tick."""
