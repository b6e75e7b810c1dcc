"""How well a policy follows commands."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from tarsus.errors import InputError
from tarsus.representation import represented

__all__ = ["Evaluation", "evaluate"]


@represented()
class Evaluation(NamedTuple):
    """The result of some episodes.

    Attributes
    ----------
    episodes : int
        Number of episodes.
    reward : float
        Mean reward of a step.
    error : float
        Root mean square of the velocity error: of the vector from the command to the filtered velocity, its components
        as fractions of the top speeds. Steps in the first second after a command don't count; NaN where none are left.
    falls : float
        Fraction of the episodes that ended with a fall.
    reward_terms : dict of str to float
        Mean of each weighted term of the reward.
    """

    episodes: int
    reward: float
    error: float
    falls: float
    reward_terms: dict[str, float]


# Steps after a new command that don't count for the error: one second.
_ADJUSTING = 50


def evaluate(env: Any, policy: Callable[[Any], Any], *, episodes: int = 10, seed: int = 0) -> Evaluation:
    """Run a policy for some episodes, always the same ones for a seed.

    Parameters
    ----------
    env : gymnasium.Env
        ``tarsus/Walk-v0`` with a time limit, as `gymnasium.make` gives it.
    policy : callable
        Returns an action for an observation; its method ``reset``, if it has one, is called at the start of an episode.
    episodes : int
        Number of episodes.
    seed : int
        Seed of the first episode; that of each further episode is greater by one.

    Raises
    ------
    InputError
        If there are no episodes.
    """
    if episodes < 1:
        raise InputError(f"episodes is {episodes}; it must be at least 1")
    rewards, errors, falls = list[dict[str, float]](), list[float](), 0
    for number in range(episodes):
        observation, info = env.reset(seed=seed + number)
        getattr(policy, "reset", lambda: None)()
        before, since, terminated, truncated = info["command"], 0, False, False
        while not (terminated or truncated):
            observation, _, terminated, truncated, info = env.step(policy(observation))
            rewards.append(info["reward_terms"])
            since = since + 1 if np.array_equal(before, info["command"]) else 0
            before = info["command"]
            if since >= _ADJUSTING:
                errors.append(float((((info["velocity"] - info["command"]) / env.unwrapped.top_speeds) ** 2).sum()))
        falls += bool(terminated)
    terms = {name: float(np.mean([each[name] for each in rewards])) for name in rewards[0]}
    error = float(np.sqrt(np.mean(errors))) if errors else float("nan")
    return Evaluation(episodes, sum(terms.values()), error, falls / episodes, terms)
