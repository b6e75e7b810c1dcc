"""Plausibility of the legs' directions: legs that point inward, and the error in yaw_deg that explains it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from tarsus.plausibility.dimensions import Dimensions, wrapped
from tarsus.plausibility.mirror import mirror_partners
from tarsus.plausibility.warning import PlausibilityWarning
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["direction_warnings"]

# A leg points inward if it points to the other side by more than the first, or to the other end by more than the second
# of these angles [deg].
MOST_ACROSS, MOST_BACK = 15.0, 30.0
# Legs nearer to the middle than these shares of the farthest leg's distance belong to neither side, or neither end.
_MIDDLE = 0.3, 0.5
# Greatest deviation of a leg's direction from the mirror image of the opposite leg's [deg].
MOST_YAW_DIFFERENCE = 20.0
# Horizontal distance of a standing foot from the femur axis, over the length of femur and tibia.
_STANDING = 0.5
# A whole turn in radians: angles that do not exceed it may have been typed in radians.
RADIANS = 6.3


def direction_warnings(robot: Robot, size: Dimensions) -> Iterator[PlausibilityWarning]:
    """Yield the warnings on the directions of the legs of a single robot."""
    yaw = np.degrees(np.asarray(robot.mount_yaw, dtype=np.float64))
    if yaw.any() and np.abs(yaw).max() <= RADIANS:
        yield PlausibilityWarning(
            code="yaw-unit",
            where="legs.yaw_deg",
            what=f"all legs point within {np.abs(yaw).max():.3g} deg of straight ahead",
            cause=f"these look like radians: {np.abs(yaw).max():.3g} rad is {np.degrees(np.abs(yaw).max()):.4g} deg",
            remedy="yaw_deg is in degrees: 0 is forward, 90 is left",
        )
        return
    inward = _inward(size, size.yaw)
    if inward.any():
        yield from _why_inward(robot, size, inward)
    else:
        yield from _differing(robot, size)
        yield from _crossing(robot, size)


def _inward(size: Dimensions, yaw: Float[np.ndarray, "legs"]) -> Bool[np.ndarray, "legs"]:
    """Return which legs point to the other side or the other end of the robot."""
    position = size.position - size.position.mean(axis=0)
    share = position / np.maximum(np.abs(position).max(axis=0), 1e-9)
    x, y = np.cos(np.radians(yaw)), np.sin(np.radians(yaw))
    across = (np.abs(share[:, 1]) > _MIDDLE[0]) & (y * np.sign(share[:, 1]) < -np.sin(np.radians(MOST_ACROSS)))
    back = (np.abs(share[:, 0]) > _MIDDLE[1]) & (x * np.sign(share[:, 0]) < -np.sin(np.radians(MOST_BACK)))
    return np.asarray(across | back)


# Errors in the yaw of all legs: the corrected angles, the cause, the remedy; tried in this order.
_Correction = Callable[[Dimensions], "Float[np.ndarray, 'legs']"]
_SYSTEMATIC: tuple[tuple[_Correction, str, str], ...] = (
    (
        lambda size: -size.yaw,
        "the angles are clockwise",
        "yaw_deg is counter-clockwise seen from above: left legs have positive angles. Change all signs",
    ),
    (
        lambda size: np.where(size.position[:, 1] < 0, -size.yaw, size.yaw),
        "the right legs have the angles of the left ones",
        "Legs on the right have negative angles: change the signs of those at negative y",
    ),
    (
        lambda size: size.yaw + 180,
        "the angles point from the foot to the body",
        "yaw_deg points from the coxa axis outward: add 180",
    ),
    (
        lambda size: size.yaw + 90,
        "the angles are measured from the left, or y points forward",
        "yaw_deg is 0 forward and 90 left: add 90",
    ),
    (
        lambda size: size.yaw - 90,
        "the angles are measured from the right",
        "yaw_deg is 0 forward and 90 left: subtract 90",
    ),
    (
        lambda size: _outward(size) + size.yaw,
        "the angles are measured from each leg's own direction outward",
        "yaw_deg is measured from the body's forward direction, for all legs",
    ),
)


def _outward(size: Dimensions) -> Float[np.ndarray, "legs"]:
    x, y = (size.position - size.position.mean(axis=0)).T
    return np.asarray(np.degrees(np.arctan2(y, x)))


def _why_inward(robot: Robot, size: Dimensions, inward: Bool[np.ndarray, "legs"]) -> Iterator[PlausibilityWarning]:
    if inward.sum() > 1:
        exchanged = _exchanged(size, inward)
        if exchanged:
            names = " and ".join(robot.leg_names[leg] for leg in exchanged)
            yield _warning(robot, size, inward, f"the angles of {names} are exchanged", "Exchange them")
            return
        for corrected, cause, remedy in _SYSTEMATIC:
            if not _inward(size, corrected(size)).any():
                yield _warning(robot, size, inward, cause, remedy)
                return
    for leg in np.flatnonzero(inward):
        one = np.arange(robot.legs) == leg
        flipped, turned = -size.yaw[leg], wrapped(size.yaw[leg : leg + 1] + 180)[0]
        options = [(flipped, "its sign is wrong")] * (abs(flipped) not in (0, 180)) + [(turned, "it is off by 180 deg")]
        fitting = [
            (angle, why) for angle, why in options if not _inward(size, np.where(one, angle, size.yaw))[leg]
        ] or [(_outward(size)[leg], "it belongs to another leg")]
        causes = " or ".join(why for _, why in fitting)
        angles = " or ".join(f"{angle:.4g}" for angle, _ in fitting)
        yield _warning(robot, size, one, causes, f"The leg would point outward at {angles} deg")


def _exchanged(size: Dimensions, inward: Bool[np.ndarray, "legs"]) -> tuple[int, int] | None:
    """Return the two legs that point inward, if both point outward with each other's angle, else None."""
    legs = [int(leg) for leg in np.flatnonzero(inward)]
    if len(legs) != 2:
        return None
    swapped = size.yaw.copy()
    swapped[legs] = swapped[legs[::-1]]
    if _inward(size, swapped).any() or any(off > MOST_YAW_DIFFERENCE for off in _asymmetry(size, swapped).values()):
        return None
    return legs[0], legs[1]


