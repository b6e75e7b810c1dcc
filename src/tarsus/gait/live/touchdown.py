"""Feet that meet ground before they were to: how gently they come to rest on it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.gait.live.moment import GIVE, Moment, stopped_part, turned
from tarsus.gait.live.posture import LIFT, stand_of, swayed
from tarsus.gait.live.stepping import quintic
from tarsus.robot.robot import Robot

__all__ = ["gentle_give", "meet_ground", "unhurried"]

Floats = np.ndarray[Any, Any]

# What is tried, in the least share of the swing that feet take to stop; and what of the joints' acceleration that may
# take: the rest is for the body, whose own time speeds up or slows down meanwhile.
_LONGER = np.array([1.0, 1.4, 2.0, 2.8, 4.0])
_TAKEN = 0.8
# How much harder it is for the joints to swing to other ground, per lift that it is higher or lower; and how much harder
# than planned a swing may be.
_BY_RISE, _HARDER = 0.5, 1.1
# At how many moments of a stop the joints are looked at.
_MOMENTS = 9


def gentle_give(robot: Robot, now: Moment, met: Floats, *, acceleration: Floats, swing_rate: Floats) -> Floats:
    """Return within which share of the swing each foot can stop that has met the ground: the least the joints allow.

    Parameters
    ----------
    robot : Robot
        A single robot.
    now : Moment
        The moment.
    met : array of bool, shape (legs,)
        Which feet have met ground.
    acceleration : array, shape (legs, 3)
        Greatest of each joint [rad/s^2].
    swing_rate : array, shape (legs,)
        What share of its swing each foot goes in a second [1/s].

    Returns
    -------
    array, shape (legs,)
        Shares; 0 for feet that are too fast to stop before the end of their swing, where they come to rest anyway.
    """
    posture = swayed(now.posture.value, now.cycles, now.beats)
    stand, lift = stand_of(posture, now.foot), float(posture[LIFT])
    give = np.minimum(_LONGER[:, None] * GIVE, np.maximum(1 - now.share, 1e-9))
    # (tried, moments, legs)
    give, part = give[:, None], np.linspace(0.0, 1.0, _MOMENTS)[:, None]
    time = part * give / swing_rate
    height, speed = _height_and_speed(now, lift)
    z = height + now.give_way.value - now.elevation.value + speed * give * stopped_part(part)
    foot, _, _ = quintic((now.foot, now.pace, now.bend), _target(now, give), give, part)
    forward, left_on, turning = now.twist.value.tolist()
    gone_on = complex(forward, left_on) * time * turned(turning * time)
    seen = ((foot - now.origin) * np.exp(-1j * now.yaw) - gone_on) * np.exp(-1j * turning * time)
    s = stand.solve(robot, seen.real, seen.imag, z)
    angles = np.stack([s.coxa, s.femur, s.tibia], axis=-1)
    step = np.diff(time[:, :2], axis=1)[..., None]
    bend = np.abs(np.diff(angles, 2, axis=1) / (step * step) / acceleration).max(axis=(1, 3))
    works = (bend <= _TAKEN) & met
    first = np.take_along_axis(give[:, 0], works.argmax(axis=0)[None], axis=0)[0]
    return np.where(works.any(axis=0), first, 0.0)


def meet_ground(now: Moment, met: Floats, lift: float, give: Floats) -> Moment:
    """Return the moment in which feet have met the ground before they were to: they come to rest where they are.

    Parameters
    ----------
    now : Moment
        The moment.
    met : array of bool, shape (legs,)
        Which feet; in the air, and not met already.
    lift : float
        How high a swinging foot rises [m].
    give : array, shape (legs,)
        Within which share of the swing they come to rest.
    """
    height, speed = _height_and_speed(now, lift)
    return now._replace(
        target=np.where(met, _target(now, give), now.target),
        met=np.where(met, now.share, now.met),
        give=np.where(met, give, now.give),
        met_height=np.where(met, height, now.met_height),
        met_speed=np.where(met, speed, now.met_speed),
        ground=np.where(met, height + speed * give * stopped_part(1.0), now.ground),
    )


def unhurried(now: Moment, swing: float) -> float:
    """Return how fast the walk's own time may run for swings that are shorter than planned, or end higher or lower.

    Parameters
    ----------
    now : Moment
        The moment.
    swing : float
        How long a swing is planned to take [cycles].
    """
    lift = max(float(now.posture.value[LIFT]), 1e-3)
    rise = np.abs(now.ground - now.start_height) / lift
    harder = np.where(now.down, 1.0, (1 + _BY_RISE * rise) * (swing / (swing - now.late)) ** 2)
    return math.sqrt(_HARDER / max(float(harder.max()), _HARDER))


def _target(now: Moment, give: Floats) -> Floats:
    """Return where feet come to rest that stop within a share of their swing."""
    return np.asarray(now.foot + now.pace * give * stopped_part(1.0))


def _height_and_speed(now: Moment, lift: float) -> tuple[Floats, Floats]:
    """Return the feet's heights, and how these change with the share of the swing [m]."""
    height, step = now.height(lift), 1e-4
    later = now._replace(share=np.minimum(now.share + step, 1.0)).height(lift)
    return height, (later - height) / step
