"""Planning a walk: from a gait and a path to joint angles over time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from tarsus.errors import CollisionError, InputError, StrokeError, UnreachableError
from tarsus.gait.cycle import tilted_body
from tarsus.gait.excursion import MOMENTS_OF_SWING
from tarsus.gait.gait import Gait
from tarsus.gait.motion import Motion
from tarsus.gait.pace import choose_pace
from tarsus.gait.path import BodyPath, carry
from tarsus.gait.setup import Setup, require_number
from tarsus.gait.spacing import passing_distance
from tarsus.gait.stroke import longest_stroke, stroke_verdict, unit_twist
from tarsus.gait.swing import swing
from tarsus.gait.timing import BodyClock, Steps, least_step_share, plan_steps
from tarsus.robot.robot import Robot

__all__ = ["plan_walk"]

_MOST_SAMPLES = 2_000_000
_LEAST_PATH = 1e-9
_LONGEST_STROKE = 1e3


def plan_walk(  # noqa: PLR0913 - what a walk can be told is one list, all of it optional
    robot: Robot,
    gait: Gait,
    path: BodyPath,
    *,
    stroke: float | None = None,
    speed: float | None = None,
    cycle_time: float | None = None,
    body_height: float | None = None,
    swing_height: float | None = None,
    body_tilt: Sequence[float] = (0.0, 0.0),
    foot_distance: float | None = None,
    rate: float = 100.0,
    strict: bool = True,
) -> Motion:
    """Plan a walk along a path, from standing to standing.

    Each leg has its clock; a foot that touches down at time `t` and stays for the stance time `Ts` is placed where the
    body has its rest foothold in the middle of the stance: ``T_ground_body(t + Ts / 2) @ rest``. The body starts and
    stops along smooth ramps of one cycle each. So strokes are symmetric about the rest footholds, a curved walk's
    are arcs about its centre, the path's distance and angle come out exactly, and the walk ends in the stance that
    it began in.

    Parameters
    ----------
    robot : Robot
        A single robot.
    gait : Gait
        Its gait.
    path : Path
        Where the body goes.
    stroke : float, optional
        How far the foot that goes farthest goes past the body in one stance [m]. Left out, it follows from speed
        and cycle time, or is 0.6 of the longest that works.
    speed : float, optional
        Speed of that foot past the body [m/s]: on a straight walk, the body's. Left out, it follows from stroke and
        cycle time, or from the path's duration.
    cycle_time : float, optional
        Duration of a cycle [s]. Left out, it follows from stroke and speed; where neither speed nor duration is
        given, it is 1 s, or longer where a joint would else exceed half its servo's no-load speed.
    body_height : float, optional
        Height of the body's origin over the ground [m]; the robot's own where left out.
    swing_height : float, optional
        Lift of the swinging feet [m]; the robot's own where left out.
    body_tilt : (roll, pitch)
        Tilt of the body against the ground while walking [rad].
    foot_distance : float, optional
        Least distance between two feet [m]; two foot radii and 10 mm where left out.
    rate : float
        Samples per second [1/s]; enough that every swing has one.
    strict : bool
        Whether a stroke longer than `max_stroke`, or feet too near to each other, are refused. If not, the motion
        comes with its reach codes and problems.

    Returns
    -------
    Motion
        Sampled at ``k / rate``, from the first lift-off until all feet stand. A path too short for start and stop at
        the stroke is walked with shorter steps.

    Raises
    ------
    InputError
        If an argument is not finite or out of its range, or stroke, speed and cycle time contradict each other.
    UnreachableError
        If a leg reaches the ground nowhere at that body height.
    StrokeError
        If the stroke leaves the workspace; the message says which leg, and the longest stroke that works.
    CollisionError
        If two feet come nearer to each other than allowed.
    """
    setup = Setup.of(
        robot,
        gait,
        body_height=body_height,
        swing_height=swing_height,
        body_tilt=body_tilt,
        foot_distance=foot_distance,
    )
    assumed = setup.assumed(body_height, swing_height)
    stroke, speed, cycle_time = (
        None if value is None else require_number(name, value, zero=False)
        for name, value in (("stroke", stroke), ("speed", speed), ("cycle_time", cycle_time))
    )
    rate = require_number("rate", rate, zero=False)
    travel = float(path.travel(setup.rest).max())
    if not _LEAST_PATH <= travel < math.inf:
        raise InputError(f"the path takes the feet {travel:g} m past the body; that is no walk")
    stroke, cycle_time = choose_pace(setup, path, stroke=stroke, speed=speed, cycle_time=cycle_time, assumed=assumed)
    stroke = require_number("stroke", stroke, zero=False, most=_LONGEST_STROKE)
    steps = _steps(gait, travel=travel, stroke=stroke, cycle_time=cycle_time, rate=rate)
    motion = _sample(setup, path, steps, stroke=stroke, rate=rate, assumed=tuple(assumed))
    if strict:
        _refuse_near_feet(setup, path, steps, motion)
        _refuse_stroke(setup, path, motion)
    return motion


def _steps(gait: Gait, *, travel: float, stroke: float, cycle_time: float, rate: float) -> Steps:
    """Return the steps of a walk; refuse one of too many samples, or with too few to show every swing."""
    swing_time = cycle_time * (1 - gait.duty_factor)
    if swing_time * rate < 1:
        raise InputError(
            f"rate is {rate:g} samples a second: a swing takes {swing_time:g} s, so that feet would move between two "
            f"samples unseen; at least {1 / swing_time if swing_time else math.inf:.4g} are needed"
        )
    strokes = travel / stroke
    cycles = strokes * gait.duty_factor + 2
    if not cycles * cycle_time * rate <= _MOST_SAMPLES:
        raise InputError(
            f"the walk takes {cycles * cycle_time:.3g} s: {cycles * cycle_time * rate:.3g} samples at {rate:g} a "
            f"second; at most {_MOST_SAMPLES} are planned at once"
        )
    # A path that is far shorter than a stroke is all start and stop, how much shorter makes no difference.
    clock = BodyClock.of(rate=1 / (max(strokes * gait.duty_factor, 0.1) * cycle_time), ramp=cycle_time)
    return plan_steps(gait, clock, cycle_time=cycle_time, least_step=least_step_share(strokes))


def _walk_feet(
    setup: Setup, path: BodyPath, steps: Steps, moments: np.ndarray[Any, Any]
) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """Return the feet in G, and whether they are on the ground."""
    last, following, swung, contacts = steps.at(moments)
    rest = setup.rest[:, None, :]
    start = carry(path.place(last), rest)[..., 0, :]
    end = carry(path.place(following), rest)[..., 0, :]
    return np.where(contacts[..., None], start, swing(start, end, swung, setup.swing_height)), contacts


def _sample(
    setup: Setup, path: BodyPath, steps: Steps, *, stroke: float, rate: float, assumed: tuple[str, ...]
) -> Motion:
    """Work out the motion at every sample."""
    duration = steps.end - steps.start
    # Rounding must not add a sample where the end falls on one.
    time = np.arange(math.ceil(duration * rate - 1e-6) + 1) / rate
    # After the last touchdown every leg stands; far behind it no rounding tells otherwise.
    moments = np.where(time >= duration - 1e-9, steps.end + 2 * steps.cycle_time, time + steps.start)
    feet, contacts = _walk_feet(setup, path, steps, moments)
    place = path.place(steps.clock.share(moments))
    solution = setup.solve(feet, place)
    return Motion(
        robot=setup.robot,
        gait=setup.gait,
        time=time,
        body=tilted_body(place, body_height=np.asarray(setup.body_height), body_tilt=setup.body_tilt),
        feet=feet,
        contacts=contacts,
        angles=solution.angles,
        reach=solution.reach,
        cycle_time=steps.cycle_time,
        stroke=stroke,
        speed=stroke / (setup.gait.duty_factor * steps.cycle_time),
        body_height=setup.body_height,
        swing_height=setup.swing_height,
        foot_distance=setup.foot_distance,
        assumed=assumed,
    )


def _refuse_near_feet(setup: Setup, path: BodyPath, steps: Steps, motion: Motion) -> None:
    """Raise if the feet come too near to each other, at a sample or between."""
    time, feet = motion.time, motion.feet
    between = steps.cycle_time * (1 - setup.gait.duty_factor) / MOMENTS_OF_SWING
    if time[1] - time[0] > between:
        time = np.arange(0, steps.end - steps.start, between)
        feet = _walk_feet(setup, path, steps, time + steps.start)[0]
    distance, pair = passing_distance(feet)
    worst = int(np.argmin(distance))
    if distance[worst] < setup.foot_distance - 1e-9:
        legs = " and ".join(setup.robot.leg_codes[i] for i in pair[worst])
        longest = longest_stroke(setup, path.displacement)
        advice = f"A stroke of {longest * 1000:.1f} mm or less keeps them apart" if longest else "No stroke works here"
        raise CollisionError(
            f"the feet of {legs} come as near as {distance[worst] * 1000:.1f} mm at {time[worst]:.2f} s; "
            f"at least {setup.foot_distance * 1000:.1f} mm are asked for. {advice}"
        )


def _refuse_stroke(setup: Setup, path: BodyPath, motion: Motion) -> None:
    """Raise if the stroke is too long for a walk of any length; that this one leaves the workspace follows."""
    works, solution = stroke_verdict(setup, unit_twist(setup.rest, path.displacement) * motion.stroke)
    if works.all() and not motion.reach.any():
        return
    found = [problem for problem in motion.problems if problem.startswith(("out of reach", "jumps"))]
    if works.all():
        raise UnreachableError(f"a stroke of {motion.stroke * 1000:.1f} mm does not work here: {found[0]}")
    if found:
        reason = found[0]
    elif (solution.reach != 0).any():
        reason = f"out of reach: in a start or stop {solution.explain().splitlines()[0]}"
    else:
        leg = setup.robot.leg_names[int(np.argmin(works))]
        reason = f"jumps: in a start or stop leg {leg} would have to go over to another way to reach its foot"
    longest = longest_stroke(setup, path.displacement)
    advice = f"the longest stroke that works here is {longest * 1000:.1f} mm" if longest else "no stroke works here"
    raise StrokeError(f"a stroke of {motion.stroke * 1000:.1f} mm is too long: {reason}. As planned, {advice}", longest)
