"""How the walk goes on from one moment to another: a function of the moment, without memory."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.control.filters import CriticallyDamped
from tarsus.control.sensing.ground_plane import FLAT
from tarsus.control.walk.foothold import FootholdPredictor, final_footholds
from tarsus.control.walk.state import PHASE_TOLERANCE, POSITION_TOLERANCE, GaitState, StepInputs, integrate_twist
from tarsus.control.workspace.stance_geometry import SWING_HEIGHT

__all__ = ["LATEST_LIFT_OFF", "TARGET_FREEZE", "advance", "quintic"]

Floats = np.ndarray[Any, Any]

TARGET_FREEZE = 0.6
"""Share of the swing after which the foot's target stays: what is left is enough to come to it gently."""

LATEST_LIFT_OFF = 0.5
"""Of how much of its swing a foot that was held back may be deprived at most."""

# How fast feet give way [rad/s].
_GIVING = 20.0
# How much of the lift a foot takes at the least.
_LEAST_LIFT = 0.3
# A speed this low is none [m/s]; a posture this near to its target, and as slow, is there [m, m/s, rad, rad/s].
_NO_SPEED, _NO_WAY = 3e-7, 1e-11


def advance(now: GaitState, course: StepInputs, dt: float) -> GaitState:
    """Return the moment after a time.

    Parameters
    ----------
    now : Moment
        The moment.
    course : Course
        What the robot is doing.
    dt : float
        The time [s].
    """
    twist, travel = now.twist.go(course.twist, dt, bandwidth=course.bandwidth)
    origin, yaw = integrate_twist(now.origin, now.yaw, travel)
    stopping = not any(course.twist.tolist())
    if stopping and max(map(abs, twist.value.tolist())) < _NO_SPEED:
        twist = CriticallyDamped.still(np.zeros(3))
    gone = course.frequency * dt
    rhythm, cycles, beats = now.rhythm, 0.0, 0.0
    if course.sways:
        pace = course.frequency * np.array([1.0, course.beats])
        rhythm, (cycles, beats) = now.rhythm.go(pace, dt, bandwidth=course.bandwidth)
    clock = now.clock + gone
    after = now._replace(
        clock=clock,
        origin=origin,
        yaw=yaw,
        twist=twist,
        posture=_settled(now.posture, course.posture, dt, course.posture_bandwidth),
        rhythm=rhythm,
        elevation=_settled(now.elevation, course.elevation, dt, course.elevation_bandwidth),
        give_way=_settled(now.give_way, course.give_way, dt, _GIVING),
        cycles=now.cycles + cycles,
        beats=now.beats + beats,
    )
    duty_factor = course.gait.duty_factor
    since_lift = [clock - (o + duty_factor + n) for o, n in zip(course.gait.offsets, now.number.tolist(), strict=True)]
    down = now.down.tolist()
    due = [on and since > PHASE_TOLERANCE and not course.holds for on, since in zip(down, since_lift, strict=True)]
    if any(due):
        after = _lift(after, course, np.array(due), np.array(since_lift) - gone, stopping=stopping)
        down = after.down.tolist()
    return after if all(down) else _swing(after, course, down, since_lift, stopping=stopping)


def _settled(lag: CriticallyDamped, target: Floats, dt: float, bandwidth: float) -> CriticallyDamped:
    """Return a lag after a time; once it is at its target, it is the same one from then on."""
    if lag.value is target:
        return lag
    after = lag.step(target, dt, bandwidth=bandwidth)
    off = max(float(np.abs(after.value - target).max()), float(np.abs(after.rate).max()))
    return after if off > _NO_WAY else CriticallyDamped.still(target)


def _lift(now: GaitState, course: StepInputs, due: Floats, late: Floats, *, stopping: bool) -> GaitState:
    """Lift the feet whose time has come; those that may not, or needn't, miss this step.

    `late` is how long ago their time was [cycles]: what the clock has gone in this tick doesn't count.
    """
    wanted = due & course.steps
    final = final_footholds(now, course) if stopping else None
    if final is not None:
        wanted = wanted & (np.abs(now.foot - final) > POSITION_TOLERANCE)
    missed = due & ~wanted
    start, given = now.ground, now.give_way
    if given.value.any():
        # What a foot has given way is part of its swing.
        start = start + given.value
        given = given._replace(value=np.where(wanted, 0.0, given.value))
    ground = course.ground.height(now.foot.real, now.foot.imag)
    return now._replace(
        number=now.number + missed,
        down=now.down & ~wanted,
        share=np.where(wanted, 0.0, now.share),
        start_height=np.where(wanted, start, now.start_height),
        ground=np.where(wanted, ground, now.ground),
        lift_part=np.where(wanted, _lift_part(now, course, np.maximum(start, ground)), now.lift_part),
        give_way=given,
        # Feet that were held back go a shorter swing.
        late=np.where(due, np.clip(late, 0.0, LATEST_LIFT_OFF * (1 - course.gait.duty_factor)), now.late),
    )


