"""Planning of a walk: joint angles over time from a gait and a path."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tarsus.errors import CollisionError, InputError, StrokeError, UnreachableError
from tarsus.gait.body_shift import shift_at
from tarsus.gait.cycle import tilted_body
from tarsus.gait.excursion import SWING_SAMPLES
from tarsus.gait.gait import Gait
from tarsus.gait.motion import Motion
from tarsus.gait.pace import choose_pace
from tarsus.gait.path import BodyPath, heading_to_ground
from tarsus.gait.rolling_feet import roll_feet
from tarsus.gait.shifted_walk import shifted_pose, walk_shift
from tarsus.gait.spacing import passing_distance
from tarsus.gait.stroke import first_failure, leg_feasibility, longest_stroke, unit_twist
from tarsus.gait.swing import horizontal_profile, swing_position
from tarsus.gait.timing import BodyClock, Steps, least_step_fraction, plan_steps
from tarsus.gait.walk_setup import WalkSetup, require_number
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["plan_walk"]

# Most samples of a motion; least travel of the outermost foot along a path [m].
_MOST_SAMPLES = 500_000
_SHORTEST_PATH = 1e-9
# Tolerance for rounding of the number of samples in a swing.
_ROUNDING = 1e-6
# Upper bound of the stroke [m].
_LONGEST_STROKE = 1e3
# Time before the first lift-off in which a body shift sets in, and after the last touchdown in which it ends [cycles].
_LEAD = 0.5


def plan_walk(  # noqa: PLR0913 - the options of a walk, all of them with defaults
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
    stance_width: float = 0.0,
    foot_distance: float | None = None,
    rate: float = 100.0,
    strict: bool = True,
) -> Motion:
    """Plan a walk along a path, from standing to standing.

    A foot that touches down at time `t` for the stance time `Ts` is placed at the rest foothold of the body's pose at
    mid-stance: ``T_ground_body(t + Ts / 2) @ rest``. The body starts and stops along smooth ramps of one cycle each.
    Strokes are therefore symmetric about the rest footholds, those of a curved walk are arcs about its centre, distance
    and angle of the path are exact, and the walk ends in the stance in which it started. With a gait that has a body
    shift, the body also moves over the feet on the ground, smoothly and periodically.

    Parameters
    ----------
    robot : Robot
        A single robot.
    gait : Gait
        The gait.
    path : BodyPath
        Path of the body.
    stroke : float, optional
        Distance that the outermost foot moves relative to the body in one stance [m]. Default: from speed and cycle
        time, else 0.6 of the longest possible.
    speed : float, optional
        Speed of that foot relative to the body [m/s]; on a straight walk, the speed of the body. Default: from stroke
        and cycle time, else from the duration of the path.
    cycle_time : float, optional
        Duration of a cycle [s]. Default: from stroke and speed; without speed and duration 1 s, or longer where a joint
        would exceed half the no-load speed of its servo, or half of 5 rad/s where that is unknown.
    body_height : float, optional
        Height of the body's origin above the ground [m]. Default: the robot's.
    swing_height : float, optional
        Swing height [m]. Default: the robot's.
    body_tilt : (roll, pitch)
        Tilt of the body relative to the ground [rad].
    stance_width : float
        How much farther out than the default stance the feet rest [m]; negative for nearer.
    foot_distance : float, optional
        Least distance between two feet [m]. Default: two foot radii and 10 mm.
    rate : float
        Samples per second [1/s]; more than one per swing.
    strict : bool
        Whether to raise an error where the stroke exceeds `max_stroke` or feet come too close to each other; else
        `Motion.problems` lists it.

    Returns
    -------
    Motion
        Sampled at ``k / rate``, from the first lift-off to the last touchdown, with half a cycle before and after for a
        body shift. A path too short for start and stop with that stroke is walked with shorter steps.

    Raises
    ------
    InputError
        If an argument is not finite or out of range, or stroke, speed and cycle time are inconsistent.
    UnreachableError
        If a leg does not reach the ground at that body height.
    StrokeError
        If the stroke leaves the workspace; the message names the leg and the longest stroke possible.
    CollisionError
        If two feet come closer to each other than `foot_distance`.
    """
    setup = WalkSetup.of(
        robot,
        gait,
        body_height=body_height,
        swing_height=swing_height,
        body_tilt=body_tilt,
        foot_distance=foot_distance,
        stance_width=stance_width,
    )
    assumed = setup.assumed(body_height, swing_height)
    stroke, speed, cycle_time = (
        None if value is None else require_number(name, value, zero=False)
        for name, value in (("stroke", stroke), ("speed", speed), ("cycle_time", cycle_time))
    )
    rate = require_number("rate", rate, zero=False)
    if not isinstance(path, BodyPath):
        raise InputError(f"path is {path!r}; it must be a BodyPath, like straight_path(1.0)")
    travel = float(path.travel(setup.rest).max())
    if not _SHORTEST_PATH <= travel < math.inf:
        raise InputError(
            f"the feet move {travel:g} m relative to the body along the path; "
            f"it must be a finite number of at least {_SHORTEST_PATH:g} m"
        )
    stroke, cycle_time = choose_pace(setup, path, stroke=stroke, speed=speed, cycle_time=cycle_time, assumed=assumed)
    stroke = require_number("stroke", stroke, zero=False, most=_LONGEST_STROKE)
    steps = _steps(gait, travel=travel, stroke=stroke, cycle_time=cycle_time, rate=rate)
    motion = _sample(setup, path, steps, stroke=stroke, rate=rate, assumed=tuple(assumed))
    if strict:
        _refuse_close_feet(setup, path, steps, motion)
        _refuse_stroke(setup, path, motion)
    return motion


def _steps(gait: Gait, *, travel: float, stroke: float, cycle_time: float, rate: float) -> Steps:
    """Return the steps of a walk; refuse too many samples, and a rate at which swings may fall between two samples."""
    swing_time = cycle_time * (1 - gait.duty_factor)
    if swing_time * rate <= 1 + _ROUNDING:
        raise InputError(
            f"rate is {rate:g} Hz, and a swing takes {swing_time:g} s: it would fall between two samples; "
            f"rate must be more than {1 / swing_time if swing_time else math.inf:.4g} Hz"
        )
    strokes = travel / stroke
    cycles = strokes * gait.duty_factor + 2
    if not cycles * cycle_time * rate <= _MOST_SAMPLES:
        raise InputError(
            f"the walk takes {cycles * cycle_time:.3g} s, {cycles * cycle_time * rate:.3g} samples at {rate:g} Hz; "
            f"at most {_MOST_SAMPLES} samples are possible"
        )
    # A path much shorter than a stroke consists of start and stop only, however short it is.
    clock = BodyClock.of(rate=1 / (max(strokes * gait.duty_factor, 0.1) * cycle_time), ramp=cycle_time)
    return plan_steps(gait, clock, cycle_time=cycle_time, least_step=least_step_fraction(strokes))


def _walk_feet(
    setup: WalkSetup, path: BodyPath, steps: Steps, time: Float[np.ndarray, "..."]
) -> tuple[Float[np.ndarray, "... legs 3"], Bool[np.ndarray, "... legs"]]:
    """Return the feet in G and their contacts at times since the body's start."""
    last, following, swing_phase, contacts = steps.at(time)
    rest = setup.rest[:, None, :]
    start = heading_to_ground(path.planar_pose(last), rest)[..., 0, :]
    end = heading_to_ground(path.planar_pose(following), rest)[..., 0, :]
    return np.where(contacts[..., None], start, swing_position(start, end, swing_phase, setup.swing_height)), contacts


