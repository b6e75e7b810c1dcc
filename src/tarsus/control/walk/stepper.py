"""How the walk goes on from one moment to another: a function of the moment, without memory."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.control.filters import CriticallyDamped
from tarsus.control.sensing.ground_plane import FLAT
from tarsus.control.walk.foothold import FootholdPredictor, final_footholds
from tarsus.control.walk.state import PHASE_TOLERANCE, POSITION_TOLERANCE, GaitState, StepInputs, integrate_twist
from tarsus.control.walk.swing_trajectory import quintic
from tarsus.control.workspace.stance_geometry import SWING_HEIGHT

__all__ = ["LATEST_LIFT_OFF", "TARGET_FREEZE", "advance"]

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


def advance(now: GaitState, inputs: StepInputs, dt: float) -> GaitState:
    """Return the moment after a time.

    Parameters
    ----------
    now : Moment
        The moment.
    inputs : Course
        What the robot is doing.
    dt : float
        The time [s].
    """
    twist, travel = now.twist.go(inputs.twist, dt, bandwidth=inputs.bandwidth)
    origin, yaw = integrate_twist(now.origin, now.yaw, travel)
    stopping = not any(inputs.twist.tolist())
    if stopping and max(map(abs, twist.value.tolist())) < _NO_SPEED:
        twist = CriticallyDamped.still(np.zeros(3))
    gone = inputs.frequency * dt
    rhythm, cycles, beats = now.rhythm, 0.0, 0.0
    if inputs.swaying:
        pace = inputs.frequency * np.array([1.0, inputs.beats])
        rhythm, (cycles, beats) = now.rhythm.go(pace, dt, bandwidth=inputs.bandwidth)
    clock = now.clock + gone
    after = now._replace(
        clock=clock,
        origin=origin,
        yaw=yaw,
        twist=twist,
        posture=_settled(now.posture, inputs.posture, dt, inputs.posture_bandwidth),
        rhythm=rhythm,
        elevation=_settled(now.elevation, inputs.elevation, dt, inputs.elevation_bandwidth),
        admittance_offset=_settled(now.admittance_offset, inputs.admittance_offset, dt, _GIVING),
        cycles=now.cycles + cycles,
        beats=now.beats + beats,
    )
    duty_factor = inputs.gait.duty_factor
    since_lift = [
        clock - (o + duty_factor + n) for o, n in zip(inputs.gait.offsets, now.step_number.tolist(), strict=True)
    ]
    down = now.down.tolist()
    due = [on and since > PHASE_TOLERANCE and not inputs.hold_feet for on, since in zip(down, since_lift, strict=True)]
    if any(due):
        after = _lift(after, inputs, np.array(due), np.array(since_lift) - gone, stopping=stopping)
        down = after.down.tolist()
    return after if all(down) else _swing(after, inputs, down, since_lift, stopping=stopping)


def _settled(lag: CriticallyDamped, target: Floats, dt: float, bandwidth: float) -> CriticallyDamped:
    """Return a lag after a time; once it is at its target, it is the same one from then on."""
    if lag.value is target:
        return lag
    after = lag.step(target, dt, bandwidth=bandwidth)
    off = max(float(np.abs(after.value - target).max()), float(np.abs(after.rate).max()))
    return after if off > _NO_WAY else CriticallyDamped.still(target)


def _lift(now: GaitState, inputs: StepInputs, due: Floats, late: Floats, *, stopping: bool) -> GaitState:
    """Lift the feet whose time has come; those that may not, or needn't, miss this step.

    `late` is how long ago their time was [cycles]: what the clock has gone in this tick doesn't count.
    """
    wanted = due & inputs.may_lift
    final = final_footholds(now, rest=inputs.rest, bandwidth=inputs.bandwidth) if stopping else None
    if final is not None:
        wanted = wanted & (np.abs(now.foot - final) > POSITION_TOLERANCE)
    missed = due & ~wanted
    start, given = now.ground_height, now.admittance_offset
    if given.value.any():
        # What a foot has given way is part of its swing.
        start = start + given.value
        given = given._replace(value=np.where(wanted, 0.0, given.value))
    ground = inputs.ground_plane.height(now.foot.real, now.foot.imag)
    return now._replace(
        step_number=now.step_number + missed,
        down=now.down & ~wanted,
        swing_phase=np.where(wanted, 0.0, now.swing_phase),
        start_height=np.where(wanted, start, now.start_height),
        ground_height=np.where(wanted, ground, now.ground_height),
        height_factor=np.where(wanted, _lift_part(now, inputs, np.maximum(start, ground)), now.height_factor),
        admittance_offset=given,
        # Feet that were held back go a shorter swing.
        lift_delay=np.where(due, np.clip(late, 0.0, LATEST_LIFT_OFF * (1 - inputs.gait.duty_factor)), now.lift_delay),
    )


def _lift_part(now: GaitState, inputs: StepInputs, height: Floats) -> Floats:
    """Return how much of the lift feet take that are lifted from a height, so as to get no higher than they should."""
    over = np.maximum(height - inputs.highest_ground, 0.0)
    return np.asarray(np.maximum(1 - over / max(float(now.posture.value[SWING_HEIGHT]), 1e-6), _LEAST_LIFT))


def _swing(
    now: GaitState, inputs: StepInputs, down: list[bool], since_lift: list[float], *, stopping: bool
) -> GaitState:
    """Move the swinging feet on, and put those down that have come to the end of their swing."""
    duty_factor = inputs.gait.duty_factor
    swing, stance = 1 - duty_factor, duty_factor / inputs.frequency
    landing = FootholdPredictor.of(now, inputs)
    final = final_footholds(now, rest=inputs.rest, bandwidth=inputs.bandwidth) if stopping else None
    share, foot, target = now.swing_phase.tolist(), now.foot.tolist(), now.foothold.tolist()
    pace, bend = now.swing_velocity.tolist(), now.swing_acceleration.tolist()
    lands, landed = inputs.may_land.tolist(), []
    flat, ground = inputs.ground_plane is FLAT, now.ground_height
    met, give, lateness = now.contact_phase.tolist(), now.stop_phase.tolist(), now.lift_delay.tolist()
    for leg in [leg for leg, on in enumerate(down) if not on]:
        late, since = lateness[leg], since_lift[leg]
        part = min(max((since - late) / (swing - late), 0.0), 1.0)
        if share[leg] <= TARGET_FREEZE and met[leg] == math.inf:
            until = (swing - since) / inputs.frequency
            before = target[leg]
            target[leg] = (
                landing.foothold(complex(inputs.rest[leg]), inputs.placement_bounds[leg], until, until + stance / 2)
                if final is None
                else complex(final[leg])
            )
            if not flat:
                ground = _on_ground(ground, leg, target[leg] - before, inputs, just_lifted=share[leg] == 0)
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
        swing_phase=np.array(share),
        foot=np.array(foot),
        foothold=np.array(target),
        swing_velocity=np.array(pace),
        swing_acceleration=np.array(bend),
        ground_height=ground,
    )
    return _land(after, landed) if landed else after


def _on_ground(ground: Floats, leg: int, moved: complex, inputs: StepInputs, *, just_lifted: bool) -> Floats:
    """Return the heights at which feet are to land, where one of them is to land elsewhere by now."""
    changed = ground.copy()
    changed[leg] += inputs.ground_plane.slope_x * moved.real + inputs.ground_plane.slope_y * moved.imag
    if just_lifted:
        changed[leg] = max(changed[leg], np.broadcast_to(inputs.lowest_ground, ground.shape)[leg])
    return changed


def _land(now: GaitState, landed: list[int]) -> GaitState:
    """Put feet down that are where they are to land."""
    number, down, met = now.step_number.copy(), now.down.copy(), now.contact_phase.copy()
    number[landed] += 1
    down[landed], met[landed] = True, np.inf
    return now._replace(step_number=number, down=down, contact_phase=met)
