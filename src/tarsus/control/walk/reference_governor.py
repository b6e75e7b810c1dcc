"""How much of a wish the feet that are on the ground allow, until each of them is next lifted.

A reference governor (I. Kolmanovsky, E. Garone, S. Di Cairano, "Reference and command governors", American Control
Conference 2014): the target goes from where it is towards the command, as far as the walk that follows from it, stays
within bounds if the target stays there for good. What worked a tick ago then works again, so that there always is
something that works.
"""

from __future__ import annotations

import cmath
from typing import Any, NamedTuple

import numpy as np

from tarsus.control.filters import integral_factors
from tarsus.control.walk.state import GaitState
from tarsus.control.workspace.polygon import NORMALS
from tarsus.control.workspace.velocity_limits import stance_overhang
from tarsus.gait.gait import Gait

__all__ = ["governed_twist", "lift_delays", "polygon_excess", "stance_intervals", "time_to_touchdown"]

Floats = np.ndarray[Any, Any]

# What rounding may add to a distance [m]: no bound is broken by so little.
_TOLERANCE = 1e-9
# Which parts of the way to the command are tried, and which of a target that doesn't work any more.
_PARTS = np.array([0.0, 0.002, 0.006, 0.02, 0.06, 0.12, 0.22, 0.36, 0.55, 0.8, 1.0])[:, None]
_LESS = np.array([0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98, 1.0])[:, None]
# At which moments of a stance its foot is looked at.
_MOMENTS = np.array([0.0, 0.5, 1.0])[:, None]
_NORMALS = np.stack([NORMALS.real, NORMALS.imag])
# What an angle is never nearer to 0 than, so that it can be divided by.
_NO_ANGLE = 1e-30


def polygon_excess(
    now: GaitState, targets: Floats, *, begins: Floats, ends: Floats, bounds: Floats, bandwidth: float
) -> Floats:
    """Return how far each foot will be beyond each side of its polygon, were the target so from now on.

    Parameters
    ----------
    now : Moment
        The moment.
    targets : array, shape (n, 3)
        Twists to follow.
    begins, ends : array, shape (..., legs)
        From when until when the foot stays where it is, or is about to be put down [s].
    bounds : array, shape (legs, 16)
        Sides of the polygons [m].
    bandwidth : float
        How fast the twist follows its target [rad/s].

    Returns
    -------
    array, shape (..., n, 3, legs, 16)
        At the beginning, in the middle and at the end of that time [m]; negative within bounds.
    """
    return _Prediction.of(now, begins, ends, bandwidth).beyond(targets, bounds)


class _Prediction(NamedTuple):
    """Where the feet will be seen from the body, whatever its target: at three times ``(..., 3, legs)`` each."""

    seen: Floats
    of_target: Floats
    way: Floats

    @classmethod
    def of(cls, now: GaitState, begins: Floats, ends: Floats, bandwidth: float) -> _Prediction:
        """Look ahead: `way` ``(3, ..., 3, legs)`` is what the twist still comes to that there is already."""
        begins = begins[..., None, :]
        times = begins + (ends[..., None, :] - begins) * _MOMENTS
        of_target, of_value, of_rate = integral_factors(times, bandwidth=bandwidth)
        axes = (3, *(1,) * times.ndim)
        way = now.twist.value.reshape(axes) * of_value + now.twist.rate.reshape(axes) * of_rate
        return cls((now.foothold - now.origin) * cmath.exp(-1j * now.yaw), of_target, way)

    def beyond(self, targets: Floats, bounds: Floats) -> Floats:
        """Return the excess ``(..., n, 3, legs, 16)`` under targets ``(n, 3)``."""
        travel = targets.T[(slice(None), *(None,) * (self.of_target.ndim - 2), ..., None, None)]
        x, y, angle = travel * self.of_target[..., None, :, :] + self.way[..., None, :, :]
        # A travel (x, y) that turns by an angle ends at (x + iy) exp(i angle / 2) sin(angle / 2) / (angle / 2).
        half = 0.5 * angle + _NO_ANGLE
        back = np.exp(-1j * half)
        place = back * (self.seen * back + (x + 1j * y) * (back.imag / half))
        out: Floats = (place.view(float).reshape(-1, 2) @ _NORMALS).reshape(*place.shape, -1)
        out -= bounds
        return out


