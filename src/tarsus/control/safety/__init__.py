"""The guard: an independent monitor of joint angles."""
