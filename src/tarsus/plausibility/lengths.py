"""Plausibility of lengths: of the legs, of their links to each other, of the coxa axes, the body and the stance."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from tarsus.kinematics.pose import Pose
from tarsus.kinematics.underside import floor_depth
from tarsus.plausibility.dimensions import Dimensions
from tarsus.plausibility.mirror import mirror_partners
from tarsus.plausibility.units import unit_causes
from tarsus.plausibility.warning import PlausibilityWarning
from tarsus.robot.robot import JOINTS, Robot

__all__ = ["LEG_CODES", "length_warnings"]

LEG_CODES = frozenset({"length-unit", "link-ratio"})
"""Codes of the warnings after which other values can't be compared with the length of a leg."""

# Length of a straight leg [mm]: hexapods of 2 g servos have 60, walking machines of 40 kg 1200.
LEG = (45.0, 2000.0)
_USUAL_LEG = (50.0, 1500.0)
# Bounds of ratios, from the presets and published robots with a margin of a factor of 2 or more at either end.
TIBIA_TO_FEMUR = (0.28, 7.0)
MOST_COXA = 1.0
RADIUS_TO_LEG = (0.08, 2.0)
_USUAL_RADIUS = (0.15, 1.3)
BOX_TO_MOUNTS = (0.25, 4.0)
# A body is too high if its height exceeds this share of its longer side, and this multiple of the shorter one.
MOST_BOX_HEIGHT = 0.8, 2.0
MOST_FOOT = 0.35
HEIGHT_TO_REACH = (0.08, 1.0)
SWING_TO_REACH = (0.025, 1.0)
# A link differs from those of the other legs, and from the opposite leg's, if it is at least the first times longer or
# shorter, and the difference over the length of a leg is more than the second.
MOST_LEG_RATIO, LEAST_DIFFERENCE = 3.0, 0.1
# Usual length of a leg over the radius of the coxa axes.
_USUAL_PROPORTION = 2.8


def length_warnings(robot: Robot, size: Dimensions) -> Iterator[PlausibilityWarning]:
    """Yield the warnings on the lengths of a single robot."""
    # Values compared with a doubtful length would be reported for an error that they do not have.
    legs = list(_legs(size)) or list(_links(size))
    yield from legs
    yield from _single_links(robot, size)
    if legs:
        return
    mounts = list(_mounts(size))
    yield from mounts
    boxes = [] if mounts else list(_box(robot, size))
    yield from boxes
    yield from _feet(robot, size)
    heights = list(_heights(robot, size))
    yield from heights
    if not boxes and not heights:
        yield from _body_in_ground(robot)


def _inside(bounds: tuple[float, float], value: float) -> bool:
    return bounds[0] <= value <= bounds[1]


def _legs(size: Dimensions) -> Iterator[PlausibilityWarning]:
    if _inside(LEG, size.leg):
        return
    small = size.leg < LEG[0]
    cause, remedy = unit_causes(size.leg, lambda factor: _inside(_USUAL_LEG, size.leg * factor), too_small=small)
    bound = f"less than {LEG[0]:g}" if small else f"more than {LEG[1]:g}"
    yield PlausibilityWarning(
        code="length-unit",
        where="leg.coxa_mm, femur_mm, tibia_mm",
        what=f"a straight leg is {size.leg:.4g} mm long, {bound} mm",
        cause=cause,
        remedy=remedy,
    )