def _sample(
    setup: WalkSetup, path: BodyPath, steps: Steps, *, stroke: float, rate: float, assumed: tuple[str, ...]
) -> Motion:
    """Compute the motion at every sample."""
    lead = _lead(setup, steps)
    duration = steps.end - steps.start + 2 * lead
    # Rounding must not add a sample where the end falls on one.
    time = np.arange(math.ceil(duration * rate - 1e-6) + 1) / rate
    # At the end every leg stands: a time well after the last touchdown, so that rounding leaves no foot in the air.
    since_start = np.where(time >= duration - lead - 1e-9, steps.end + 2 * steps.cycle_time, time - lead + steps.start)
    feet, contacts = _walk_feet(setup, path, steps, np.maximum(since_start, steps.start))
    planar_pose = path.planar_pose(steps.clock.fraction(since_start))
    if setup.gait.body_shift:
        shift = walk_shift(setup, unit_twist(setup.rest, path.displacement) * stroke)
        # The shift sets in and ends while every foot is on the ground.
        share = horizontal_profile(np.clip(np.minimum(time, duration - time) / lead, 0.0, 1.0))
        displacement = share * shift_at(shift, (time - lead + steps.start) / steps.cycle_time)
        planar_pose = shifted_pose(planar_pose, displacement)
    feet, solution = roll_feet(setup, feet, contacts, planar_pose)
    return Motion(
        robot=setup.robot,
        gait=setup.gait,
        time=time,
        body=tilted_body(planar_pose, body_height=np.asarray(setup.body_height), body_tilt=setup.body_tilt),
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


def _lead(setup: WalkSetup, steps: Steps) -> float:
    """Return the time in which the body shift sets in before the first lift-off, and ends after the last touchdown."""
    return _LEAD * steps.cycle_time if setup.gait.body_shift else 0.0


def _refuse_close_feet(setup: WalkSetup, path: BodyPath, steps: Steps, motion: Motion) -> None:
    """Raise if feet come too close to each other, at a sample or between two."""
    time, feet = motion.time, motion.feet
    between, late = steps.cycle_time * (1 - setup.gait.duty_factor) / SWING_SAMPLES, 0.0
    if time[1] - time[0] > between:
        time, late = np.arange(0, steps.end - steps.start, between), _lead(setup, steps)
        feet = _walk_feet(setup, path, steps, time + steps.start)[0]
    distance, pair = passing_distance(feet)
    worst = int(np.argmin(distance))
    if distance[worst] < setup.foot_distance - 1e-9:
        legs = " and ".join(setup.robot.leg_codes[i] for i in pair[worst])
        longest = longest_stroke(setup, path.displacement)
        advice = f"Strokes up to {longest * 1000:.1f} mm are possible" if longest else "No stroke is possible here"
        raise CollisionError(
            f"the feet of {legs} are {distance[worst] * 1000:.1f} mm apart at {time[worst] + late:.2f} s, "
            f"less than the required foot distance of {setup.foot_distance * 1000:.1f} mm. {advice}"
        )


def _refuse_stroke(setup: WalkSetup, path: BodyPath, motion: Motion) -> None:
    """Raise if the stroke is too long for a walk of any length, or this walk leaves the workspace."""
    feasible, solution = leg_feasibility(setup, unit_twist(setup.rest, path.displacement) * motion.stroke)
    if feasible.all() and not motion.reach.any():
        return
    kinds = ("out of reach", "jumps")
    found = [text.removeprefix("out of reach: ") for text in motion.problems if text.startswith(kinds)]
    if feasible.all():
        raise UnreachableError(f"a stroke of {motion.stroke * 1000:.1f} mm is not possible here: {found[0]}")
    if found:
        reason = found[0]
    elif not feasible.any() and setup.gait.body_shift:
        reason = "tips over: no body shift keeps the stability margin during all of the walk"
    elif (solution.reach != 0).any():
        reason = f"during start or stop, {first_failure(solution)}"
    else:
        leg = setup.robot.leg_names[int(np.argmin(feasible))]
        reason = f"jumps: during start or stop, leg {leg} would change its inverse-kinematics branch"
    longest = longest_stroke(setup, path.displacement)
    advice = f"the longest possible is {longest * 1000:.1f} mm" if longest else "no stroke is possible here"
    raise StrokeError(
        f"a stroke of {motion.stroke * 1000:.1f} mm is too long: {reason}. With these settings {advice}", longest
    )