def _lift_part(now: GaitState, course: StepInputs, height: Floats) -> Floats:
    """Return how much of the lift feet take that are lifted from a height, so as to get no higher than they should."""
    over = np.maximum(height - course.highest, 0.0)
    return np.asarray(np.maximum(1 - over / max(float(now.posture.value[SWING_HEIGHT]), 1e-6), _LEAST_LIFT))


def _swing(
    now: GaitState, course: StepInputs, down: list[bool], since_lift: list[float], *, stopping: bool
) -> GaitState:
    """Move the swinging feet on, and put those down that have come to the end of their swing."""
    duty_factor = course.gait.duty_factor
    swing, stance = 1 - duty_factor, duty_factor / course.frequency
    landing = FootholdPredictor.of(now, course)
    final = final_footholds(now, course) if stopping else None
    share, foot, target = now.share.tolist(), now.foot.tolist(), now.target.tolist()
    pace, bend = now.pace.tolist(), now.bend.tolist()
    lands, landed = course.lands.tolist(), []
    flat, ground = course.ground is FLAT, now.ground
    met, give, lateness = now.met.tolist(), now.give.tolist(), now.late.tolist()
    for leg in [leg for leg, on in enumerate(down) if not on]:
        late, since = lateness[leg], since_lift[leg]
        part = min(max((since - late) / (swing - late), 0.0), 1.0)
        if share[leg] <= TARGET_FREEZE and met[leg] == math.inf:
            until = (swing - since) / course.frequency
            before = target[leg]
            target[leg] = (
                landing.foothold(complex(course.rest[leg]), course.room[leg], until, until + stance / 2)
                if final is None
                else complex(final[leg])
            )
            if not flat:
                ground = _on_ground(ground, leg, target[leg] - before, course, just_lifted=share[leg] == 0)
        way = (foot[leg], pace[leg], bend[leg])
        # A foot that has met the ground stops on it.
        left = min(met[leg] + give[leg], 1.0) - share[leg]
        foot[leg], pace[leg], bend[leg] = (
            quintic(way, target[leg], left, min((part - share[leg]) / left, 1.0)) if left > 0 else (target[leg], 0j, 0j)
        )
        share[leg] = part
        if lands[leg] and since >= swing - PHASE_TOLERANCE:
            landed.append(leg)
            share[leg], foot[leg], pace[leg], bend[leg] = 0.0, target[leg], 0j, 0j
    after = now._replace(
        share=np.array(share),
        foot=np.array(foot),
        target=np.array(target),
        pace=np.array(pace),
        bend=np.array(bend),
        ground=ground,
    )
    return _land(after, landed) if landed else after


def _on_ground(ground: Floats, leg: int, moved: complex, course: StepInputs, *, just_lifted: bool) -> Floats:
    """Return the heights at which feet are to land, where one of them is to land elsewhere by now."""
    changed = ground.copy()
    changed[leg] += course.ground.slope_x * moved.real + course.ground.slope_y * moved.imag
    if just_lifted:
        changed[leg] = max(changed[leg], np.broadcast_to(course.lowest, ground.shape)[leg])
    return changed


def quintic(way: tuple[Any, Any, Any], target: Any, left: Any, x: Any) -> tuple[Any, Any, Any]:
    """Go a part of the rest of the swing, on the quintic that ends at the target at rest.

    Parameters
    ----------
    way : tuple of (complex or array)
        Where the foot is [m], and the first and second derivative of its way by the share of the swing.
    target : complex or array
        Where it goes [m].
    left : float or array
        What share of the swing is left, above 0.
    x : float or array
        What part of that to go.
    """
    here, speed, half = way[0], way[1] * left, way[2] * (left * left / 2)
    gap, missing, bent = target - (here + speed + half), -(speed + 2 * half), -2 * half
    a3 = 10 * gap - 4 * missing + bent / 2
    a4 = -15 * gap + 7 * missing - bent
    a5 = 6 * gap - 3 * missing + bent / 2
    return (
        here + x * (speed + x * (half + x * (a3 + x * (a4 + x * a5)))),
        (speed + x * (2 * half + x * (3 * a3 + x * (4 * a4 + x * 5 * a5)))) / left,
        (2 * half + x * (6 * a3 + x * (12 * a4 + x * 20 * a5))) / (left * left),
    )


def _land(now: GaitState, landed: list[int]) -> GaitState:
    """Put feet down that are where they are to land."""
    number, down, met = now.number.copy(), now.down.copy(), now.met.copy()
    number[landed] += 1
    down[landed], met[landed] = True, np.inf
    return now._replace(number=number, down=down, met=met)
