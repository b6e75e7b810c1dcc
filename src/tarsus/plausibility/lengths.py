"""Plausibility of lengths: of the legs, of their links to each other, of the coxa axes, the body and the stance."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from tarsus.plausibility.dimensions import Dimensions
from tarsus.plausibility.units import unit_causes
from tarsus.plausibility.warning import PlausibilityWarning
from tarsus.robot.robot import JOINTS, Robot

__all__ = ["length_warnings"]

# Length of a straight leg [mm]: hexapods of 2 g servos have 60, walking machines of 40 kg 1200.
LEG = (45.0, 2000.0)
_USUAL_LEG = (50.0, 1500.0)
# Bounds of ratios, from the presets and published robots with a margin of 2 and more at either end.
TIBIA_TO_FEMUR = (0.3, 4.5)
MOST_COXA = 1.0
RADIUS_TO_LEG = (0.08, 2.0)
_USUAL_RADIUS = (0.15, 1.3)
BOX_TO_MOUNTS = (0.25, 4.0)
MOST_BOX_HEIGHT = 1.2
MOST_FOOT = 0.35
HEIGHT_TO_REACH = (0.08, 1.0)
SWING_TO_REACH = (0.025, 1.0)
MOST_LEG_RATIO = 3.0
# Usual length of a leg in radii of the coxa axes.
_USUAL_PROPORTION = 2.8


def length_warnings(robot: Robot, size: Dimensions) -> Iterator[PlausibilityWarning]:
    """Yield the warnings on the lengths of a single robot."""
    legs = list(_legs(size))
    yield from legs
    if not legs:
        yield from _links(size)
    yield from _single_links(robot)
    yield from _mounts(size, legs_doubtful=bool(legs))
    yield from _box(robot, size)
    yield from _feet(robot, size)
    yield from _stance(robot, size)


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
        # Of the two, the one whose correction by 10 gives the more usual proportions.
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


def _single_links(robot: Robot) -> Iterator[PlausibilityWarning]:
    """Warn of a leg with a link of quite another length than those of the other legs."""
    for joint in JOINTS:
        lengths = np.asarray(getattr(robot, joint), dtype=np.float64) * 1000
        median = float(np.median(lengths))
        for leg, length in zip(robot.leg_names, lengths, strict=True):
            if median > 0 and not 1 / MOST_LEG_RATIO < length / median < MOST_LEG_RATIO and length > 0:
                small = bool(length < median)
                cause, remedy = unit_causes(
                    length,
                    lambda factor: 1 / MOST_LEG_RATIO < length * factor / median < MOST_LEG_RATIO,  # noqa: B023
                    too_small=small,
                )
                yield PlausibilityWarning(
                    code="leg-differs",
                    where=f"{leg}: {joint}_mm",
                    what=f"{length:.4g} mm, while the other legs have {median:.4g} mm",
                    cause=cause,
                    remedy=remedy,
                )


def _mounts(size: Dimensions, *, legs_doubtful: bool) -> Iterator[PlausibilityWarning]:
    ratio = size.radius / size.leg
    if legs_doubtful or _inside(RADIUS_TO_LEG, ratio):
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
    elif box[2] > MOST_BOX_HEIGHT * max(box[0], box[1]):
        yield PlausibilityWarning(
            code="box-order",
            where="body.size_mm",
            what=f"{shown} mm: the height, {box[2]:.4g} mm, exceeds length and width",
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


def _stance(robot: Robot, size: Dimensions) -> Iterator[PlausibilityWarning]:
    """Warn of a body height or a swing height that no leg like these has, and of a body box in the ground."""
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
    if robot.body_size is not None and robot.gait.body_height is not None:
        half = float(np.asarray(robot.body_size)[2]) * 500
        height = robot.gait.body_height * 1000
        if half >= height:
            yield PlausibilityWarning(
                code="body-in-ground",
                where="gait.body_height_mm",
                what=f"{height:.4g} mm, while the body's box reaches {half:.4g} mm below its origin, into the ground",
                cause="a unit, a digit, or the order of body.size_mm is wrong, or the height was measured to the "
                "underside",
                remedy="Body height is that of the origin, the centre of the coxa axes",
            )
