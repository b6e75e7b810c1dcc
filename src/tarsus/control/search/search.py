"""Search: a foot that should stand and feels nothing, and what that tells of the ground under it."""

from __future__ import annotations

from typing import NamedTuple

__all__ = ["STANDS", "Search", "hole_depth", "is_level"]

STANDS = 0.02
"""Depth at which the walk stands still, besides how much deeper ground may be [m]."""
# Depth of a foot above which there is a hole, over the body height: at first, and where it has stepped back to; on
# rough ground both are greater by this factor times the depth that the roughness allows.
_DEEP, _DEEP_AGAIN, _ROUGHLY_DEEP = 0.75, 0.4, 1.6
# How far the body is off its attitude at a foot that may hold it: such a foot steps back once, after a long search [m].
_LEANS = 0.02
# A foot that is measured this far above its command is held up by its leg [m]. Where it is at less depth than the
# greater of the next two, over the body height and [m], that leg may rest on the edge of a step.
_HELD_UP, _STEP, _LOW_STEP = 0.007, 0.5, 0.05
# Lift of the body at a foot above which that stands on ground that is not felt: the robot does not tip towards it [m].
_LIFTS = 0.008


class Search(NamedTuple):
    """A foot that should stand and feels nothing.

    Attributes
    ----------
    leg, depth : int, float
        The leg; how far below the expected ground its foot is [m].
    falls, lasts : bool
        Whether the foot is still going down; whether it may search on, as it has not done so for long.
    sunk, raised, leans : float
        How far the body has sunk at the foot since it lost contact; how far the foot is above its command, 0 where that
        is not measured; how much lower the body is there than in the attitude to keep [m].
    age : float
        Age of the contacts [s].
    """

    leg: int
    depth: float
    falls: bool
    lasts: bool
    sunk: float = 0.0
    raised: float = 0.0
    leans: float = 0.0
    age: float = 0.0

    def on_step(self, height: float, scale: float) -> bool:
        """Return whether the leg may rest on the edge of a step.

        Parameters
        ----------
        height, scale : float
            Body height [m]; factor by which lengths are reduced on short legs, 0 to 1.
        """
        return self.raised > scale * _HELD_UP and self.depth - self.raised < max(_STEP * height, scale * _LOW_STEP)

    def tips(self, deep: float, scale: float, *, held: bool) -> bool:
        """Return whether the robot tips at the foot: others do not hold it, or it has sunk or leans far there.

        Parameters
        ----------
        deep, scale, held : float, float, bool
            Depth of a foot that is too low [m]; factor by which lengths are reduced on short legs, 0 to 1; whether the
            feet that stand hold the robot.
        """
        unheld = not held and self.sunk > -scale * _LIFTS and self.depth + max(self.sunk, 0.0) > deep
        return unheld or self.sunk > deep or min(self.leans, self.depth) > deep

    def is_missing(self, height: float, deeper: float, scale: float, *, held: bool, held_up: bool, again: bool) -> bool:
        """Return whether there is no ground at the foot.

        Parameters
        ----------
        height, deeper, scale : float
            Body height; how much deeper ground may be than expected [m]; factor by which lengths are reduced on short
            legs, 0 to 1.
        held, held_up, again : bool
            Whether the feet that stand hold the robot; whether the leg has held the foot up for long; whether the foot
            has stepped to another place.
        """
        # At another place, a foot does not search for long at the end of its reach.
        reached = not self.falls and (self.depth > deeper + scale * STANDS or not self.lasts)
        deep = self.depth - max(self.raised, 0.0) > hole_depth(height, deeper, again=again)
        missing = deep or held_up or (reached if again else not self.lasts)
        level = is_level(self.leans, deeper, scale)
        return missing and (level or (held and not (again or self.lasts)))


def hole_depth(height: float, deeper: float, *, again: bool = False) -> float:
    """Return the depth of a foot above which there is a hole [m].

    Parameters
    ----------
    height, deeper, again : float, float, bool
        As in `Search.is_missing`.
    """
    return (_DEEP_AGAIN if again else _DEEP) * height + _ROUGHLY_DEEP * deeper


def is_level(leans: float, deeper: float, scale: float) -> bool:
    """Return whether the body is near its attitude at a foot, so that the depth of that tells of the ground.

    Parameters
    ----------
    leans, deeper, scale : float
        As in `Search` and `Search.is_missing`.
    """
    return abs(leans) < max(scale * _LEANS, deeper)
