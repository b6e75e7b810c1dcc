"""How fast the legs may step: what the joints' speed and acceleration allow."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tarsus.control.incremental import Incremental
from tarsus.control.workspace.stance_geometry import StanceGeometry
from tarsus.control.workspace.velocity_limits import VelocityLimits
from tarsus.gait.gait import Gait
from tarsus.gait.swing import ground_share, height_share
from tarsus.robot.robot import Robot

__all__ = ["CycleTiming", "SteadyCycle", "cycle_timing"]

Floats = np.ndarray[Any, Any]

# Shares of the joints' speed and acceleration that steady walking may take: the rest is for changing one's mind.
_SPEED_SHARE, _ACCELERATION_SHARE = 0.97, 0.8
_SIZES = np.linspace(0.0, 1.0, 6)
_LEAST_SIZE, _UNHURRIED = 0.25, 1.15
# Half of all headings, and one way round: the other way, a steady cycle is the same one backwards.
_STRAIGHT = 8
_TWISTS = np.array([(np.cos(a), np.sin(a), 0.0) for a in np.arange(_STRAIGHT) * np.pi / _STRAIGHT] + [(0.0, 0.0, 1.0)])
_MOMENTS = 33
# Cycles that are tried for the one that gets farthest, in least ones.
_TRIED = np.geomspace(1.0, 4.0, 33)
# How many feet at how many moments are worked out at once: larger arrays cost more than their share of time.
_BLOCK = 1900


class CycleTiming(NamedTuple):
    """How fast the legs step, and how far.

    Attributes
    ----------
    cycle_time : float
        Duration of a cycle [s].
    stroke, turning : float
        The longest strokes, straight on and on the spot, for which the joints are fast enough [m].
    shortest_cycle_time : float
        The shortest cycle in which the joints can lift the feet and carry them on by a quarter of what the legs
        allow [s].
    """

    cycle_time: float
    stroke: float
    turning: float
    shortest_cycle_time: float


def cycle_timing(
    robot: Robot,
    gait: Gait,
    stand: StanceGeometry,
    limits: VelocityLimits,
    *,
    speed: Floats,
    acceleration: Floats,
    cycle_time: float | None = None,
) -> Incremental[CycleTiming]:
    """Work out how long a cycle must take for the joints to keep up, in parts.

    Parameters
    ----------
    robot, gait, stand
        What walks, how, and how it stands.
    limits : VelocityLimits
        How far the feet may go.
    speed, acceleration : array, shape (legs, 3)
        Greatest of each joint [rad/s], [rad/s^2].
    cycle_time : float, optional
        Wished duration of a cycle [s]; left out, that which gets the robot farthest: in a shorter one the joints
        allow shorter strokes only, in a longer one the legs no longer ones.
    """
    # What the body moves in one stance, as far as the legs allow, and in parts of that; not at all, first of all.
    farthest = limits.feasible_fractions(_TWISTS, stance_time=1.0, duty_factor=gait.duty_factor)[:, None] * _TWISTS
    stroke = np.abs(farthest[:, :1] + 1j * farthest[:, 1:2] + 1j * farthest[:, 2:] * limits.rest).max(-1)
    moves = np.concatenate([np.zeros((1, 3)), (_SIZES[1:, None, None] * farthest).reshape(-1, 3)])
    cycle = SteadyCycle(gait, moves, stand.swing_height)
    block = max(_BLOCK // (robot.legs * len(cycle.shift)), 1)
    times = []
    for first in range(0, len(moves), block):
        times.append(cycle.shortest_times(robot, stand, slice(first, first + block), speed, acceleration))
        # The first comes after some other work, and the last before some.
        if len(times) % 3 == 1:
            yield
    # (sizes, twists): the shortest cycle for each size of each stroke.
    shortest = np.empty((len(_SIZES), len(_TWISTS)))
    shortest[0], shortest[1:] = times[0][0], np.concatenate(times)[1:].reshape(len(_SIZES) - 1, -1)
    shortest = np.maximum.accumulate(shortest, axis=0)
    # The least in which the joints allow a good part of the stroke: in less, the robot would step on the spot.
    least = _UNHURRIED * float(np.array([np.interp(_LEAST_SIZE, _SIZES, column) for column in shortest.T]).max())
    if cycle_time is None:
        tried = least * _TRIED
        straight = _sizes(shortest[:, :_STRAIGHT], tried)
        # Straight on, as robots mostly walk.
        far = np.minimum(
            straight[:, 0] * stroke[0], _cap(straight, tried[:, None] / shortest[-1, :_STRAIGHT], stroke[:_STRAIGHT])
        )
        cycle_time = float(tried[int((far / tried).argmax())])
    cycle_time = max(cycle_time, least)
    sizes = _sizes(shortest, cycle_time)
    spare = cycle_time / shortest[-1]
    straight_on, on_the_spot = (
        float(_cap(sizes[part], spare[part], stroke[part])) for part in (slice(_STRAIGHT), slice(_STRAIGHT, None))
    )
    return CycleTiming(cycle_time, straight_on, on_the_spot, least)


def _cap(sizes: Floats, spare: Floats, stroke: Floats) -> Floats:
    """Return the stroke ``(...)`` that works in every direction in which the joints, not the legs, set the bound.

    Where they do in none, they allow so many times the legs' strokes as their cycles are shorter.
    """
    bound = np.where(sizes < 1, sizes * stroke, np.inf).min(-1)
    return np.asarray(np.where(np.isfinite(bound), bound, (np.maximum(spare, 1.0) * stroke).max(-1)))


def _sizes(shortest: Floats, cycle_times: Floats | float) -> Floats:
    """Return for each twist, last axis, which share of the longest stroke cycle times allow."""
    return np.stack([np.interp(cycle_times, column, _SIZES) for column in shortest.T], axis=-1)


class SteadyCycle:
    """Steady cycles of a robot that stands in some way, and what they ask of the joints.

    Every leg goes the same way through its own cycle: a swing, and a little of the stance on either side. Where the
    stance is the shorter part, the foot is fastest in it.

    Parameters
    ----------
    gait : Gait
        How long a foot is on the ground.
    moves : array, shape (n, 3)
        What the body moves in one stance: forward [m], left [m], yaw [rad].
    swing_height : float
        Lift of the swinging foot [m].

    Attributes
    ----------
    phases : array, shape (m,)
        Moments of the cycle, in cycles.
    height : array, shape (m, 1)
        Of the foot [m].
    factor, shift : complex array, shape (m, n)
        Where a foot is in the heading frame: its rest foothold times the one, and the other [m].
    """

    def __init__(self, gait: Gait, moves: Floats, swing_height: float) -> None:
        begin = gait.duty_factor - 0.02 if gait.duty_factor >= 0.5 else -0.02
        self.phases = np.linspace(begin, 1.02, round(_MOMENTS * (1.02 - begin) / (1.04 - gait.duty_factor)))
        _, phase, contacts = Gait(gait.duty_factor, (0.0,)).phase(self.phases)
        share = np.where(contacts, 0.0, (phase - gait.duty_factor) / (1 - gait.duty_factor))
        self.height = swing_height * height_share(share)
        # What `cycle_feet` works out, with (moments, moves): a foot's place is linear in its rest foothold, if both
        # are complex numbers.
        along = ground_share(share)
        there, turned_there = _moved(moves, 1 / gait.duty_factor)
        since_middle = phase / gait.duty_factor - 0.5
        here, turned = _moved(moves, since_middle)
        self.factor = (1 + along * (turned_there - 1)) / turned
        self.shift = (along * there - here) / turned

    def shortest_times(
        self, robot: Robot, stand: StanceGeometry, part: slice, speed: Floats, acceleration: Floats
    ) -> Floats:
        """Return the shortest cycle for each of a part of the moves.

        Parameters
        ----------
        robot : Robot
            A single robot.
        stand : Stand
            How it stands.
        part : slice
            Which of the moves.
        speed, acceleration : array, shape (legs, 3)
            Greatest of each joint [rad/s], [rad/s^2].

        Returns
        -------
        array, shape (n,)
            Durations [s].
        """
        # (moments, moves, legs), and the joints between the first two.
        places = self.shift[:, part, None] + self.factor[:, part, None] * stand.rest
        solution = stand.solve(robot, places.real, places.imag, self.height[..., None])
        angles = np.stack(solution[:3], axis=1)
        step = self.phases[1] - self.phases[0]
        rate = np.diff(angles, axis=0) / step
        change = np.diff(rate, axis=0) / step
        by_speed = np.abs(rate).max(axis=0) / (_SPEED_SHARE * speed.T[:, None])
        by_acceleration = np.sqrt(np.abs(change).max(axis=0) / (_ACCELERATION_SHARE * acceleration.T[:, None]))
        return np.asarray(np.maximum(by_speed, by_acceleration).max(axis=(0, 2)))


def _moved(moves: Floats, share: Floats | float) -> tuple[Floats, Floats]:
    """Return where the body is after a share of its moves, and by which factor it has turned, as complex numbers."""
    half = np.asarray(moves[:, 2] * share / 2)
    turned = np.exp(1j * half)
    # sin(x) / x; where the sine is of no use, x is so small that it is 1 to rounding.
    tiny = np.abs(half) < 1e-8
    chord = np.where(tiny, 1.0, turned.imag / np.where(tiny, 1.0, half))
    return (moves[:, 0] + 1j * moves[:, 1]) * (share * chord) * turned, turned * turned