def governed_twist(
    now: GaitState,
    current: Floats,
    command: Floats,
    *,
    begins: Floats,
    ends: Floats,
    bounds: Floats,
    bandwidth: float,
) -> Floats:
    """Return a target on the way from the current one to the command that works; the command where it does.

    Some parts of the way are tried, all at once, and the largest that works is taken: asked again tick after tick, it
    comes as near as 0.2 % of what is left of the way.

    Parameters
    ----------
    now : Moment
        The moment.
    current, command : array, shape (3,)
        The twist that is followed, and the one that should be.
    begins, ends, bounds, bandwidth
        As for `polygon_excess`.

    Returns
    -------
    array, shape (3,)
        The target. Where not even the current one works, as much less of it as does.
    """
    outlook = _Prediction.of(now, begins, ends, bandwidth)
    targets = command[None] if (command == current).all() else current + _PARTS * (command - current)
    works = outlook.beyond(targets, bounds).reshape(len(targets), -1).max(axis=1) <= _TOLERANCE
    if works[-1]:
        return command
    if works.any():
        return np.asarray(targets[np.flatnonzero(works)[-1]])
    targets = _LESS * current
    over = outlook.beyond(targets, bounds).reshape(len(targets), -1)
    works = over.max(axis=1) <= _TOLERANCE
    if works.any():
        return np.asarray(targets[np.flatnonzero(works)[-1]])
    # Nothing keeps every foot within bounds: what takes it least beyond.
    still, here = over[0], over[-1]
    if here.max() <= still.max():
        return current
    broken = here > 0
    gain = here[broken] - still[broken]
    needed = np.where(gain > 0, here[broken] / np.where(gain > 0, gain, 1.0), 1.0).max()
    slower: Floats = current * (1 - min(float(needed), 1.0))
    return slower


def stance_intervals(now: GaitState, gait: Gait, frequency: float, hold: float) -> tuple[Floats, Floats]:
    """Return from when until when each foot is where it stands, or where it is about to, ``(legs,)`` each [s].

    Parameters
    ----------
    now : Moment
        The moment.
    gait : Gait
        Order of the steps.
    frequency : float
        Cycles a second [1/s].
    hold : float
        How long feet may have to wait for others that look for ground [s].
    """
    duty_factor = gait.duty_factor
    over = (stance_overhang(duty_factor) - 0.5) * duty_factor / frequency + hold
    begins: list[float] = []
    ends: list[float] = []
    for down, share, number, offset in zip(
        now.down.tolist(), now.swing_phase.tolist(), now.step_number.tolist(), gait.offsets, strict=True
    ):
        begins.append(0.0 if down else (1 - share) * (1 - duty_factor) / frequency)
        swing_height = (offset + duty_factor + number - now.clock) / frequency
        # Where it waits already, its time to lift is past.
        ends.append((max(swing_height, 0.0) if down else begins[-1] + duty_factor / frequency) + over)
    return np.array(begins), np.array(ends)


def time_to_touchdown(now: GaitState, gait: Gait, frequency: float) -> Floats:
    """Return how long each foot is still in the air ``(legs,)`` [s].

    Parameters
    ----------
    now, gait, frequency
        As for `stance_intervals`.
    """
    return np.where(now.down, 0.0, (1 - now.swing_phase) * (1 - gait.duty_factor) / frequency)


def lift_delays(gait: Gait, cycle_time: float) -> Floats:
    """Return how long feet stand that are all down when an order of steps begins ``(legs, legs)`` [s].

    Parameters
    ----------
    gait : Gait
        Order of the steps.
    cycle_time : float
        Duration of a cycle [s].

    Returns
    -------
    array
        In each row, for each leg, if the row's leg lifts first.
    """
    offsets = np.asarray(gait.offsets)
    over = (stance_overhang(gait.duty_factor) - 0.5) * gait.duty_factor
    return np.asarray(((offsets - offsets[:, None]) % 1 + over) * cycle_time)
