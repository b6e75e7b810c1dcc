"""Early ground contact during swing: the foot stops on the ground within its joints' acceleration limits."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.walk.ground_pose import body_posture
from tarsus.control.walk.state import EARLY_STOP_FRACTION, GaitState, chord_factor
from tarsus.control.walk.swing_trajectory import quintic, stopping_fraction
from tarsus.control.workspace.stance_geometry import SWING_HEIGHT, stance_geometry_of
from tarsus.gait.swing import horizontal_profile
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["relaxed_rate", "stop_on_contact"]


# Stops that are tried: their durations, in shortest ones; and how much of the way from where the foot would come to
# rest to its planned foothold it sinks.
_DURATIONS = np.array([1.0, 1.4, 2.0, 2.8, 4.0, 5.6, 8.0, 8.0, 8.0])[:, None]
_SINKS = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.35, 0.7])[:, None]
# Where joint accelerations are evaluated: closely at the beginning, where they are greatest, and along the whole stop.
_BEGINNING, _WHOLE = np.linspace(0.0, 0.04, 3), np.linspace(0.0, 1.0, 9)
# Fraction of the acceleration limits available to the stop; the rest is for the motion of the body.
_ACCELERATION_FRACTION = 0.9
# Increase of joint acceleration per swing height of height difference; increase allowed without slowing down.
_PER_RISE, _ALLOWED_INCREASE = 0.5, 1.1


def stop_on_contact(
    robot: Robot,
    state: GaitState,
    early: Bool[np.ndarray, "legs"],
    *,
    acceleration: Float[np.ndarray, "legs 3"],
    swing_rate: Float[np.ndarray, "legs"],
) -> GaitState:
    """Return the state in which feet with early contact stop as soon as their joints can.

    Feet that no stop is gentle enough for continue to their planned foothold.

    Parameters
    ----------
    robot : Robot
        A single robot.
    state : GaitState
        The state of the walk.
    early : array of bool, shape (legs,)
        Swinging feet with early contact that are not stopping yet.
    acceleration : array, shape (legs, 3)
        Acceleration limits of the joints [rad/s^2].
    swing_rate : array, shape (legs,)
        Rate of each foot's swing phase [1/s].
    """
    height, speed = _height_and_speed(state)
    # (stops, legs)
    duration = np.minimum(_DURATIONS * EARLY_STOP_FRACTION, np.maximum(1 - state.swing_phase, 1e-9))
    sink = np.minimum(state.ground_height - height - speed * duration / 3, 0.0) * _SINKS
    needed = _joint_acceleration(robot, state, (height, speed), duration, sink, swing_rate)
    works = (needed <= _ACCELERATION_FRACTION * acceleration).all(axis=-1) & early
    stops, first = works.any(axis=0), works.argmax(axis=0)[None]
    duration, sink = (np.take_along_axis(tried, first, axis=0)[0] for tried in (duration, sink))
    return state._replace(
        foothold=np.where(stops, state.foot + state.swing_velocity * duration / 3, state.foothold),
        contact_phase=np.where(stops, state.swing_phase, state.contact_phase),
        stop_phase=np.where(stops, duration, state.stop_phase),
        contact_height=np.where(stops, height, state.contact_height),
        contact_speed=np.where(stops, speed, state.contact_speed),
        ground_height=np.where(stops, height + speed * duration / 3 + sink, state.ground_height),
    )


def _height_and_speed(state: GaitState) -> tuple[Float[np.ndarray, "legs"], Float[np.ndarray, "legs"]]:
    """Return the feet's heights and their derivatives by the swing phase [m]."""
    swing_height, step = float(state.posture.value[SWING_HEIGHT]), 1e-4
    height = state.height(swing_height)
    later = state._replace(swing_phase=np.minimum(state.swing_phase + step, 1.0)).height(swing_height)
    return height, (later - height) / step


def _joint_acceleration(
    robot: Robot,
    state: GaitState,
    vertical: tuple[Float[np.ndarray, "legs"], Float[np.ndarray, "legs"]],
    duration: Float[np.ndarray, "n legs"],
    sink: Float[np.ndarray, "n legs"],
    swing_rate: Float[np.ndarray, "legs"],
) -> Float[np.ndarray, "stops legs 3"]:
    """Return the joints' greatest accelerations ``(stops, legs, 3)`` during each stop [rad/s^2]."""
    height, speed = vertical
    # (stops, samples, legs)
    duration, progress = duration[:, None], np.concatenate([_BEGINNING, _WHOLE])[:, None]
    time = progress * duration / swing_rate
    swing = (state.foot, state.swing_velocity, state.swing_acceleration)
    foot, _, _ = quintic(swing, state.foot + state.swing_velocity * duration / 3, duration, progress)
    offset = state.admittance_offset.value - state.elevation.value
    z = height + offset + speed * duration * stopping_fraction(progress) + sink[:, None] * horizontal_profile(progress)
    forward, left, turning = state.twist.value.tolist()
    travelled = complex(forward, left) * time * chord_factor(turning * time)
    in_heading = ((foot - state.origin) * np.exp(-1j * state.yaw) - travelled) * np.exp(-1j * turning * time)
    stance = stance_geometry_of(body_posture(state), state.foot)
    solution = stance.solve(robot, in_heading.real, in_heading.imag, z)
    angles, seconds = np.stack(solution[:3], axis=-1), (duration / swing_rate)[..., None]
    greatest = []
    for part, samples in ((angles[:, :3], _BEGINNING), (angles[:, 3:], _WHOLE)):
        step = (samples[1] - samples[0]) * seconds[:, 0]
        greatest.append(np.abs(np.diff(part, 2, axis=1)).max(axis=1) / step**2)
    return np.asarray(np.maximum(*greatest))


def relaxed_rate(state: GaitState, duty_factor: float) -> float:
    """Return the fastest rate of scaled time for swings shorter than planned, or between different heights.

    Parameters
    ----------
    state : GaitState
        The state of the walk.
    duty_factor : float
        Duty factor.
    """
    swing_height = max(float(state.posture.value[SWING_HEIGHT]), 1e-3)
    rise = np.abs(state.ground_height - state.start_height) / swing_height
    shortening = (1 - duty_factor) / state.swings(duty_factor)
    increase = np.where(state.down, 1.0, (1 + _PER_RISE * rise) * shortening**2)
    return math.sqrt(_ALLOWED_INCREASE / max(float(increase.max()), _ALLOWED_INCREASE))
