"""Assumptions behind joint loads, in words."""

from __future__ import annotations

from collections.abc import Iterator

from tarsus.gait.motion import Motion
from tarsus.load.servo_limits import why_not_rated
from tarsus.robot.estimates import SERVO_KEY, estimate_text
from tarsus.robot.robot import JOINTS, Robot

__all__ = ["load_assumptions"]


def load_assumptions(robot: Robot, motion: Motion, supply: float | None) -> Iterator[str]:
    """Return the assumptions behind joint loads.

    Parameters
    ----------
    robot : Robot
        The robot.
    motion : Motion
        The motion.
    supply : float or None
        Supply voltage of the servos [V].
    """
    if estimated := estimate_text(robot, [SERVO_KEY]):
        yield estimated
    unreachable = int((motion.reach != 0).any(-1).sum())
    if unreachable:
        count = f"{unreachable} of {len(motion.time)} samples"
        yield f"a foot is out of reach in {count}; its leg takes the nearest reachable pose"
    for servo in {servo.name: servo for leg in robot.servos for servo in leg if servo is not None}.values():
        if supply is None:
            voltage = "an unknown voltage" if servo.torque_at is None else f"{servo.torque_at:g} V"
            yield f"{servo.name} at {voltage}, the voltage of its rated stall torque"
            continue
        if why := why_not_rated(servo, supply):
            yield why
            continue
        if servo.torque_at is None or (servo.no_load_speed is not None and servo.speed_at is None):
            yield f"{servo.name}: the voltage of its ratings is unknown; they are used unchanged at {supply:g} V"
        if servo.supply is not None and not servo.supply[0] <= supply <= servo.supply[1]:
            yield (
                f"{servo.name} is rated for {servo.supply[0]:g} to {servo.supply[1]:g} V; torque and speed are "
                f"extrapolated to the supply of {supply:g} V"
            )
    unnamed = [
        f"{JOINTS[joint]} of {robot.leg_codes[leg]}"
        for leg, row in enumerate(robot.servos)
        for joint, servo in enumerate(row)
        if servo is None
    ]
    if unnamed:
        joints = "any joint" if len(unnamed) == 3 * robot.legs else ", ".join(unnamed)
        yield f"the robot file names no servo for {joints}; no verdict there"