def _warning(
    robot: Robot, size: Dimensions, inward: Bool[np.ndarray, "legs"], cause: str, remedy: str
) -> PlausibilityWarning:
    names = [name for name, is_inward in zip(robot.leg_names, inward, strict=True) if is_inward]
    angles = ", ".join(f"{angle:.4g}" for angle in size.yaw[inward])
    many = len(names) > 1
    return PlausibilityWarning(
        code="leg-inward",
        where=f"{', '.join(names)}: yaw_deg",
        what=f"at {angles} deg {'these legs point' if many else 'this leg points'} inward, through the body or across "
        f"{'other legs' if many else 'another leg'}",
        cause=cause,
        remedy=remedy,
    )


def _asymmetry(size: Dimensions, yaw: Float[np.ndarray, "legs"]) -> dict[tuple[int, int], float]:
    """Return, for each pair of opposite legs, how far their directions are from being mirror images [deg]."""
    pairs = [(leg, other) for leg, other in enumerate(mirror_partners(size)) if other is not None and leg < other]
    return {(leg, other): abs(float(wrapped(yaw[[leg]] + yaw[[other]])[0])) for leg, other in pairs}


def _differing(robot: Robot, size: Dimensions) -> Iterator[PlausibilityWarning]:
    """Warn of legs whose direction is not the mirror image of the opposite leg's, if most legs are symmetric."""
    off = _asymmetry(size, size.yaw)
    wrong = [pair for pair in off if off[pair] > MOST_YAW_DIFFERENCE]
    if 2 * len(wrong) > len(off):
        return
    for pair in wrong:
        astray = np.abs(wrapped(size.yaw - _outward(size)))
        leg = max(pair, key=lambda one: float(astray[one]))
        other = pair[0] + pair[1] - leg
        yield PlausibilityWarning(
            code="leg-differs",
            where=f"{robot.leg_names[leg]}: yaw_deg",
            what=f"{size.yaw[leg]:.4g} deg, while {robot.leg_names[other]} on the other side has "
            f"{size.yaw[other]:.4g} deg: {off[pair]:.3g} deg from its mirror image, more than {MOST_YAW_DIFFERENCE:g}",
            cause="a typing error in one of the two, such as a missing digit",
            remedy=f"The mirror image is {-size.yaw[other]:.4g} deg",
        )


def _crossing(robot: Robot, size: Dimensions) -> Iterator[PlausibilityWarning]:
    """Warn of two legs that cross each other where they stand, each pointing in its own direction."""
    angle = np.radians(size.yaw)
    foot = size.position + (size.coxa + _STANDING * size.reach) * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    for leg in range(robot.legs):
        for other in range(leg):
            if _cross(size.position[other], foot[other], size.position[leg], foot[leg]):
                names = f"{robot.leg_names[other]}, {robot.leg_names[leg]}"
                yield PlausibilityWarning(
                    code="legs-cross",
                    where=f"{names}: yaw_deg",
                    what=f"pointing at {size.yaw[other]:.4g} and {size.yaw[leg]:.4g} deg, these legs cross each other",
                    cause="the angle of one of the two is wrong, or their positions are exchanged",
                    remedy="Neighbouring legs point apart or are parallel",
                )


def _cross(
    a: Float[np.ndarray, "2"], b: Float[np.ndarray, "2"], c: Float[np.ndarray, "2"], d: Float[np.ndarray, "2"]
) -> bool:
    """Return whether the lines from a to b and from c to d have a point in common."""

    def side(p: Float[np.ndarray, "2"], q: Float[np.ndarray, "2"], r: Float[np.ndarray, "2"]) -> float:
        return float((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]))

    return side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0
