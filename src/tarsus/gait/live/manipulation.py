"""All legs of a walk that are moved by hand: which there are, where they are told to go, and what stops them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.live.hands import Hand, carry_hands, lift_hand
from tarsus.gait.live.moment import Moment
from tarsus.gait.live.wish import Wish

__all__ = ["Manipulation", "legs_out"]

Floats = np.ndarray[Any, Any]


def legs_out(wish: Wish, before: tuple[int, ...], legs: int) -> tuple[int, ...]:
    """Return which legs are to be out of the gait.

    Parameters
    ----------
    wish : Wish
        The wish.
    before : tuple of int
        The legs that were to be out so far.
    legs : int
        How many legs the robot has.

    Raises
    ------
    InputError
        If the wish names a leg that there is not.
    """
    if not (wish.hands or wish.hand_speeds):
        return before
    out = set(before)
    for leg, point in [*(wish.hands or {}).items(), *(wish.hand_speeds or {}).items()]:
        if leg not in range(legs):
            raise InputError(f"hand {leg!r}: the robot has the legs 0 to {legs - 1}")
        (out.discard if point is None else out.add)(leg)
    return tuple(sorted(out))


class Manipulation:
    """The hands of a walker.

    Parameters
    ----------
    names : sequence of str
        What the legs are called.
    """

    def __init__(self, names: Sequence[str]) -> None:
        self._names = names
        self._hands: dict[int, Hand] = {}
        self._out: tuple[int, ...] = ()
        self._points: dict[int, Sequence[float]] = {}
        self._parts: dict[int, float] = {}

    def __bool__(self) -> bool:
        return bool(self._hands)

    @property
    def legs(self) -> list[int]:
        """The legs that don't bear: those that are out, and those on their way back, still in the air."""
        return list(self._hands)

    @property
    def returning(self) -> bool:
        """Whether a leg is on its way back."""
        return len(self._hands) > len(self._out)

    @property
    def limited(self) -> list[str]:
        """What hands don't reach."""
        return [
            f"hand: {100 * part:.0f} % of the way, there {self._names[leg]} comes to the end of its reach"
            for leg, part in self._parts.items()
            if part < 1
        ]

    def take(self, out: tuple[int, ...], now: Moment) -> None:
        """Make the legs that are out from now on hands; one that comes back stays in the air until its next step.

        Parameters
        ----------
        out : tuple of int
            The legs.
        now : Moment
            Where their feet are.
        """
        stopped = {leg: hand.stopped() for leg, hand in self._hands.items() if leg not in out}
        self._hands = stopped | {leg: self._hands.get(leg) or lift_hand(now, leg) for leg in out}
        self._out, self._parts = out, {}

    def tell(self, wish: Wish, dt: float, reachable: Callable[[int, Floats, Floats], float]) -> None:
        """Set where the hands go: as far towards what is asked for as their legs reach.

        Parameters
        ----------
        wish : Wish
            A point in it holds until there is another; a speed, as long as it is given.
        dt : float
            For how long [s].
        reachable : callable
            How much of the way a leg's foot can go from one point to another.
        """
        if not (self._points or wish.hands or wish.hand_speeds):
            return
        speeds = wish.hand_speeds or {}
        asked = {**self._points, **(wish.hands or {})}
        self._points = {leg: point for leg, point in asked.items() if point is not None and leg not in speeds}
        for leg in self._out:
            hand = self._hands[leg]
            here = hand.place.value
            if leg in speeds:
                wished = hand.target + np.array(speeds[leg]) * dt
            elif leg in self._points:
                wished = np.array(self._points[leg])
            else:
                continue
            wished[2] = max(wished[2], 0.0)
            part = self._parts[leg] = reachable(leg, here, wished)
            self._hands[leg] = hand._replace(target=here + part * (wished - here))

    def carry(self, now: Moment, time: float, *, swing_time: float) -> Moment:
        """Return a moment with the hands where they are after a time.

        Parameters
        ----------
        now : Moment
            The moment, after that time.
        time : float
            The time [s].
        swing_time : float
            How long a swing takes [s].
        """
        if not self._hands:
            return now
        return carry_hands(now, {leg: hand.step(time) for leg, hand in self._hands.items()}, swing_time)

    def step(self, time: float, down: Floats) -> None:
        """Go on by a time; a leg that has been lifted to step is a hand no more.

        Parameters
        ----------
        time : float
            The time [s].
        down : array of bool, shape (legs,)
            Which feet are not in a swing.
        """
        if self._hands:
            self._hands = {leg: hand.step(time) for leg, hand in self._hands.items() if down[leg]}

    def without(self, bounds: Floats) -> Floats:
        """Return the feet's polygons without those of the hands, whose legs bound them by themselves.

        Parameters
        ----------
        bounds : array, shape (legs, 16)
            Sides of the polygons [m].
        """
        if not self._hands:
            return bounds
        free = bounds.copy()
        free[self.legs] = np.inf
        return free
