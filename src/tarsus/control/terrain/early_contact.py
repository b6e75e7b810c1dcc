"""Feet that meet ground before they were to: how gently they come to rest on it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.control.walk.state import EARLY_STOP_FRACTION, GaitState, chord_factor
from tarsus.control.walk.swing_trajectory import quintic, stopping_fraction
from tarsus.control.workspace.stance_geometry import SWING_HEIGHT, stance_geometry_of, with_sway
from tarsus.gait.swing import ground_share
from tarsus.robot.robot import Robot

__all__ = ["relaxed_rate", "stop_on_contact"]

Floats = np.ndarray[Any, Any]

# What is tried: in how many times the least share of the swing feet stop; at its end, how much of the way from where
# that would be to where they were bound for they sink.
_LONGER = np.array([1.0, 1.4, 2.0, 2.8, 4.0, 5.6, 8.0, 8.0, 8.0])[:, None]
_DEEPER = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.35, 0.7])[:, None]
# At which parts of a stop the joints are looked at: right at its beginning, where it is hardest, and all along it.
_BEGINNING, _ALONG = np.linspace(0.0, 0.04, 3), np.linspace(0.0, 1.0, 9)
# What of their acceleration it may take: the rest is for the body, whose own time speeds up or slows down.
_TAKEN = 0.9
# How much harder it is for the joints to swing to other ground, per lift that it is higher or lower; and how much
# harder than planned a swing may be.
_BY_RISE, _HARDER = 0.5, 1.1


def stop_on_contact(
    robot: Robot, now: GaitState, met: Floats, *, acceleration: Floats, swing_rate: Floats
) -> GaitState:
    """Return the moment in which feet have met the ground before they were to: they stop as soon as their joints can.

    Those that are too fast for any stop go on to where they were bound for.

    Parameters
    ----------
    robot : Robot
        A single robot.
    now : Moment
        The moment.
    met : array of bool, shape (legs,)
        Which feet; in the air, and not met already.
    acceleration : array, shape (legs, 3)
        Greatest of each joint [rad/s^2].
    swing_rate : array, shape (legs,)
        What share of its swing each foot goes in a second [1/s].
    """
    height, speed = _height_and_speed(now)
    # (tried, legs)
    give = np.minimum(_LONGER * EARLY_STOP_FRACTION, np.maximum(1 - now.swing_phase, 1e-9))
    sinks = np.minimum(now.ground_height - height - speed * give / 3, 0.0) * _DEEPER
    bend = _bend(robot, now, (height, speed), give, sinks, swing_rate)
    works = (bend <= _TAKEN * acceleration).all(axis=-1) & met
    stops, first = works.any(axis=0), works.argmax(axis=0)[None]
    give, sinks = (np.take_along_axis(tried, first, axis=0)[0] for tried in (give, sinks))
    return now._replace(
        foothold=np.where(stops, now.foot + now.swing_velocity * give / 3, now.foothold),
        contact_phase=np.where(stops, now.swing_phase, now.contact_phase),
        stop_phase=np.where(stops, give, now.stop_phase),
        contact_height=np.where(stops, height, now.contact_height),
        contact_speed=np.where(stops, speed, now.contact_speed),
        ground_height=np.where(stops, height + speed * give / 3 + sinks, now.ground_height),
    )


def _height_and_speed(now: GaitState) -> tuple[Floats, Floats]:
    """Return the feet's heights, and how these change with the share of the swing [m]."""
    swing_height, step = float(now.posture.value[SWING_HEIGHT]), 1e-4
    height = now.height(swing_height)
    later = now._replace(swing_phase=np.minimum(now.swing_phase + step, 1.0)).height(swing_height)
    return height, (later - height) / step


def _bend(
    robot: Robot, now: GaitState, falling: tuple[Floats, Floats], give: Floats, sinks: Floats, swing_rate: Floats
) -> Floats:
    """Return the joints' greatest acceleration ``(tried, legs, 3)`` on the ways that feet stop on [rad/s^2]."""
    height, speed = falling
    # (tried, moments, legs)
    give, part = give[:, None], np.concatenate([_BEGINNING, _ALONG])[:, None]
    time = part * give / swing_rate
    foot, _, _ = quintic(
        (now.foot, now.swing_velocity, now.swing_acceleration), now.foot + now.swing_velocity * give / 3, give, part
    )
    over = now.admittance_offset.value - now.elevation.value
    z = height + over + speed * give * stopping_fraction(part) + sinks[:, None] * ground_share(part)
    forward, left, turning = now.twist.value.tolist()
    excluded = complex(forward, left) * time * chord_factor(turning * time)
    seen = ((foot - now.origin) * np.exp(-1j * now.yaw) - excluded) * np.exp(-1j * turning * time)
    stand = stance_geometry_of(with_sway(now.posture.value, now.cycles, now.beats), now.foot)
    solution = stand.solve(robot, seen.real, seen.imag, z)
    angles, lasts = np.stack(solution[:3], axis=-1), (give / swing_rate)[..., None]
    bends = []
    for some, parts in ((angles[:, :3], _BEGINNING), (angles[:, 3:], _ALONG)):
        bends.append(np.abs(np.diff(some, 2, axis=1)).max(axis=1) / ((parts[1] - parts[0]) * lasts[:, 0]) ** 2)
    return np.asarray(np.maximum(*bends))


def relaxed_rate(now: GaitState, duty_factor: float) -> float:
    """Return how fast the walk's own time may run for swings that are shorter than planned, or end higher or lower.

    Parameters
    ----------
    now : Moment
        The moment.
    duty_factor : float
        Duty factor.
    """
    swing_height = max(float(now.posture.value[SWING_HEIGHT]), 1e-3)
    rise = np.abs(now.ground_height - now.start_height) / swing_height
    harder = np.where(now.down, 1.0, (1 + _BY_RISE * rise) * ((1 - duty_factor) / now.swings(duty_factor)) ** 2)
    return math.sqrt(_HARDER / max(float(harder.max()), _HARDER))
