"""Limitations that come from the ground and from what is measured of it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.terrain.ground_estimator import GroundEstimate

__all__ = ["GREATEST_TILT", "ground_limitations"]

GREATEST_TILT = math.radians(20.0)
"""Tilt of the measured attitude against the commanded one from which it is reported; as far as levelling corrects."""


def ground_limitations(
    estimate: GroundEstimate | None, without_ground: Iterable[int], names: Sequence[str]
) -> list[Limitation]:
    """Return the limitations from rejected readings, a tilted robot, and feet that find no ground.

    Parameters
    ----------
    estimate : GroundEstimate or None
        The last estimate; None without any feedback.
    without_ground : iterable of int
        The legs whose search for ground has failed.
    names : sequence of str
        The names of the legs.
    """
    found = []
    if estimate is not None:
        found += [Limitation(kind=LimitationKind.READINGS, cause=reason) for reason in estimate.rejected]
        if estimate.tilt > GREATEST_TILT:
            cause = "measured tilt against the commanded attitude"
            kind = LimitationKind.ATTITUDE
            found.append(Limitation(kind=kind, cause=cause, asked=0.0, granted=estimate.tilt, bound=GREATEST_TILT))
    cause = "no ground under the foot, the robot stands still"
    found += [Limitation(kind=LimitationKind.GROUND, cause=cause, leg=names[leg]) for leg in without_ground]
    return found
