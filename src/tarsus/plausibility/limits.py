"""Plausibility of joint limits: units, zeros and signs."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tarsus.plausibility.dimensions import Dimensions, wrapped
from tarsus.plausibility.mirror import mirror_partners
from tarsus.plausibility.warning import PlausibilityWarning
from tarsus.robot.robot import JOINTS, Robot

__all__ = ["limit_warnings"]

# Limits within the first, a whole turn in radians, look like radians, except ranges narrower than the second, which are
# those of a locked joint [deg].
_TURN, _LEAST_SPAN = 6.3, 0.2
# A joint that turns this far can be mounted with any zero [deg].
FREE_SPAN = 300.0
# Middle of the range of each joint, from the presets with a margin: the leg must point outward, the femur must be able
# to rise, the tibia to hang down, in the middle of its range or at its lower limit [deg].
MOST_COXA_MIDDLE = 60.0
FEMUR_MIDDLE = (-30.0, 65.0)
MOST_TIBIA_MIDDLE, LEAST_TIBIA = -25.0, -120.0
# Middles of the range that a corrected zero or sign may give [deg].
_USUAL_FEMUR = (-30.0, 50.0)
_USUAL_TIBIA = (-115.0, -35.0)
# Greatest deviation of a coxa range from the mirror image of the opposite leg's, where both ranges are alike [deg].
MOST_CHIRALITY = 30.0


def limit_warnings(robot: Robot, size: Dimensions) -> Iterator[PlausibilityWarning]:
    """Yield the warnings on the joint limits of a single robot."""
    in_radians = [joint for joint in range(3) if _looks_like_radians(size, joint)]
    if in_radians:
        yield _radians(size, in_radians)
    middle, span = np.median(size.middle, axis=0), np.median(size.span, axis=0)
    checked = [joint for joint in range(3) if joint not in in_radians and span[joint] < FREE_SPAN]
    if 0 in checked:
        yield from _coxa(robot, size)
    if 1 in checked and not FEMUR_MIDDLE[0] <= middle[1] <= FEMUR_MIDDLE[1]:
        yield _femur(size)
    lowest = float(np.median(size.limits[:, 2, 0]))
    if 2 in checked and middle[2] > MOST_TIBIA_MIDDLE and lowest > LEAST_TIBIA:
        yield _tibia(size)


def _looks_like_radians(size: Dimensions, joint: int) -> bool:
    span = float(np.median(size.span[:, joint]))
    return span >= _LEAST_SPAN and bool(np.abs(size.limits[:, joint]).max() <= _TURN)


def _range(low: float, high: float) -> str:
    return f"{low:.4g} to {high:.4g}"


def _median(size: Dimensions, joint: int) -> tuple[float, float]:
    low, high = np.median(size.limits[:, joint], axis=0)
    return float(low), float(high)


def _radians(size: Dimensions, joints: list[int]) -> PlausibilityWarning:
    names = ", ".join(JOINTS[joint] for joint in joints)
    low, high = _median(size, joints[0])
    return PlausibilityWarning(
        code="limits-unit",
        where=f"limits_deg of {names}",
        what=f"{_range(low, high)} deg: no joint turns farther than {_TURN:g} deg from zero",
        cause=f"these look like radians: {high:.4g} rad is {np.degrees(high):.4g} deg",
        remedy=f"In degrees they would be {_range(float(np.degrees(low)), float(np.degrees(high)))}",
    )


def _coxa(robot: Robot, size: Dimensions) -> Iterator[PlausibilityWarning]:
    middle = size.middle[:, 0]
    if np.abs(middle).max() > MOST_COXA_MIDDLE:
        worst = int(np.abs(middle).argmax())
        low, high = (float(limit) for limit in size.limits[worst, 0])
        about = f"The range should be about zero, such as {_range(low - middle[worst], high - middle[worst])}"
        if (np.abs(wrapped(middle - size.yaw)) < 40).all():
            cause = "the angles are measured from the body's forward direction"
            remedy = f"A coxa angle of 0 is the leg's own direction, yaw_deg: subtract it. {about}"
        elif float(np.ptp(middle)) < 25:
            cause = f"the middle of the servo's range is taken as {middle[worst]:.4g}, as in a servo range of 0 to 180"
            remedy = f"Subtract {middle[worst]:.4g}. {about}"
        else:
            cause = "the angles are measured from a direction other than the leg's own, yaw_deg"
            remedy = about
        yield PlausibilityWarning(
            code="limits-zero",
            where=f"{robot.leg_names[worst]}: limits_deg.coxa",
            what=f"{_range(low, high)} deg: the middle is {middle[worst]:.4g} deg from the leg's own direction, more "
            f"than {MOST_COXA_MIDDLE:g}",
            cause=cause,
            remedy=remedy,
        )
        return
    for leg, other in enumerate(mirror_partners(size)):
        if other is None or other <= leg:
            continue
        chirality = abs(float(middle[leg] + middle[other]))
        if chirality > MOST_CHIRALITY and abs(middle[leg] - middle[other]) < MOST_CHIRALITY / 3:
            low, high = (float(limit) for limit in size.limits[leg, 0])
            yield PlausibilityWarning(
                code="limits-mirror",
                where=f"{robot.leg_names[leg]}, {robot.leg_names[other]}: limits_deg.coxa",
                what=f"both {_range(low, high)} deg: one leg swings farther forward, the other farther backward, by "
                f"{chirality:.4g} deg",
                cause="the limits of one side were copied to the other with the sign of that side",
                remedy="Coxa angles are counter-clockwise on both sides: the mirror image is "
                f"{_range(-high, -low)} deg",
            )


# Other zeros and signs of femur and tibia: the sign and the offset [deg] that convert to ours, and a description.
_FEMUR_CONVENTIONS = (
    (-1, 0, "positive angles lower the foot"),
    (1, -90, "zero is the femur straight down, or the range of the servo, 0 to 180"),
    (1, 90, "zero is the femur straight up"),
    (-1, 90, "zero is the femur straight up, and positive angles lower the foot"),
    (-1, -90, "zero is the femur straight down, and positive angles lower the foot"),
)
_TIBIA_CONVENTIONS = (
    (-1, 0, "positive angles bend the knee"),
    (1, -90, "zero is the tibia at a right angle to the femur"),
    (1, -180, "the angle is the one inside the knee, 180 for a straight leg"),
    (-1, -90, "zero is the tibia at a right angle to the femur, and positive angles bend the knee"),
)


def _femur(size: Dimensions) -> PlausibilityWarning:
    low, high = _median(size, 1)
    return _convention(
        size,
        joint=1,
        what=f"{_range(low, high)} deg: the middle is {(low + high) / 2:.4g} deg from level, outside "
        f"{_range(*FEMUR_MIDDLE)} deg",
        conventions=_FEMUR_CONVENTIONS,
        usual=_USUAL_FEMUR,
        ours="At 0 the femur is level; positive angles lift the foot",
    )


def _tibia(size: Dimensions) -> PlausibilityWarning:
    low, high = _median(size, 2)
    return _convention(
        size,
        joint=2,
        what=f"{_range(low, high)} deg: the tibia of a standing leg is near -100 deg, and these limits bend it more "
        "upward than downward"
        if low + high > 0
        else f"{_range(low, high)} deg: the tibia of a standing leg is near -100 deg, and these limits keep it above "
        f"{low:.4g} deg",
        conventions=_TIBIA_CONVENTIONS,
        usual=_USUAL_TIBIA,
        ours="At 0 the leg is straight; positive angles lift the foot, so that a bent knee is negative",
    )


def _convention(
    size: Dimensions,
    *,
    joint: int,
    what: str,
    conventions: tuple[tuple[int, int, str], ...],
    usual: tuple[float, float],
    ours: str,
) -> PlausibilityWarning:
    """Return the warning, with those other zeros and signs for which the range would be a usual one."""
    low, high = _median(size, joint)
    centre = (usual[0] + usual[1]) / 2
    fitting = []
    for sign, offset, words in conventions:
        ends = sorted((sign * low + offset, sign * high + offset))
        middle = sum(ends) / 2
        # The converted range may exceed -180 by up to 10, and is clipped there.
        if usual[0] <= middle <= usual[1] and ends[0] >= -190:
            fitting.append((abs(middle - centre), words, _range(max(ends[0], -180.0), ends[1])))
    fitting.sort()
    causes = "; or ".join(f"{words} (then {ends} deg here)" for _, words, ends in fitting)
    return PlausibilityWarning(
        code="limits-zero",
        where=f"limits_deg.{JOINTS[joint]}",
        what=what,
        cause=f"a different zero or sign: {causes}" if causes else "a different zero or sign of the angle",
        remedy=f"{ours}; tarsus robots convert-limits converts those of common firmware",
    )
