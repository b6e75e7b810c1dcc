"""What all tests share: shapes enforced, JAX in double precision, hypothesis without a clock, the same at every run."""

from __future__ import annotations

import os

import jax
import pytest
from hypothesis import HealthCheck, settings

from shape_enforcement import install

# TARSUS_SHAPES=none leaves the annotations alone, for comparing times.
if os.environ.get("TARSUS_SHAPES") != "none":
    install(("tarsus",))

jax.config.update("jax_enable_x64", True)
# Most of the time of a test under JAX is compilation, and what is compiled runs once or twice.
jax.config.update("jax_disable_most_optimizations", True)

settings.register_profile(
    "tarsus", deadline=None, derandomize=True, max_examples=24, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("tarsus")


def pytest_configure(config: pytest.Config) -> None:
    """Register the markers of this project."""
    config.addinivalue_line(
        "markers", "lengthy: many cases of one kind; they run last, and only the first one is measured for coverage"
    )


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put lengthy tests last, and measure coverage in the first case of each: tracing almost doubles their time."""
    seen = set()
    for item in items:
        if item.get_closest_marker("lengthy"):
            test = item.nodeid.partition("[")[0]
            if test in seen:
                item.add_marker("no_cover")
            seen.add(test)
    items.sort(key=lambda item: item.get_closest_marker("lengthy") is not None)
