"""Changes that take thought: another gait, posture or pace, worked out in parts before it is gone over to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tarsus.gait.live.balance import Balance
from tarsus.gait.live.envelope import Envelope, capped, envelope
from tarsus.gait.live.manner import Manner
from tarsus.gait.live.part_of_way import Posed, balanced_part, first_step, largest_part, what_stops
from tarsus.gait.live.parts import Parts
from tarsus.gait.live.stand import Terrain
from tarsus.gait.live.support import support_sets
from tarsus.gait.live.tempo import Tempo, tempo
from tarsus.gait.live.wished import swaying, wished_posed
from tarsus.robot.robot import Robot

__all__ = ["Change", "work_out"]

Floats = np.ndarray[Any, Any]

_LEAST_PART = 0.02
# What is no change.
_SAME = 1e-9
_TIPS_OVER = "the robot would tip over"


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
    terrain : Terrain
        How the ground was taken to lie.
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
    terrain: Terrain


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
    present = Posed(now, rest, manner.terrain) if now is not None and rest is not None else None
    wished = present if present is not None and stay else wished_posed(robot, manner, now)
    sets = support_sets(manner.gait, manner.gone)
    yield
    here, share, why = present or wished, 1.0, ""
    if here is not wished:
        share, why = yield from largest_part(robot, here, wished)
        if share == 0:
            return f"body: {why}"
        yield
    works, share = share, first_step(robot, here, wished, share)
    if np.abs(wished.rest - here.rest).max() > _SAME:
        yield
    there = yield from _envelope_of(robot, manner, here.towards(wished, share), sets, foot_distance)
    if not (there.possible or there.balanced or here is wished):
        works = share = yield from balanced_part(Balance(robot, sets, manner.gone), here, wished, share)
        why = _TIPS_OVER
        if share == 0:
            return f"body: {why}"
        there = yield from _envelope_of(robot, manner, here.towards(wished, share), sets, foot_distance)
    while not there.possible:
        why = _why_not(robot, manner, here.towards(wished, share), there)
        share /= 2
        if share < _LEAST_PART or here is wished:
            return f"body: {why}"
        yield
        there = yield from _envelope_of(robot, manner, here.towards(wished, share), sets, foot_distance)
    goal = here.towards(wished, share)
    pace = yield from tempo(
        robot,
        manner.gait,
        goal.stand,
        there,
        speed=speed,
        acceleration=acceleration,
        cycle_time=manner.cycle_time,
    )
    yield
    there = capped(there, pace.stroke, pace.turning, duty=manner.gait.duty)
    stepping = way = there
    if np.abs(goal.posture - here.posture).max() > _SAME:
        between = [goal._replace(posture=here.towards(goal, part).posture) for part in (0.5, 0.0)]
        way = there.meet((yield from _envelope_of(robot, manner, between[0], sets, foot_distance)))
        stepping = yield from _envelope_of(robot, manner, between[1], sets, foot_distance)
        stepping = capped(stepping, pace.stroke, pace.turning, duty=manner.gait.duty)
        way = way.meet(stepping)
    if not way.possible:
        who = f"{robot.leg_names[way.short]} could not stand and step" if way.balanced else _TIPS_OVER
        return f"body: on the way there {who}"
    whole = share == works
    return Change(
        manner=manner,
        whole=whole,
        posture=goal.posture,
        rest=goal.rest,
        tempo=pace,
        stepping=stepping,
        way=way,
        there=there,
        limited=_limits(manner, pace, why if whole else ""),
        terrain=goal.terrain,
    )


def _envelope_of(robot: Robot, manner: Manner, posed: Posed, sets: Floats, foot_distance: float) -> Parts[Envelope]:
    """Work out what is possible in a posture, with its sway."""
    stands = [posed._replace(posture=row).stand for row in swaying(posed.posture, manner.sway)]
    return (yield from envelope(robot, stands, sets, foot_distance=foot_distance, gone=manner.gone))


def _why_not(robot: Robot, manner: Manner, posed: Posed, there: Envelope) -> str:
    """Say why a robot can't stand and step in a posture."""
    if not there.balanced:
        return _TIPS_OVER
    if any(manner.sway):
        return f"{robot.leg_names[there.short]} comes to the end of its reach as the body sways"
    return what_stops(robot, posed.stand)


def _limits(manner: Manner, pace: Tempo, why: str) -> tuple[str, ...]:
    """Say what of a manner doesn't work."""
    limited: tuple[str, ...] = (f"body: it goes no farther that way, {why}",) if why else ()
    if manner.cycle_time is not None and pace.cycle_time > manner.cycle_time:
        reason = (
            f"cycle_time {manner.cycle_time:.3g} s is too short for the joints to lift the feet "
            f"{manner.lift * 1000:.0f} mm and get on: {pace.cycle_time:.3g} s is taken"
        )
        limited += (reason,)
    return limited
