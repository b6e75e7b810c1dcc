"""Terrains of rising difficulty, and when a robot gets the next one."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any, cast

import numpy as np

from tarsus.errors import InputError
from tarsus.representation import represented
from tarsus.simulation.terrain.flat import Flat
from tarsus.simulation.terrain.protocol import Terrain

__all__ = ["TerrainCurriculum"]

# Fraction of the commanded distance from which on a robot goes up a level, and that below which it goes down.
_UP, _DOWN = 0.8, 0.4


@represented("levels", "level")
class TerrainCurriculum:
    """Chooses the terrain of each episode by how the robot walked in the one before.

    A robot that covers 80 % of the commanded distance without a fall goes up a level; one that falls or covers less
    than 40 % goes down; one that would go up from the last level continues on a random one, and forgets none: the
    scheme of Rudin et al., "Learning to Walk in Minutes Using Massively Parallel Deep Reinforcement Learning" (2021).
    A terrain with a seed gets a new one in each episode.

    Parameters
    ----------
    levels : sequence of Terrain
        From easy to hard; flat ground alone where left out.
    level : int
        The first level.

    Attributes
    ----------
    levels : tuple of Terrain
        The terrains.
    level : int
        The present level.

    Raises
    ------
    InputError
        If there is no level, a level is not a terrain, or the first level does not exist.
    """

    def __init__(self, levels: Sequence[Terrain] = (Flat(),), *, level: int = 0) -> None:
        given: Any = levels
        if not isinstance(given, Sequence) or not given:
            raise InputError(f"the curriculum's levels must be a sequence of at least one terrain, got {given!r}")
        self.levels = tuple(levels)
        for each in self.levels:
            if not isinstance(each, Terrain):
                raise InputError(f"the curriculum's levels must be terrains; {each!r} is none")
        self.go_to(level)

    def go_to(self, level: int) -> None:
        """Go to a level.

        Parameters
        ----------
        level : int
            Its number.

        Raises
        ------
        InputError
            If there is no such level.
        """
        if not 0 <= level < len(self.levels):
            raise InputError(f"level is {level}; the curriculum has the levels 0 to {len(self.levels) - 1}")
        self.level = level

    def finish(self, covered: float, *, fallen: bool, random: np.random.Generator) -> None:
        """Choose the next level after an episode.

        Parameters
        ----------
        covered : float
            Fraction of the commanded distance that was covered.
        fallen : bool
            Whether the robot fell.
        random : numpy.random.Generator
            The random number generator.
        """
        if fallen or covered < _DOWN:
            self.level = max(0, self.level - 1)
        elif covered >= _UP:
            last = self.level == len(self.levels) - 1
            self.level = int(random.integers(len(self.levels))) if last else self.level + 1

    def terrain(self, friction: float, random: np.random.Generator) -> Terrain:
        """Return the terrain of an episode.

        Parameters
        ----------
        friction : float
            Factor for its coefficient of friction.
        random : numpy.random.Generator
            The random number generator, for its seed.
        """
        terrain = self.levels[self.level]
        changes: dict[str, Any] = {} if friction == 1.0 else {"friction": friction * terrain.friction}
        if hasattr(terrain, "seed"):
            changes["seed"] = int(random.integers(2**31))
        if not changes:
            return terrain
        varied: Terrain = dataclasses.replace(cast("Any", terrain), **changes)
        return varied
