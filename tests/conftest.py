"""What all tests share: shapes enforced, JAX in double precision, hypothesis without a clock, the same at every run."""

from __future__ import annotations

import os

import jax
from hypothesis import HealthCheck, settings

from shape_enforcement import install

# TARSUS_SHAPES=none leaves the annotations alone, for comparing times.
if os.environ.get("TARSUS_SHAPES") != "none":
    install(("tarsus",))

jax.config.update("jax_enable_x64", True)

settings.register_profile(
    "tarsus", deadline=None, derandomize=True, max_examples=40, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("tarsus")
