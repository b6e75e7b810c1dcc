"""Cycle time: the shortest cycles and the longest strokes that the joints' speed and acceleration allow."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.gait.cycle import cycle_feet
from tarsus.gait.gait import Gait
from tarsus.gait.stance.stance_geometry import StanceGeometry
from tarsus.gait.stance.velocity_limits import VelocityLimits
from tarsus.incremental import Incremental
from tarsus.robot.joint_limits import JointLimits
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["CycleTiming", "cycle_timing"]

# Fractions of the joints' limits that steady walking may use; the rest is for changes of the command.
_SPEED_FRACTION, _ACCELERATION_FRACTION = 0.97, 0.8
# Sizes of stroke that are examined, as fractions of the longest that the legs reach.
_SIZES = np.linspace(0.0, 1.0, 6)
# The least cycle time is the shortest one for a stroke of this size, times this margin.
_LEAST_SIZE, _CYCLE_TIME_MARGIN = 0.25, 1.15
# Twists that are examined: headings over a half turn, and one direction of turning. The steady cycle of the opposite
# twist is the same in reverse.
_STRAIGHT = 8
_TWISTS = np.array([(np.cos(a), np.sin(a), 0.0) for a in np.arange(_STRAIGHT) * np.pi / _STRAIGHT] + [(0.0, 0.0, 1.0)])
_STRAIGHT_AND_TURNING = slice(_STRAIGHT), slice(_STRAIGHT, None)
# Number of samples of a swing with a little of the stance on either side.
_SAMPLES = 33
# Rest footholds, at 0 and at 1, of two robots with one leg each [m].
_UNIT = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])[:, None, None]
# Cycle times among which that of the fastest walk is searched, as multiples of the least one.
_TRIED = np.geomspace(1.0, 4.0, 33)
# Number of foot positions in a block, solved at once (larger arrays take disproportionately long), and blocks per tick.
_BLOCK, _BLOCKS = 1900, 2


class CycleTiming(NamedTuple):
    """Duration of a gait cycle, and the strokes that it allows.

    Attributes
    ----------
    cycle_time : float
        Duration of a cycle [s], long enough for the joints to swing the feet over at least a quarter of the stroke that
        the legs reach.
    stroke, turning : float
        Longest strokes for which the joints are fast enough, walking straight and turning on the spot [m].
    """

    cycle_time: float
    stroke: float
    turning: float


def cycle_timing(
    robot: Robot,
    gait: Gait,
    stance: StanceGeometry,
    limits: VelocityLimits,
    joint_limits: JointLimits,
    *,
    cycle_time: float | None = None,
) -> Incremental[CycleTiming]:
    """Find the cycle time that the joints can follow.

    Parameters
    ----------
    robot, gait : Robot, Gait
        A single robot; order of the steps.
    stance, limits, joint_limits : StanceGeometry, VelocityLimits, JointLimits
        Body and rest footholds; polygons of the feet; limits of the joints' motion.
    cycle_time : float, optional
        Commanded duration of a cycle [s]; left out, that of the fastest walk. With shorter cycles the joints limit the
        strokes; with longer ones, the reach of the legs does.
    """
    # Motions of the body during one stance: none, and those of all sizes for each twist.
    farthest = limits.feasible_fractions(_TWISTS, stance_time=1.0, duty_factor=gait.duty_factor)[:, None] * _TWISTS
    stroke = np.abs(farthest[:, :1] + 1j * farthest[:, 1:2] + 1j * farthest[:, 2:] * limits.rest).max(-1)
    moves = np.concatenate([np.zeros((1, 3)), (_SIZES[1:, None, None] * farthest).reshape(-1, 3)])
    cycle = _SteadyCycle(gait, moves, stance.swing_height)
    size = max(_BLOCK // (robot.legs * len(cycle.shift)), 1)
    times = []
    for block, begin in enumerate(range(0, len(moves), size)):
        if block % _BLOCKS == 0:
            yield
        times.append(cycle.shortest_times(robot, stance, slice(begin, begin + size), joint_limits))
    # (sizes, twists): the shortest cycle for each size of the stroke of each twist.
    found = np.concatenate(times)
    shortest = np.vstack([np.full(len(_TWISTS), found[0]), found[1:].reshape(-1, len(_TWISTS))])
    return _timing(np.maximum.accumulate(shortest, axis=0), stroke, cycle_time)


def _timing(
    shortest: Float[np.ndarray, "sizes twists"], stroke: Float[np.ndarray, "twists"], cycle_time: float | None
) -> CycleTiming:
    """Return the timing, given the shortest cycles for each size of the stroke of each twist [s]."""
    # In shorter cycles the robot would hardly advance, as its strokes would be too short.
    least = _CYCLE_TIME_MARGIN * max(float(np.interp(_LEAST_SIZE, _SIZES, column)) for column in shortest.T)
    straight, turning = (partial(_longest, shortest[:, part], stroke[part]) for part in _STRAIGHT_AND_TURNING)
    if cycle_time is None:
        tried = least * _TRIED
        # Optimised for walking straight ahead, the most frequent command.
        ahead = np.interp(tried, shortest[:, 0], _SIZES) * stroke[0]
        cycle_time = float(tried[int((np.minimum(ahead, straight(tried)) / tried).argmax())])
    cycle_time = max(cycle_time, least)
    return CycleTiming(cycle_time, *(float(longest(np.array(cycle_time))) for longest in (straight, turning)))


def _longest(
    shortest: Float[np.ndarray, "sizes n"], stroke: Float[np.ndarray, "n"], cycle_time: Float[np.ndarray, "*batch"]
) -> Float[np.ndarray, "*batch"]:
    """Return the stroke that is feasible for every twist for which the joints, not the legs' reach, are the limit.

    If there is no such twist, it is the longest of the strokes that the legs reach, each extended by the ratio of the
    cycle time to the shortest one for it.
    """
    sizes = np.stack([np.interp(cycle_time, column, _SIZES) for column in shortest.T], axis=-1)
    bound = np.where(sizes < 1, sizes * stroke, np.inf).min(-1)
    spare = np.maximum(cycle_time[..., None] / shortest[-1], 1.0)
    return np.asarray(np.where(np.isfinite(bound), bound, (spare * stroke).max(-1)))


class _SteadyCycle:
    """Steady gait cycles in one stance, and the joint speeds and accelerations that they need.

    The cycle is the same for all legs but for its phase. It is sampled over the swing and a little of the stance on
    either side; with a duty factor below 1/2, over the whole cycle, since the foot is then fastest in stance. In the
    heading frame, the foot at a sample and move is at its rest foothold times `factor` plus `shift`, x + iy [m].
    """

    def __init__(self, gait: Gait, moves: Float[np.ndarray, "n 3"], swing_height: float) -> None:
        """Sample cycles with these moves of the body during one stance: forward [m], left [m], yaw [rad]."""
        begin = gait.duty_factor - 0.02 if gait.duty_factor >= 0.5 else -0.02
        self.phases = np.linspace(begin, 1.02, round(_SAMPLES * (1.02 - begin) / (1.04 - gait.duty_factor)))
        # As complex numbers, positions are linear in the rest foothold: 0 and 1 determine `shift` and `factor`.
        feet, _ = cycle_feet(
            Gait(gait.duty_factor, (0.0,)), _UNIT, moves, swing_height=np.array(swing_height), phases=self.phases
        )
        # With this order of the axes in memory, that in which legs are solved, solving is a quarter faster.
        at_0, at_1 = np.ascontiguousarray((feet[..., 0, 0] + 1j * feet[..., 0, 1]).swapaxes(1, 2))
        self.height: Float[np.ndarray, "m 1"] = feet[0, 0, :, :, 2]
        self.shift, self.factor = at_0, at_1 - at_0

    def shortest_times(
        self, robot: Robot, stance: StanceGeometry, part: slice, joint_limits: JointLimits
    ) -> Float[np.ndarray, "n"]:
        """Return the shortest cycle for each move of a part of all moves [s]."""
        # Shape (legs, samples, moves); `angles` have the joints as an additional first axis.
        places = self.shift[:, part] + self.factor[:, part] * stance.rest[:, None, None]
        solution = stance.solve(robot.geometry.with_axes(2), places.real, places.imag, self.height)
        angles = np.stack(solution[:3])
        step = self.phases[1] - self.phases[0]
        rate = np.diff(angles, axis=2) / step
        change = np.diff(rate, axis=2) / step
        speed, acceleration = (limit.T[..., None] for limit in joint_limits)
        by_speed = np.abs(rate).max(axis=2) / (_SPEED_FRACTION * speed)
        by_acceleration = np.sqrt(np.abs(change).max(axis=2) / (_ACCELERATION_FRACTION * acceleration))
        return np.asarray(np.maximum(by_speed, by_acceleration).max(axis=(0, 1)))
