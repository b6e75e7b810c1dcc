"""What all tests share: JAX in double precision, hypothesis without a clock and the same at every run."""

from __future__ import annotations

import jax
from hypothesis import HealthCheck, settings

jax.config.update("jax_enable_x64", True)

settings.register_profile(
    "tarsus", deadline=None, derandomize=True, max_examples=40, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("tarsus")
