"""Gaits: duty factor and offsets of the legs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np

from tarsus.arrays import Array, namespace
from tarsus.errors import InputError, UnknownNameError

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["GAITS", "Gait"]


def _tripod(legs: int) -> tuple[float, tuple[float, ...]]:
    """Even and odd legs alternate."""
    return 1 / 2, tuple(0.5 * (leg % 2) for leg in range(legs))


def _tetrapod(_legs: int) -> tuple[float, tuple[float, ...]]:
    """Three diagonal pairs in turn, from back to front on each side."""
    return 2 / 3, (2 / 3, 1 / 3, 0.0, 1 / 3, 2 / 3, 0.0)


def _ripple(_legs: int) -> tuple[float, tuple[float, ...]]:
    """Back to front on each side, the sides half a cycle apart: two legs in the air, overlapping."""
    return 2 / 3, (4 / 6, 2 / 6, 0.0, 3 / 6, 5 / 6, 1 / 6)


def _wave(legs: int) -> tuple[float, tuple[float, ...]]:
    """One leg in the air: the left side from back to front, then the right side."""
    left = legs // 2
    order = [*range(left - 1, -1, -1), *range(left, legs)]
    return (legs - 1) / legs, tuple(order.index(leg) / legs for leg in range(legs))


_NAMED: dict[str, Callable[[int], tuple[float, tuple[float, ...]]]] = {
    "tripod": _tripod,
    "tetrapod": _tetrapod,
    "ripple": _ripple,
    "wave": _wave,
}
_ALIASES = {"amble": "tetrapod"}

# Tolerance of equal phases [cycles].
_ROUNDING = 1e-9

GAITS = tuple(_NAMED)
"""Names of the gaits that `Gait.named` knows."""


@dataclass(frozen=True)
class Gait:
    """A periodic sequence of steps.

    Attributes
    ----------
    duty_factor : float
        Fraction of the cycle for which a foot is on the ground.
    offsets : tuple of float
        For each leg, the phase of the cycle at which its foot touches down, in [0, 1).
    name : str
        Name.
    """

    duty_factor: float
    offsets: tuple[float, ...]
    name: str = "custom"

    def __post_init__(self) -> None:
        try:
            object.__setattr__(self, "duty_factor", float(self.duty_factor))
            object.__setattr__(self, "offsets", tuple(float(offset) for offset in self.offsets))
        except (TypeError, ValueError) as error:
            raise InputError(f"gait {self.name!r}: duty_factor and offsets must be numbers: {error}") from None
        if not self.offsets:
            raise InputError(f"gait {self.name!r}: offsets is empty; it must have one value for each leg")
        if not 0 < self.duty_factor < 1:
            raise InputError(
                f"gait {self.name!r}: duty_factor is {self.duty_factor}; it must be greater than 0 and less than 1"
            )
        for leg, offset in enumerate(self.offsets):
            if not 0 <= offset < 1:
                raise InputError(f"gait {self.name!r}: offsets[{leg}] is {offset}; it must be in [0, 1)")

    @classmethod
    def named(cls, name: str, *, legs: int = 6) -> Self:
        """Return one of the standard gaits.

        Parameters
        ----------
        name : str
            ``"tripod"`` (duty factor 1/2), ``"tetrapod"`` (2/3, also called amble), ``"ripple"`` (2/3) or ``"wave"``
            ((legs - 1)/legs: 5/6 for six). Source 004's "ripple", with five feet down, is the wave.
        legs : int
            Number of legs: tetrapod and ripple require six, tripod an even number of at least six, wave at least four.

        Raises
        ------
        UnknownNameError
            If there is no such gait.
        InputError
            If the gait does not exist for that number of legs.
        """
        key = _ALIASES.get(str(name).lower(), str(name).lower())
        if key not in _NAMED:
            raise UnknownNameError.of("gait", str(name), (*_NAMED, *_ALIASES))
        fits = {"tripod": legs >= 6 and legs % 2 == 0, "wave": legs >= 4}.get(key, legs == 6)
        if not fits:
            raise InputError(f"the {key} gait does not exist for {legs} legs; the wave gait does for 4 or more")
        duty_factor, offsets = _NAMED[key](legs)
        return cls(duty_factor=duty_factor, offsets=offsets, name=key)

    @property
    def legs(self) -> int:
        """Number of legs."""
        return len(self.offsets)

    @property
    def fewest_feet_down(self) -> int:
        """Least number of feet on the ground during the cycle."""
        # The number decreases only at lift-offs.
        after = np.asarray(self.offsets) + self.duty_factor + 2 * _ROUNDING
        return int(self.phase(after)[2].sum(-1).min())

    def phase(
        self, clock: Float[Array, "*#batch"]
    ) -> tuple[Float[Array, "*batch legs"], Float[Array, "*batch legs"], Bool[Array, "*batch legs"]]:
        """Return the step, the phase and the contact of each leg.

        At touchdown and at lift-off a foot counts as on the ground, so that rounding never leaves two feet in the air
        of which one lifts off as the other touches down.

        Parameters
        ----------
        clock : array, shape (...)
            Time in cycles.

        Returns
        -------
        step : array, shape (..., legs)
            Number of the step, a whole number; a step begins with the touchdown.
        phase : array, shape (..., legs)
            Time since the touchdown in cycles, in [0, 1).
        stance : array of bool, shape (..., legs)
            Whether the foot is on the ground: the phase is at most the duty factor.
        """
        xp = namespace(clock)
        since = xp.asarray(clock)[..., None] - xp.asarray(self.offsets)
        step = xp.floor(since + _ROUNDING)
        phase = since - step
        phase = xp.where(phase < 0, xp.zeros_like(phase), phase)
        return step, phase, phase <= self.duty_factor + _ROUNDING

    def require_legs(self, legs: int) -> None:
        """Refuse a robot with a different number of legs.

        Parameters
        ----------
        legs : int
            The robot's number of legs.

        Raises
        ------
        InputError
            If the numbers differ.
        """
        if self.legs != legs:
            raise InputError(f"gait {self.name!r} is for {self.legs} legs, the robot has {legs}")
