"""What a simulated robot did, in numbers: distance, slip, tilt, torques, energy, falls and stalls."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np

from tarsus.kinematics.mass import STANDARD_GRAVITY, total_mass
from tarsus.representation import represented
from tarsus.robot.robot import JOINTS
from tarsus.simulation.truth.trace import Trace

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["FALLEN", "Outcome"]

FALLEN = math.radians(45)
"""A robot whose upward axis is further than this from the commanded one has fallen [rad]."""

# A body may touch the ground this long before and after it is commanded to rest on it [s].
_BELLY_MARGIN = 1.0
# A servo that is saturated for this long counts as stalled [s].
_STALL = 0.5
# A robot is stuck if it covers less than this fraction of a commanded distance that is at least this long [m].
_STUCK, _WAY = 0.5, 0.05


@represented()
@dataclass(frozen=True, eq=False, kw_only=True)
class Outcome:
    """What a simulated robot did. Positions are relative to where it stood at the start.

    Attributes
    ----------
    duration : float
        Duration [s].
    commanded_end, end : tuple of float
        Where the body ended, commanded and in physics: x, y [m], total yaw [rad].
    deviation : float
        Greatest horizontal distance of the body from where it was commanded to be [m].
    tilt : float
        Greatest angle between the body's upward axis and the commanded one [rad].
    sag : float
        Greatest height by which the body is lower than commanded, beyond that at the start [m].
    slip : float
        Distance that the contact points slide over the ground, mean of all feet [m].
    peak_torque, rms_torque : array, shape (3,)
        Peak and root mean square torque of coxa, femur and tibia, of the leg where it is greatest [N m].
    saturated : array, shape (3,)
        Fraction of the time in which the servos of coxa, femur and tibia give all the torque that they can, of the leg
        where it is greatest.
    energy : float
        Positive mechanical work of all servos [J].
    cost_of_transport : float
        Energy divided by weight and distance between start and end; infinite where these coincide.
    fell_at : float or None
        When the robot fell [s]: its body touched the ground without being commanded to rest on it, or its upward
        axis was more than 45 deg from the commanded one. None if it did not fall.
    stalls : tuple of str
        What did not move as commanded, a line each.
    """

    duration: float
    commanded_end: tuple[float, float, float]
    end: tuple[float, float, float]
    deviation: float
    tilt: float
    sag: float
    slip: float
    peak_torque: Float[np.ndarray, "3"]
    rms_torque: Float[np.ndarray, "3"]
    saturated: Float[np.ndarray, "3"]
    energy: float
    cost_of_transport: float
    fell_at: float | None
    stalls: tuple[str, ...]

    @classmethod
    def of(cls, trace: Trace) -> Self:
        """Return the outcome of a trace.

        Parameters
        ----------
        trace : Trace
            The trace.
        """
        time, commanded, path = trace.time, _relative(trace, commanded=True), _relative(trace, commanded=False)
        step = np.diff(time, prepend=time[0])
        up, wanted = trace.body.rotation[:, :, 2], trace.commanded_body.rotation[:, :, 2]
        tilt = np.arccos(np.clip(np.sum(up * wanted, axis=-1), -1.0, 1.0))
        rms = np.sqrt((trace.torques**2 * step[:, None, None]).sum(0) / time[-1])
        work = (np.maximum(trace.torques * trace.speeds, 0.0).sum((1, 2)) * step).sum()
        distance = float(np.hypot(*path[-1, :2]))
        weight = float(total_mass(trace.robot)) * STANDARD_GRAVITY
        return cls(
            duration=float(time[-1]),
            commanded_end=_end(commanded),
            end=_end(path),
            deviation=float(np.hypot(*(path - commanded)[:, :2].T).max()),
            tilt=float(tilt.max()),
            sag=max(float((commanded - path)[:, 2].max()), 0.0),
            slip=float((trace.slip_speeds * step[:, None]).sum(0).mean()),
            peak_torque=np.abs(trace.torques).max((0, 1)),
            rms_torque=rms.max(0),
            saturated=trace.saturated.mean(0).max(0),
            energy=float(work),
            cost_of_transport=float(work) / (weight * distance) if distance > 0 else math.inf,
            fell_at=_fall(trace, tilt),
            stalls=(*_stalled(trace), *_stuck(_end(commanded), _end(path))),
        )

    @property
    def ok(self) -> bool:
        """Whether the robot neither fell nor stalled."""
        return self.fell_at is None and not self.stalls

    @property
    def way_ratio(self) -> float:
        """Distance covered along the line to the commanded end, over the commanded distance; NaN where that is tiny."""
        x, y, _ = self.commanded_end
        length = math.hypot(x, y)
        return (x * self.end[0] + y * self.end[1]) / length**2 if length >= _MEASURABLE[0] else math.nan

    @property
    def turn_ratio(self) -> float:
        """Total yaw over the commanded one; NaN where that is tiny."""
        turn = self.commanded_end[2]
        return self.end[2] / turn if abs(turn) >= _MEASURABLE[1] else math.nan

    @property
    def problems(self) -> tuple[str, ...]:
        """What went wrong, a line each."""
        fell = () if self.fell_at is None else (f"fell at {self.fell_at:.2f} s",)
        return (*fell, *self.stalls)


# Least commanded distance and turn for which a ratio is given [m, rad].
_MEASURABLE = (0.01, math.radians(5))


def _relative(trace: Trace, *, commanded: bool) -> Float[np.ndarray, "n 4"]:
    """Return x, y, height and yaw of the body, relative to the first sample in its heading frame."""
    pose = trace.commanded_body if commanded else trace.body
    yaw = np.unwrap(np.asarray(pose.rpy)[:, 2])
    moved = np.asarray(pose.position) - pose.position[0]
    c, s = math.cos(yaw[0]), math.sin(yaw[0])
    x, y = c * moved[:, 0] + s * moved[:, 1], c * moved[:, 1] - s * moved[:, 0]
    return np.stack([x, y, moved[:, 2], yaw - yaw[0]], axis=-1)


def _end(path: Float[np.ndarray, "n 4"]) -> tuple[float, float, float]:
    return float(path[-1, 0]), float(path[-1, 1]), float(path[-1, 3])


def _fall(trace: Trace, tilt: Float[np.ndarray, "n"]) -> float | None:
    """Return when the robot fell; None if it didn't."""
    down = (trace.body_touches & ~_near(trace.time, trace.commanded_belly)) | (tilt > FALLEN)
    return float(trace.time[int(np.argmax(down))]) if down.any() else None