def _links(size: Dimensions) -> Iterator[PlausibilityWarning]:
    ratio = size.tibia / size.femur
    if not _inside(TIBIA_TO_FEMUR, ratio):
        long, short = ("tibia", "femur") if ratio > 1 else ("femur", "tibia")
        # The wrong one is that whose correction by a factor of 10 gives the more usual proportions.
        shortened = size.leg - 0.9 * getattr(size, long)
        lengthened = size.leg + 9 * getattr(size, short)
        wrong_is_short = _oddity(size, lengthened) < _oddity(size, shortened)
        name = short if wrong_is_short else long
        length = getattr(size, name)
        cause, remedy = unit_causes(
            length,
            lambda factor: _inside(TIBIA_TO_FEMUR, ratio * factor ** (1 if name == "tibia" else -1)),
            too_small=wrong_is_short,
        )
        bound = f"{'more' if ratio > 1 else 'less'} than {TIBIA_TO_FEMUR[ratio > 1]:g}"
        yield PlausibilityWarning(
            code="link-ratio",
            where=f"leg.{name}_mm",
            what=f"{length:.4g} mm; tibia / femur is {size.tibia:.4g} / {size.femur:.4g} = {ratio:.3g}, {bound}",
            cause=cause,
            remedy=remedy,
        )
    elif size.coxa > MOST_COXA * size.reach:
        cause, remedy = unit_causes(size.coxa, lambda factor: size.coxa * factor <= size.reach, too_small=False)
        yield PlausibilityWarning(
            code="link-ratio",
            where="leg.coxa_mm",
            what=f"{size.coxa:.4g} mm, longer than femur and tibia together, {size.reach:.4g} mm",
            cause=cause,
            remedy=remedy,
        )


def _oddity(size: Dimensions, leg: float) -> float:
    return abs(math.log(leg / max(size.radius, 1e-9) / _USUAL_PROPORTION))


def _single_links(robot: Robot, size: Dimensions) -> Iterator[PlausibilityWarning]:
    """Warn of a leg with a link whose length differs from those of the other legs and of the opposite leg."""
    partners = mirror_partners(size)
    for joint in JOINTS:
        lengths = np.asarray(getattr(robot, joint), dtype=np.float64) * 1000
        median = float(np.median(lengths))
        for leg, length in enumerate(lengths):
            partner = partners[leg]
            opposite = median if partner in (None, leg) else float(lengths[partner])
            if _differs(length, median, size) and _differs(length, opposite, size):
                yield _single_link(f"{robot.leg_names[leg]}: {joint}_mm", float(length), median)


def _differs(length: float, usual: float, size: Dimensions) -> bool:
    ratio = length / max(usual, 1e-9)
    return abs(length - usual) > LEAST_DIFFERENCE * size.leg and not 1 / MOST_LEG_RATIO < ratio < MOST_LEG_RATIO


def _single_link(where: str, length: float, usual: float) -> PlausibilityWarning:
    def fits(factor: float) -> bool:
        return 1 / MOST_LEG_RATIO < length * factor / max(usual, 1e-9) < MOST_LEG_RATIO

    cause, remedy = unit_causes(length, fits, too_small=length < usual)
    return PlausibilityWarning(
        code="leg-differs",
        where=where,
        what=f"{length:.4g} mm, while the other legs have {usual:.4g} mm",
        cause=cause,
        remedy=remedy,
    )


def _mounts(size: Dimensions) -> Iterator[PlausibilityWarning]:
    ratio = size.radius / size.leg
    if _inside(RADIUS_TO_LEG, ratio):
        return
    small = ratio < RADIUS_TO_LEG[0]
    cause, remedy = unit_causes(size.radius, lambda factor: _inside(_USUAL_RADIUS, ratio * factor), too_small=small)
    bound = f"less than {RADIUS_TO_LEG[0]:g}" if small else f"more than {RADIUS_TO_LEG[1]:g}"
    yield PlausibilityWarning(
        code="position-unit",
        where="legs.position_mm",
        what=f"the coxa axes lie {size.radius:.4g} mm from their centre, {ratio:.2g} of the {size.leg:.4g} mm of a "
        f"straight leg, {bound}",
        cause=cause,
        remedy=remedy,
    )


