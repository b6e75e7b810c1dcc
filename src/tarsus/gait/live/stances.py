"""From when until when each foot stands: what the governor has to look ahead to."""

from __future__ import annotations

from typing import Any

import numpy as np

from tarsus.gait.gait import Gait
from tarsus.gait.live.envelope import overhang
from tarsus.gait.live.moment import Moment

__all__ = ["lift_delays", "stances", "until_down"]

Floats = np.ndarray[Any, Any]


def stances(now: Moment, gait: Gait, frequency: float, hold: float) -> tuple[Floats, Floats]:
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
    duty = gait.duty
    over = (overhang(duty) - 0.5) * duty / frequency + hold
    begins: list[float] = []
    ends: list[float] = []
    for down, share, number, offset in zip(
        now.down.tolist(), now.share.tolist(), now.number.tolist(), gait.offsets, strict=True
    ):
        begins.append(0.0 if down else (1 - share) * (1 - duty) / frequency)
        lift = (offset + duty + number - now.clock) / frequency
        # Where it waits already, its time to lift is past.
        ends.append((max(lift, 0.0) if down else begins[-1] + duty / frequency) + over)
    return np.array(begins), np.array(ends)


def until_down(now: Moment, gait: Gait, frequency: float) -> Floats:
    """Return how long each foot is still in the air ``(legs,)`` [s].

    Parameters
    ----------
    now, gait, frequency
        As for `stances`.
    """
    return np.where(now.down, 0.0, (1 - now.share) * (1 - gait.duty) / frequency)


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
    over = (overhang(gait.duty) - 0.5) * gait.duty
    return np.asarray(((offsets - offsets[:, None]) % 1 + over) * cycle_time)
