"""Plausibility of masses and centres of mass."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from tarsus.kinematics.polygon import hull_margin
from tarsus.plausibility.dimensions import Dimensions
from tarsus.plausibility.warning import PlausibilityWarning
from tarsus.robot.robot import JOINTS, Robot

__all__ = ["mass_warnings"]

# Mass over the cube of the length of a straight leg [kg/m^3]: presets have 70 to 220, long thin
# legs 8, a heavy load 1500.
DENSITY = (2.0, 5000.0)
_USUAL_DENSITY = (8.0, 1500.0)
# Share of the links in the mass of the robot; presets have about a half.
LINK_SHARE = (0.02, 0.97)
_USUAL_LINK_SHARE = (0.1, 0.9)
# A link's centre of mass, along the link from its inner joint, in lengths of the link.
LINK_COM = (-0.6, 1.5)
# How far the body's centre of mass may be outside both its box and the polygon of the coxa axes, over the axes' radius.
MOST_OVERHANG = 0.25

# Masses typed in another unit: factors that correct the body and each link, the keys, and the error in words.
_MASS_ERRORS: tuple[tuple[float, tuple[float, ...], str, str], ...] = (
    (1e-3, (1e-3, 1e-3, 1e-3), "body.mass_kg, leg.mass_kg", "all masses are in g instead of kg"),
    (1e-3, (1, 1, 1), "body.mass_kg", "the body's mass is in g instead of kg"),
    *(
        (1, tuple(1e-3 if j == k else 1.0 for k in range(3)), f"leg.mass_kg.{JOINTS[j]}", f"the {JOINTS[j]} is in g")
        for j in range(3)
    ),
    (1, (1e-3, 1e-3, 1e-3), "leg.mass_kg", "the masses of the links are in g instead of kg"),
    (1e3, (1e3, 1e3, 1e3), "body.mass_kg, leg.mass_kg", "all masses are a thousand times too small"),
    (1e3, (1, 1, 1), "body.mass_kg", "the body's mass is a thousand times too small"),
    (1, (1e3, 1e3, 1e3), "leg.mass_kg", "the masses of the links are a thousand times too small"),
)


def mass_warnings(robot: Robot, size: Dimensions) -> Iterator[PlausibilityWarning]:
    """Yield the warnings on the masses of a single robot, whose lengths are plausible."""
    if robot.body_mass is not None and robot.link_mass is not None:
        yield from _masses(robot, size)
    yield from _body_com(robot, size)
    yield from _link_com(robot)


def _masses(robot: Robot, size: Dimensions) -> Iterator[PlausibilityWarning]:
    body, links = float(np.asarray(robot.body_mass)), np.asarray(robot.link_mass).sum(axis=0)
    cube = (size.leg / 1000) ** 3

    def within(density: tuple[float, float], share: tuple[float, float]) -> Callable[[float, tuple[float, ...]], bool]:
        def check(body_factor: float, link_factors: tuple[float, ...]) -> bool:
            legs = float((links * link_factors).sum())
            total = body * body_factor + legs
            # Links without mass are a simplification.
            return density[0] <= total / cube <= density[1] and (legs == 0 or share[0] <= legs / total <= share[1])

        return check

    total = body + float(links.sum())
    if within(DENSITY, LINK_SHARE)(1, (1, 1, 1)):
        yield from _servo_masses(robot, total)
        return
    usual = within(_USUAL_DENSITY, _USUAL_LINK_SHARE)
    found = next((error for error in _MASS_ERRORS if usual(error[0], error[1])), None)
    where, cause = ("body.mass_kg, leg.mass_kg", "a unit or a digit is wrong") if found is None else found[2:]
    share = float(links.sum()) / total
    what = f"body {body:.4g} kg and legs {links.sum():.4g} kg"
    if DENSITY[0] <= total / cube <= DENSITY[1]:
        low, high = (100 * bound for bound in LINK_SHARE)
        what += f": the legs are {100 * share:.1f} % of the robot, outside {low:.0f} to {high:.0f} %"
    else:
        low, high = (bound * cube for bound in DENSITY)
        what += f", {total:.4g} kg in all, outside {low:.3g} to {high:.3g} kg for legs of {size.leg:.4g} mm"
    yield PlausibilityWarning(
        code="mass-unit",
        where=where,
        what=what,
        cause=cause,
        remedy="Masses are in kg, of each link with the servo mounted on it"
        if found is None
        else f"In kg: body {body * found[0]:.4g}, links of a leg "
        f"{', '.join(f'{mass:.3g}' for mass in links * found[1] / robot.legs)}",
    )


def _servo_masses(robot: Robot, total: float) -> Iterator[PlausibilityWarning]:
    servos = sum(servo.mass for row in robot.servos for servo in row if servo is not None and servo.mass is not None)
    if servos > total:
        yield PlausibilityWarning(
            code="mass-below-servos",
            where="body.mass_kg, leg.mass_kg",
            what=f"the robot weighs {total:.4g} kg, and its servos alone {servos:.4g} kg",
            cause="the masses are without servos, or in another unit; or mass_g of the servo is wrong",
            remedy="Masses of links include the servos mounted on them",
        )


def _body_com(robot: Robot, size: Dimensions) -> Iterator[PlausibilityWarning]:
    com = np.asarray(robot.body_com, dtype=np.float64) * 1000

    def outside(at: np.ndarray) -> float:
        box = np.zeros(2) if robot.body_size is None else np.asarray(robot.body_size)[:2] * 500
        beyond = float(np.linalg.norm(np.maximum(np.abs(at[:2]) - box, 0)))
        hull = -float(hull_margin(size.position, np.ones(robot.legs, dtype=bool), at[:2]))
        return max(0.0, min(beyond, hull))

    bound = MOST_OVERHANG * size.radius
    beyond, up = outside(com), abs(float(com[2]))
    if beyond <= bound and up <= size.leg:
        return
    what = (
        f"{beyond:.4g} mm outside the body and the polygon of the coxa axes, more than {bound:.4g} mm"
        if beyond > bound
        else f"{up:.4g} mm from the coxa axes' plane, more than the length of a leg, {size.leg:.4g} mm"
    )
    tenth = com / 10
    slip = outside(tenth) <= bound and abs(tenth[2]) <= size.leg
    yield PlausibilityWarning(
        code="com-outside",
        where="body.com_mm",
        what=f"[{', '.join(f'{x:.4g}' for x in com)}] mm: the centre of mass is {what}",
        cause="it is measured from a corner or from another origin"
        + (", or there is a digit too many" if slip else ""),
        remedy="com_mm is measured from the body's origin, the centre of the coxa axes: x forward, y left, z up",
    )


def _link_com(robot: Robot) -> Iterator[PlausibilityWarning]:
    for j, joint in enumerate(JOINTS):
        lengths = np.asarray(getattr(robot, joint), dtype=np.float64) * 1000
        centres = np.asarray(robot.link_com, dtype=np.float64)[:, j] * 1000
        length, centre = float(np.median(lengths)), float(np.median(centres))
        if length > 0 and not LINK_COM[0] <= centre / length <= LINK_COM[1]:
            yield PlausibilityWarning(
                code="link-com",
                where=f"leg.com_mm.{joint}",
                what=f"{centre:.4g} mm on a link of {length:.4g} mm: the centre of mass is off the link",
                cause="a digit too many, or it is measured from a point other than the inner joint",
                remedy=f"com_mm is measured along the link from its inner joint; the middle is {length / 2:.4g}",
            )