def _box(robot: Robot, size: Dimensions) -> Iterator[PlausibilityWarning]:
    extent = np.ptp(size.position, axis=0)
    if robot.body_size is None or not (extent > 0).all():
        return
    box = np.asarray(robot.body_size, dtype=np.float64) * 1000
    shown = " x ".join(f"{side:.4g}" for side in box)
    ratio = math.sqrt(box[0] / extent[0] * box[1] / extent[1])
    if not _inside(BOX_TO_MOUNTS, ratio):
        small = ratio < 1
        cause, remedy = unit_causes(math.sqrt(box[0] * box[1]), lambda f: 0.5 < ratio * f < 2, too_small=small)
        yield PlausibilityWarning(
            code="box-unit",
            where="body.size_mm",
            what=f"{shown} mm, while the coxa axes span {extent[0]:.4g} x {extent[1]:.4g} mm",
            cause=cause,
            remedy=f"{remedy} on average" if "would be" in remedy else remedy,
        )
    elif box[2] > MOST_BOX_HEIGHT[0] * max(box[0], box[1]) and box[2] > MOST_BOX_HEIGHT[1] * min(box[0], box[1]):
        yield PlausibilityWarning(
            code="box-order",
            where="body.size_mm",
            what=f"{shown} mm: the height, {box[2]:.4g} mm, exceeds {MOST_BOX_HEIGHT[1]:g} times the shorter side, "
            f"{min(box[0], box[1]):.4g} mm",
            cause="the numbers are in another order",
            remedy="The order is length (forward), width, height",
        )


def _feet(robot: Robot, size: Dimensions) -> Iterator[PlausibilityWarning]:
    radius = float(np.median(robot.foot_radius)) * 1000
    if radius <= MOST_FOOT * size.tibia:
        return
    cause, remedy = unit_causes(radius, lambda factor: radius * factor <= MOST_FOOT * size.tibia, too_small=False)
    yield PlausibilityWarning(
        code="foot-radius",
        where="leg.foot_radius_mm",
        what=f"{radius:.4g} mm, more than {MOST_FOOT:g} of the tibia's {size.tibia:.4g} mm",
        cause=cause,
        remedy=remedy,
    )


def _heights(robot: Robot, size: Dimensions) -> Iterator[PlausibilityWarning]:
    """Warn of a body height or a swing height that no robot with such legs has."""
    raised = np.abs(np.asarray(robot.mount_position)[:, 2] + np.asarray(robot.femur_axis_offset)[:, 1]).max() * 1000
    reach = size.reach + raised
    for key, value, (least, most) in (
        ("body_height", robot.gait.body_height, HEIGHT_TO_REACH),
        ("swing_height", robot.gait.swing_height, SWING_TO_REACH),
    ):
        if value is None or _inside((least * size.reach, most * reach), height := abs(value) * 1000):
            continue
        small = height < least * size.reach
        bound = least * size.reach if small else most * reach
        cause, remedy = unit_causes(
            height,
            lambda f: _inside((2 * least * size.reach, most * reach), height * f),  # noqa: B023
            too_small=small,
        )
        yield PlausibilityWarning(
            code=key.replace("_", "-"),
            where=f"gait.{key}_mm",
            what=f"{height:.4g} mm, {'less' if small else 'more'} than {bound:.4g} mm for femur and tibia of "
            f"{size.reach:.4g} mm",
            cause=cause,
            remedy=remedy,
        )


def _body_in_ground(robot: Robot) -> Iterator[PlausibilityWarning]:
    if robot.body_size is None or robot.gait.body_height is None:
        return
    half = float(np.asarray(robot.body_size)[2]) * 500
    height = robot.gait.body_height * 1000
    if floor_depth(robot, Pose(position=(0.0, 0.0, robot.gait.body_height))) >= 0:
        yield PlausibilityWarning(
            code="body-in-ground",
            where="gait.body_height_mm",
            what=f"{height:.4g} mm, while the body's box reaches {half:.4g} mm below its origin, into the ground",
            cause="a unit or a digit is wrong, or the height was measured to the underside",
            remedy="Body height is that of the origin, the centre of the coxa axes",
        )
