"""The name of the environment in Gymnasium's registry."""

from __future__ import annotations

import gymnasium

__all__ = ["EPISODE_STEPS", "WALK", "register_walk"]

WALK = "tarsus/Walk-v0"
"""Name of the environment."""

EPISODE_STEPS = 500
"""Steps of an episode: 10 s."""


def register_walk() -> None:
    """Register the environment, once."""
    if WALK not in gymnasium.registry:
        home = "tarsus.simulation.environment"
        gymnasium.register(
            id=WALK,
            entry_point=f"{home}.walk_env:WalkEnv",
            vector_entry_point=f"{home}.walk_vector_env:WalkVectorEnv",
            max_episode_steps=EPISODE_STEPS,
        )
