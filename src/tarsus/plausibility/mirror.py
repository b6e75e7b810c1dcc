"""Mirror symmetry of the legs about the body's x axis."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tarsus.plausibility.dimensions import Dimensions
from tarsus.plausibility.warning import PlausibilityWarning
from tarsus.robot.robot import Robot

__all__ = ["mirror_partners", "position_warnings"]

# Greatest distance of a leg from the mirror image of its partner, in radii of the coxa axes.
MOST_DISTANCE = 0.25


def mirror_partners(size: Dimensions) -> list[int | None]:
    """Return for each leg the leg at its mirror image: itself if it is on the x axis, None where there is none.

    Parameters
    ----------
    size : Dimensions
        Dimensions of the robot.
    """
    image = size.position * np.array([1.0, -1.0])
    distance = np.linalg.norm(image[:, None] - size.position[None], axis=-1)
    nearest = distance.argmin(axis=1)
    bound = MOST_DISTANCE * size.radius
    mutual = nearest[nearest] == np.arange(len(nearest))
    return [int(other) if mutual[leg] and distance[leg, other] <= bound else None for leg, other in enumerate(nearest)]


def position_warnings(robot: Robot, size: Dimensions) -> Iterator[PlausibilityWarning]:
    """Yield a warning if two legs are not mirror images of each other while all the others are."""
    partners = mirror_partners(size)
    alone = [leg for leg, other in enumerate(partners) if other is None]
    if len(alone) == 1:
        # A leg typed near the x axis is its own mirror image.
        level = np.abs(size.position[:, 0] - size.position[alone[0], 0]) < MOST_DISTANCE * size.radius
        alone += [leg for leg, other in enumerate(partners) if other == leg and level[leg]]
    if len(alone) != 2 or np.prod(np.sign(size.position[alone, 1])) >= 0:
        return
    away = np.abs(np.log(np.maximum(np.linalg.norm(size.position, axis=-1), 1e-9) / size.radius))
    leg = max(alone, key=lambda one: float(away[one]))
    other = alone[0] + alone[1] - leg
    shown, opposite = (", ".join(f"{x:.4g}" for x in size.position[one]) for one in (leg, other))
    x, y = size.position[other] * [1, -1]
    yield PlausibilityWarning(
        code="leg-differs",
        where=f"{robot.leg_names[leg]}: position_mm",
        what=f"x, y = {shown} mm, while {robot.leg_names[other]} on the other side is at {opposite} mm; all other legs "
        "have a mirror image",
        cause="a typing error in one of the two, such as a digit too many or missing",
        remedy=f"The mirror image is {x:.4g}, {y:.4g} mm",
    )
