"""Live walking: from wishes to joint angles, tick by tick."""
