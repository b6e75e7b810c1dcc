"""The stepper: the gait state after a time step, a pure function of the gait state and the step inputs."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.filters import CriticallyDamped
from tarsus.control.walk.foothold import FootholdPredictor, final_footholds
from tarsus.control.walk.state import POSITION_TOLERANCE, ROUNDING, GaitState, StepInputs, integrate_twist
from tarsus.gait.stance.stance_geometry import SWING_HEIGHT
from tarsus.gait.swing_trajectory import quintic

if TYPE_CHECKING:
    from jaxtyping import Complex

__all__ = ["TARGET_FREEZE", "advance", "land", "stance_tolerance"]

TARGET_FREEZE = 0.6
"""Fraction of its travel, by swing phase, after which a foothold is fixed: the rest suffices to reach it smoothly."""

# Greatest fraction of its duration by which the swing of a foot that lifts off late is shortened.
_LATEST = 0.5
# Bandwidths of the admittance offsets and of the body shift's coefficients [rad/s].
_ADMITTANCE_BANDWIDTH, _SHIFT_BANDWIDTH = 20.0, 5.0
# A foot that feels the ground counts as at its rest foothold within the first distance, and once there, within the
# second [m].
_FELT_TOLERANCES = (0.015, 0.03)
# Fraction of its travel, by swing phase, in which a foot that feels the ground swings out.
_BOWS = 0.5
# A stopping robot whose twist is below this has stopped [m/s, rad/s].
_NO_SPEED = 3e-7


def advance(state: GaitState, inputs: StepInputs, dt: float) -> GaitState:
    """Return the gait state after a time.

    Parameters
    ----------
    state, inputs, dt : GaitState, StepInputs, float
        The gait state; what is constant for the time; the time [s].
    """
    twist, travel = state.twist.step_with_integral(inputs.twist, dt, bandwidth=inputs.bandwidth)
    # The body pose follows its target even while the walk waits.
    posture = state.posture.settling_step(inputs.posture, dt, bandwidth=inputs.posture_bandwidth)
    offset = state.admittance_offset.settling_step(inputs.admittance_offset, dt, bandwidth=_ADMITTANCE_BANDWIDTH)
    shift = state.shift.settling_step(inputs.shift, dt, bandwidth=_SHIFT_BANDWIDTH)
    if inputs.felt is not None:
        dt, travel = inputs.felt.pace * dt, [inputs.felt.pace * way for way in travel]
    origin, yaw = integrate_twist(state.origin, state.yaw, travel)
    stopping = not any(inputs.twist.tolist())
    if stopping and max(map(abs, twist.value.tolist())) < _NO_SPEED:
        twist = CriticallyDamped.still(np.zeros(3))
    elapsed = inputs.frequency * dt
    rhythm, cycles, beats = state.rhythm, 0.0, 0.0
    if any((*state.posture.value[SWING_HEIGHT + 1 :].tolist(), *inputs.posture[SWING_HEIGHT + 1 :].tolist())):
        # The body sways, or is about to.
        rates = inputs.frequency * np.array([1.0, inputs.gait.beats])
        rhythm, (cycles, beats) = state.rhythm.step_with_integral(rates, dt, bandwidth=inputs.bandwidth)
    clock = state.clock + elapsed
    after = state._replace(
        clock=clock,
        origin=origin,
        yaw=yaw,
        twist=twist,
        posture=posture,
        rhythm=rhythm,
        admittance_offset=offset,
        shift=shift,
        cycles=state.cycles + cycles,
        beats=state.beats + beats,
    )
    duty_factor = inputs.gait.duty_factor
    step_of_leg = zip(inputs.gait.offsets, state.step_number.tolist(), strict=True)
    since_lift = [clock - (offset + duty_factor + number) for offset, number in step_of_leg]
    down = state.down.tolist()
    steps = inputs.frequency > 0.0 and not inputs.hold_feet
    due = [on and steps and since > ROUNDING for on, since in zip(down, since_lift, strict=True)]
    if all(down) and not any(due):
        return after
    final = final_footholds(after, rest=inputs.rest, bandwidth=inputs.bandwidth) if stopping else None
    if any(due):
        after = _lift(after, inputs, due, [since - elapsed for since in since_lift], final)
    return _swing(after, inputs, since_lift, final)


def _lift(
    state: GaitState, inputs: StepInputs, due: list[bool], late: list[float], final: Complex[np.ndarray, "legs"] | None
) -> GaitState:
    """Lift the feet that are due; those that may not, or need not, miss this step.

    `late` is how long each foot had been due at the start of the tick [cycles]; `final` are the footholds at which a
    stopping robot will stand, None where it is not stopping or still too fast.
    """
    lifts = np.array(due)
    lifts[list(inputs.excluded)] = False
    if final is not None:
        scale = 1.0 if inputs.felt is None else inputs.felt.scale
        away = np.abs(state.foot - final) > stance_tolerance(state, scale=scale)
        away[list(inputs.unstepped)] = True
        # A leg that returns to the gait is above its foothold at best, and has to step.
        above = state.ground_height > POSITION_TOLERANCE if inputs.felt is None else ~np.array(inputs.felt.steps)
        lifts = lifts & (away | above)
    missed = due & ~lifts
    # The admittance offset becomes part of the height at which the swing starts.
    offset = state.admittance_offset
    start, left = state.ground_height + offset.value, np.where(lifts, 0.0, offset.value)
    # A foot that has not stood since its last swing starts a new rise.
    felt = [foot._replace(top=math.nan) if on else foot for foot, on in zip(state.felt, lifts.tolist(), strict=False)]
    return state._replace(
        step_number=state.step_number + missed,
        felt=felt,
        down=state.down & ~lifts,
        swing_phase=np.where(lifts, 0.0, state.swing_phase),
        start_height=np.where(lifts, start, state.start_height),
        ground_height=np.where(lifts, start if state.felt else 0.0, state.ground_height),
        admittance_offset=offset._replace(value=left),
        # Feet that lift off late swing for a shorter time.
        lift_delay=np.where(due, np.clip(late, 0.0, _LATEST * (1 - inputs.gait.duty_factor)), state.lift_delay),
    )


def stance_tolerance(state: GaitState, *, scale: float, stands: bool = False) -> float:
    """Return the distance within which a foot counts as at its rest foothold [m].

    Parameters
    ----------
    state, scale : GaitState, float
        The gait state; factor by which lengths are reduced on short legs, 0 to 1.
    stands : bool
        Whether the foot has been at it before.
    """
    return scale * _FELT_TOLERANCES[stands] if state.felt else POSITION_TOLERANCE


def _swing(
    state: GaitState, inputs: StepInputs, since_lift: list[float], final: Complex[np.ndarray, "legs"] | None
) -> GaitState:
    """Move the swinging feet, and put those down whose swing is over."""
    duty_factor = inputs.gait.duty_factor
    swing, stance = 1 - duty_factor, duty_factor / inputs.frequency
    predictor = FootholdPredictor(state, inputs)
    phases, feet, targets = state.swing_phase.copy(), state.foot.copy(), state.foothold.copy()
    velocities, accelerations = state.swing_velocity.copy(), state.swing_acceleration.copy()
    travel, landed = 1.0 if inputs.felt is None else inputs.felt.travel, []
    if inputs.felt is not None:
        speed = complex(*state.twist.value[:2].tolist())
        # Feet that make up for lost way travel farther in a stance.
        stance *= 1 + (inputs.felt.drift * speed.conjugate()).real / max(abs(speed) ** 2, 1e-6)
    for leg in [leg for leg, on in enumerate(state.down.tolist()) if not on]:
        late, since = float(state.lift_delay[leg]), since_lift[leg]
        phase, target = float(phases[leg]), complex(targets[leg])
        reached = min(max((since - late) / (swing - late), 0.0), 1.0)
        end, drawn_back = travel, None
        if state.felt and (drawn_back := state.felt[leg].drawn_back) is not None:
            over = phase >= state.felt[leg].top_phase
            end = 1.0 if over else state.felt[leg].top_phase
            target = target if over else drawn_back
        elif phase <= TARGET_FREEZE * travel:
            until = (swing - since) / inputs.frequency
            target = predictor.foothold(leg, until, until + stance / 2) if final is None else complex(final[leg])
            targets[leg] = target
        if state.felt and drawn_back is None and phase < _BOWS * travel:
            # A path is halfway at half of its time: there the foot is aside by half as much as its target, by the bow.
            target += 2 * state.felt[leg].bow
        left, path = end - phase, (target, 0j, 0j)
        if since >= swing - ROUNDING:
            landed.append(leg)
            reached = 0.0
        elif left > 0:
            before = (complex(feet[leg]), complex(velocities[leg]), complex(accelerations[leg]))
            path = quintic(before, target, left, min((reached - phase) / left, 1.0))
        phases[leg] = reached
        feet[leg], velocities[leg], accelerations[leg] = path
    after = state._replace(
        swing_phase=phases, foot=feet, foothold=targets, swing_velocity=velocities, swing_acceleration=accelerations
    )
    return land(after, landed) if landed else after


def land(state: GaitState, landed: list[int]) -> GaitState:
    """Return the state with the feet of some legs put down where they are."""
    number, down, phase = state.step_number.copy(), state.down.copy(), state.swing_phase.copy()
    number[landed] += 1
    down[landed], phase[landed] = True, 0.0
    return state._replace(step_number=number, down=down, swing_phase=phase)
