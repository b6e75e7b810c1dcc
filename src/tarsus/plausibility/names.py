"""Plausibility of the legs' names: left legs at positive y, front legs ahead of rear legs."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tarsus.plausibility.dimensions import Dimensions
from tarsus.plausibility.warning import PlausibilityWarning
from tarsus.robot.leg_words import end_in_name, side_in_name
from tarsus.robot.robot import Robot

__all__ = ["name_warnings"]

# Legs nearer to the middle than this share of the radius of the coxa axes may have any name.
_MIDDLE = 0.1


def name_warnings(robot: Robot, size: Dimensions) -> Iterator[PlausibilityWarning]:
    """Yield a warning for each axis along which names of legs contradict their positions."""
    named = (
        (1, "y", [side_in_name(name) for name in robot.leg_names], "left", "right"),
        (0, "x", [end_in_name(name) for name in robot.leg_names], "front", "rear"),
    )
    # The median, as a single leg typed far away would shift the mean.
    position = size.position - np.median(size.position, axis=0)
    for axis, letter, signs, positive, negative in named:
        sign, at = np.array(signs), position[:, axis]
        wrong = (sign * at < 0) & (np.abs(at) > _MIDDLE * size.radius)
        if not wrong.any():
            continue
        legs = [i for i in range(robot.legs) if wrong[i]]
        every = bool((wrong | (sign == 0)).all())
        yield PlausibilityWarning(
            code="leg-name",
            where=f"{', '.join(robot.leg_names[i] for i in legs)}: name, position_mm",
            what=f"{'these legs lie' if len(legs) > 1 else 'this leg lies'} at {letter} = "
            f"{', '.join(f'{size.position[i, axis]:.4g}' for i in legs)} mm; {positive} legs are at positive {letter}, "
            f"{negative} legs at negative {letter}",
            cause=f"the names of {positive} and {negative} legs are exchanged"
            + (f", or {letter} points in the other direction" if every else ""),
            remedy="x is forward and y is left",
        )
