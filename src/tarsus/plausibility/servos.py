"""Plausibility of the data of servos."""

from __future__ import annotations

import math
from collections.abc import Iterator

from tarsus.plausibility.warning import PlausibilityWarning
from tarsus.robot.robot import JOINTS, Robot
from tarsus.robot.servo import Servo

__all__ = ["servo_warnings"]

# Bounds from the servo catalogue with a margin; the strongest hobby servos give 90 N m per kg. Mass [kg], stall torque
# over mass [N m/kg], no-load speed [rad/s], travel [deg].
LEAST_MASS = 0.0005
MOST_TORQUE_PER_MASS = 150.0
SPEED = (0.4, 40.0)
LEAST_TRAVEL = 6.3
_KG_CM, _OUNCE_INCH = 0.0980665, 0.00706155  # [N m]


def servo_warnings(robot: Robot) -> Iterator[PlausibilityWarning]:
    """Yield the warnings on the servos of a single robot, once for each servo."""
    seen: dict[Servo, str] = {}
    for row in robot.servos:
        for joint, servo in zip(JOINTS, row, strict=True):
            if servo is not None:
                seen.setdefault(servo, joint)
    everywhere = len(seen) == 1
    for servo, joint in seen.items():
        yield from _servo(servo, "leg.servo" if everywhere else f"leg.servo.{joint}")


def _servo(servo: Servo, where: str) -> Iterator[PlausibilityWarning]:
    named = f"{where}, {servo.name}"
    if servo.mass is not None and servo.mass < LEAST_MASS:
        yield PlausibilityWarning(
            code="servo-mass",
            where=f"{named}: mass_g",
            what=f"{servo.mass * 1000:.4g} g, less than {LEAST_MASS * 1000:g} g",
            cause="this looks like kg instead of g",
            remedy=f"In g it would be {servo.mass * 1e6:.4g}",
        )
    elif servo.mass and servo.stall_torque / servo.mass > MOST_TORQUE_PER_MASS:
        torque = servo.stall_torque
        yield PlausibilityWarning(
            code="servo-torque",
            where=f"{named}: stall_torque_nm",
            what=f"{torque:.4g} N m from {servo.mass * 1000:.4g} g, {torque / servo.mass:.3g} N m/kg, more than "
            f"{MOST_TORQUE_PER_MASS:g}",
            cause="this looks like kg cm instead of N m"
            + (", or like ounce inches" if torque * _OUNCE_INCH / servo.mass > 5 else ""),
            remedy=f"{torque:.4g} kg cm is {torque * _KG_CM:.3g} N m",
        )
    speed = servo.no_load_speed
    if speed is not None and not SPEED[0] <= speed <= SPEED[1]:
        slow = speed < SPEED[0]
        yield PlausibilityWarning(
            code="servo-speed",
            where=f"{named}: no_load_rad_s",
            what=f"{speed:.4g} rad/s, {f'less than {SPEED[0]:g}' if slow else f'more than {SPEED[1]:g}'}",
            cause="this looks like the seconds for 60 degrees" if slow else "this looks like rpm or deg/s",
            remedy=f"{speed:.4g} s for 60 degrees is {math.pi / 3 / speed:.3g} rad/s"
            if slow
            else f"{speed:.4g} rpm is {speed * math.pi / 30:.3g} rad/s, {speed:.4g} deg/s is "
            f"{math.radians(speed):.3g} rad/s",
        )
    travel = servo.travel
    if travel is not None and 0 < math.degrees(travel) <= LEAST_TRAVEL:
        yield PlausibilityWarning(
            code="servo-travel",
            where=f"{named}: travel_deg",
            what=f"{math.degrees(travel):.4g} deg",
            cause="this looks like radians",
            remedy=f"In degrees it would be {math.degrees(math.degrees(travel)):.4g}",
        )