def _near(time: Float[np.ndarray, "n"], marked: Bool[np.ndarray, "n"]) -> Bool[np.ndarray, "n"]:
    """Return which times are within `_BELLY_MARGIN` of one that is marked."""
    times = time[marked]
    if not len(times):
        return marked
    after = np.clip(np.searchsorted(times, time), 0, len(times) - 1)
    nearest = np.minimum(np.abs(times[after] - time), np.abs(times[np.maximum(after - 1, 0)] - time))
    return np.asarray(nearest <= _BELLY_MARGIN)


def _stalled(trace: Trace) -> list[str]:
    """Return the joints whose servo is saturated for too long, a line each."""
    lines = []
    for leg, joint in np.argwhere(trace.saturated.any(0)).tolist():
        edges = np.flatnonzero(np.diff(trace.saturated[:, leg, joint].astype(int), prepend=0, append=0))
        begins, ends = edges[::2], edges[1::2] - 1
        lasted = trace.time[ends] - trace.time[begins]
        longest = int(np.argmax(lasted))
        if lasted[longest] >= _STALL:
            lines.append(
                f"{trace.robot.leg_names[leg]} {JOINTS[joint]}: at its maximum torque for {lasted[longest]:.2f} s "
                f"from {trace.time[begins[longest]]:.2f} s"
            )
    return lines


def _stuck(commanded: tuple[float, float, float], end: tuple[float, float, float]) -> list[str]:
    way = math.hypot(*commanded[:2])
    made = (commanded[0] * end[0] + commanded[1] * end[1]) / way if way else 0.0
    if way < _WAY or made >= _STUCK * way:
        return []
    return [f"covered {1000 * made:.0f} mm of {1000 * way:.0f} mm"]
