"""Changes that take thought: another gait, posture or pace, worked out in parts before it is gone over to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tarsus.errors import TarsusError
from tarsus.gait.gait import Gait
from tarsus.gait.live.envelope import Envelope, capped, envelope, overhang
from tarsus.gait.live.posture import LIFT, posture_row, stand_of
from tarsus.gait.live.support import support_sets
from tarsus.gait.live.tempo import Tempo, tempo
from tarsus.gait.live.workspace import Parts, joint_slack
from tarsus.kinematics.stance import default_stance
from tarsus.robot.robot import Robot

__all__ = ["Change", "Manner", "work_out"]

Floats = np.ndarray[Any, Any]

_PARTS_OF_WAY = 16
# Postures between the present one and the next for which the feet's polygons are worked out.
_STANDS = (0.5, 0.0)


@dataclass(frozen=True, kw_only=True)
class Manner:
    """How the robot is asked to walk, apart from where to.

    Attributes
    ----------
    gait : Gait
        Order of the steps.
    body : tuple of float
        x, y, z [m], roll, pitch, yaw [rad] against standing level at the clearance.
    clearance, lift : float
        Height of the body's origin, lift of the swinging feet [m].
    stance_width : float
        How much farther out than usual the feet rest [m].
    cycle_time : float or None
        Duration of a cycle [s]; None for the one that gets the robot farthest.
    gone : tuple of int
        Legs that don't step.
    """

    gait: Gait
    body: tuple[float, ...]
    clearance: float
    lift: float
    stance_width: float
    cycle_time: float | None
    gone: tuple[int, ...] = ()


@dataclass(frozen=True, eq=False, kw_only=True)
class Change:
    """What going over to a manner comes to.

    Attributes
    ----------
    manner : Manner
        What was asked for.
    posture : array
        The row to go to: all of what was asked for that works.
    tempo : Tempo
        How fast the legs step there.
    way : Envelope
        What is possible on the way there.
    there : Envelope
        What is possible there.
    limited : tuple of str
        Why it isn't all that was asked for.
    """

    manner: Manner
    posture: Floats
    tempo: Tempo
    way: Envelope
    there: Envelope
    limited: tuple[str, ...]


def work_out(
    robot: Robot, manner: Manner, now: Floats | None, *, speed: Floats, acceleration: Floats, foot_distance: float
) -> Parts[Change | str]:
    """Work out how to go over to a manner, in parts.

    Parameters
    ----------
    robot : Robot
        A single robot.
    manner : Manner
        What is asked for.
    now : array
        The present posture's row; None to be there at once.
    speed, acceleration : array, shape (legs, 3)
        Greatest of each joint [rad/s], [rad/s^2].
    foot_distance : float
        Least distance between two feet [m].

    Returns
    -------
    Change or str
        The change; or why nothing of it works.
    """
    try:
        stance = default_stance(robot, manner.clearance, lift=manner.lift)
    except TarsusError as error:
        return str(error)
    yield
    rest = _widened(robot, stance[:, 0] + 1j * stance[:, 1], manner.stance_width)
    body = np.array(manner.body) + np.array([0, 0, manner.clearance, 0, 0, 0])
    wished = posture_row(body, manner.lift, rest)
    now = wished if now is None else now
    share, reason = _largest_part(robot, now, wished)
    yield
    posture = now + share * (wished - now)
    limited = (reason,) if reason else ()
    sets = support_sets(manner.gait, manner.gone)
    there = yield from envelope(robot, [stand_of(posture)], sets, foot_distance=foot_distance)
    if not there.possible:
        return f"{robot.leg_names[there.short]} could not stand and step there"
    pace = yield from tempo(
        robot,
        manner.gait,
        stand_of(posture),
        there,
        speed=speed,
        acceleration=acceleration,
        cycle_time=manner.cycle_time,
    )
    if manner.cycle_time is not None and pace.cycle_time > manner.cycle_time:
        limited += (
            f"cycle_time {manner.cycle_time:.3g} s is too short for the joints to lift the feet "
            f"{posture[LIFT] * 1000:.0f} mm: {pace.cycle_time:.3g} s is taken",
        )
    there = capped(there, pace.stroke * overhang(manner.gait.duty))
    way = there
    for part in _STANDS if np.abs(posture - now).max() > 1e-9 else ():
        between = stand_of(posture + part * (now - posture)) if part else stand_of(now)
        here = yield from envelope(robot, [between], sets, foot_distance=foot_distance)
        way = way.meet(here)
    return Change(manner=manner, posture=posture, tempo=pace, way=way, there=there, limited=limited)


def _widened(robot: Robot, rest: Floats, width: float) -> Floats:
    mount = robot.geometry.mount_x + 1j * robot.geometry.mount_y
    out = rest - mount
    wider: Floats = rest + width * out / np.maximum(np.abs(out), 1e-9)
    return wider


def _largest_part(robot: Robot, now: Floats, wished: Floats) -> tuple[float, str]:
    """Return how much of the way to a posture all legs reach their rest footholds, lifted or not, and what stops it."""
    shares = np.arange(1, _PARTS_OF_WAY + 1) / _PARTS_OF_WAY
    slack = []
    for share in shares:
        stand = stand_of(now + share * (wished - now))
        height = np.array([[0.0], [stand.lift]]) + np.zeros(robot.legs)
        x, y = stand.rest.real + 0 * height, stand.rest.imag + 0 * height
        solution = stand.solve(robot, x, y, height)
        slack.append(joint_slack(robot.geometry, solution).min(axis=0))
    fails = (np.array(slack) < 0).any(axis=1)
    if not fails.any():
        return 1.0, ""
    first = int(fails.argmax())
    leg = int(np.argmin(slack[first]))
    share = float(shares[first] - shares[0])
    return share, f"body: {100 * share:.0f} % of the way there, {robot.leg_names[leg]} comes to the end of its reach"
