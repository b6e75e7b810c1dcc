"""Changes that take thought: another gait, posture or pace, worked out in parts before it is gone over to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from tarsus.errors import UnreachableError
from tarsus.gait.gait import Gait
from tarsus.gait.live.envelope import Envelope, capped, envelope
from tarsus.gait.live.posture import LIFT, stand_of
from tarsus.gait.live.support import support_sets
from tarsus.gait.live.tempo import Tempo, tempo
from tarsus.gait.live.workspace import Parts, joint_slack
from tarsus.kinematics.stance import default_stance
from tarsus.robot.robot import Robot

__all__ = ["Change", "Manner", "work_out"]

Floats = np.ndarray[Any, Any]

_WITH_BEATS = np.array([1, 0, 1, 0, 1, 0])
_PARTS_OF_WAY, _HALVINGS, _LEAST_PART = 16, 6, 0.02
# How far the rest footholds move at once at the most [m], and what is no change.
_LONGEST_STEP, _SAME = 0.03, 1e-9


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
    sway : tuple of float
        Amplitudes of the body's sway, as `body`.
    correction : tuple of float
        What is added to `body`, for the ground's sake.
    gone : tuple of int
        Legs that don't step.
    """

    gait: Gait
    body: tuple[float, ...]
    clearance: float
    lift: float
    stance_width: float
    cycle_time: float | None
    sway: tuple[float, ...] = (0.0,) * 6
    correction: tuple[float, ...] = (0.0,) * 6
    gone: tuple[int, ...] = ()

    @property
    def stance(self) -> tuple[float, ...]:
        """How the body is to stand, for the ground's sake too."""
        return tuple(a + b for a, b in zip(self.body, self.correction, strict=True))


@dataclass(frozen=True, eq=False, kw_only=True)
class Change:
    """What going over to a manner comes to, or to a part of it.

    First the feet step to new rest footholds, then the body moves over them.

    Attributes
    ----------
    manner : Manner
        What was asked for.
    whole : bool
        Whether this is all of it that works; if not, the rest comes with a further change.
    posture : array, shape (7,)
        The posture to go to.
    rest : complex array, shape (legs,)
        The rest footholds to step to, in the heading frame [m].
    tempo : Tempo
        How fast the legs step there.
    stepping, way, there : Envelope
        What is possible while the feet step, while the body moves, and there.
    limited : tuple of str
        Why it isn't all that was asked for.
    """

    manner: Manner
    whole: bool
    posture: Floats
    rest: Floats
    tempo: Tempo
    stepping: Envelope
    way: Envelope
    there: Envelope
    limited: tuple[str, ...]


def work_out(
    robot: Robot,
    manner: Manner,
    now: Floats | None,
    rest: Floats | None,
    *,
    stay: bool = False,
    speed: Floats,
    acceleration: Floats,
    foot_distance: float,
) -> Parts[Change | str]:
    """Work out how to go over to a manner, in parts.

    Parameters
    ----------
    robot : Robot
        A single robot.
    manner : Manner
        What is asked for.
    now : array, shape (7,), or None
        The present posture; None to be there at once.
    rest : complex array, shape (legs,), or None
        The present rest footholds [m].
    stay : bool
        Whether the robot keeps its present posture, and changes only how it steps.
    speed, acceleration : array, shape (legs, 3)
        Greatest of each joint [rad/s], [rad/s^2].
    foot_distance : float
        Least distance between two feet [m].

    Returns
    -------
    Change or str
        The change; or why nothing of it works.
    """
    if stay and now is not None and rest is not None:
        wished, wished_rest = now, rest
    else:
        wished, wished_rest = yield from _wished(robot, manner, now)
    now, rest = (wished, wished_rest) if now is None or rest is None else (now, rest)
    share, leg = yield from _largest_part(robot, (now, rest), (wished, wished_rest))
    yield
    if share == 0:
        return f"body: {robot.leg_names[leg]} comes to the end of its reach"
    share, whole = _one_change(robot, (now, rest), (wished, wished_rest), share)
    yield
    sets = support_sets(manner.gait, manner.gone)
    posture, rest_there = now + share * (wished - now), rest + share * (wished_rest - rest)
    there = yield from _envelope_of(robot, manner, posture, rest_there, sets, foot_distance)
    while not there.possible:
        share, whole, leg = share / 2, False, there.short
        if share < _LEAST_PART:
            return f"body: {robot.leg_names[leg]} comes to the end of its reach"
        posture, rest_there = now + share * (wished - now), rest + share * (wished_rest - rest)
        there = yield from _envelope_of(robot, manner, posture, rest_there, sets, foot_distance)
    pace = yield from tempo(
        robot,
        manner.gait,
        stand_of(posture, rest_there),
        there,
        speed=speed,
        acceleration=acceleration,
        cycle_time=manner.cycle_time,
    )
    there = capped(there, pace.stroke, pace.turning, duty=manner.gait.duty)
    stepping = way = there
    if np.abs(posture - now).max() > _SAME:
        between = [stand_of(now + part * (posture - now), rest_there) for part in (0.5, 0.0)]
        way = there.meet((yield from envelope(robot, between[:1], sets, foot_distance=foot_distance, gone=manner.gone)))
        stepping = yield from envelope(robot, between[1:], sets, foot_distance=foot_distance, gone=manner.gone)
        stepping = capped(stepping, pace.stroke, pace.turning, duty=manner.gait.duty)
        way = way.meet(stepping)
    if not (way.possible and stepping.possible):
        return f"body: {robot.leg_names[way.short]} could not stand and step on the way there"
    return Change(
        manner=manner,
        whole=whole,
        posture=posture,
        rest=rest_there,
        tempo=pace,
        stepping=stepping,
        way=way,
        there=there,
        limited=_limits(robot, manner, pace, share, whole=whole, leg=leg),
    )


def _envelope_of(
    robot: Robot, manner: Manner, posture: Floats, rest: Floats, sets: Floats, foot_distance: float
) -> Parts[Envelope]:
    """Work out what is possible in a posture, with its sway."""
    stands = [stand_of(row, rest) for row in _swaying(posture, manner.sway)]
    return (yield from envelope(robot, stands, sets, foot_distance=foot_distance, gone=manner.gone))


def _limits(robot: Robot, manner: Manner, pace: Tempo, share: float, *, whole: bool, leg: int) -> tuple[str, ...]:
    """Say what of a manner doesn't work."""
    limited: tuple[str, ...] = ()
    if whole and share < 1:
        reason = f"body: it goes no farther that way, {robot.leg_names[leg]} comes to the end of its reach"
        limited += (reason,)
    if manner.cycle_time is not None and pace.cycle_time > manner.cycle_time:
        reason = (
            f"cycle_time {manner.cycle_time:.3g} s is too short for the joints to lift the feet "
            f"{manner.lift * 1000:.0f} mm and get on: {pace.cycle_time:.3g} s is taken"
        )
        limited += (reason,)
    return limited


def _wished(robot: Robot, manner: Manner, now: Floats | None) -> Parts[tuple[Floats, Floats]]:
    """Return posture and rest footholds of a manner; where no leg's foothold is so high or low, of the nearest that is.

    Raises
    ------
    UnreachableError
        If there is none, and no present posture to start from.
    """
    wished = np.array([*manner.stance, manner.lift])
    tried = [1.0] if now is None else [1.0, *np.arange(7, 0, -1) / 8]
    for share in tried:
        clearance, lift = manner.clearance, manner.lift
        if now is not None and share < 1:
            was = float(now[2]) - manner.stance[2]
            clearance, lift = was + share * (clearance - was), float(now[LIFT]) + share * (lift - float(now[LIFT]))
        try:
            stance = default_stance(robot, clearance, lift=lift)
        except UnreachableError:
            if now is None:
                raise
            yield
            continue
        wished[2], wished[LIFT] = manner.stance[2] + clearance, lift
        return wished, _widened(robot, stance[:, 0] + 1j * stance[:, 1], manner.stance_width)
    raise UnreachableError(f"no leg reaches the ground at clearance {manner.clearance * 1000:.1f} mm")


def _swaying(posture: Floats, sway: tuple[float, ...]) -> list[Floats]:
    """Return the postures at the ends of a sway, and the one in the middle last."""
    if not any(sway):
        return [posture]
    # Half of the axes go with the beats, half with the cycles: they meet in any order.
    often, once = (np.append(np.array(sway) * part, 0.0) for part in (_WITH_BEATS, 1 - _WITH_BEATS))
    return [*(posture + a * often + b * once for a in (1, -1) for b in (1, -1)), posture]


def _widened(robot: Robot, rest: Floats, width: float) -> Floats:
    mount = robot.geometry.mount_x + 1j * robot.geometry.mount_y
    out = rest - mount
    wider: Floats = rest + width * out / np.maximum(np.abs(out), 1e-9)
    return wider


Posed: TypeAlias = tuple[Floats, Floats]


def _slack(robot: Robot, posture: Floats, rest: Floats) -> Floats:
    """Return how much is left to each leg ``(legs,)`` at its rest foothold, on the ground and lifted."""
    stand = stand_of(posture, rest)
    height = np.array([[0.0], [stand.lift]]) + np.zeros(robot.legs)
    solution = stand.solve(robot, rest.real + 0 * height, rest.imag + 0 * height, height)
    return np.asarray(joint_slack(robot.geometry, solution).min(axis=0))


def _largest_part(robot: Robot, now: Posed, wished: Posed) -> Parts[tuple[float, int]]:
    """Return how much of the way to a posture all legs reach their rest footholds, and which leg stops it there."""
    reached = 0.0
    for count in range(1, _PARTS_OF_WAY + 1):
        share = count / _PARTS_OF_WAY
        slack = _slack(robot, *(a + share * (b - a) for a, b in zip(now, wished, strict=True)))
        if (slack < 0).any():
            return reached, int(slack.argmin())
        reached = share
        if count % 4 == 0:
            yield
    return 1.0, 0


def _one_change(robot: Robot, now: Posed, wished: Posed, share: float) -> tuple[float, bool]:
    """Return how much of the way can be gone at once: as the body still is, the feet must reach their new places."""
    (posture, rest), (_, wished_rest) = now, wished
    part = share
    for _ in range(_HALVINGS):
        if np.abs(wished_rest - rest).max() * part <= _LONGEST_STEP:
            slack = _slack(robot, posture, rest + part * (wished_rest - rest))
            if (slack >= 0).all():
                break
        part /= 2
    return part, part == share
