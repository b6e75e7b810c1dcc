"""Gaits: duty factor and offsets of the legs."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple, Self, TypeAlias

import numpy as np

from tarsus.arrays import Array, namespace
from tarsus.errors import InputError, UnknownNameError

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["GAITS", "Gait"]


_Timing: TypeAlias = tuple[float, tuple[float, ...]]


def _sides(legs: int) -> tuple[list[int], list[int]]:
    """Return the legs of the left and of the right side, each from back to front."""
    return list(range(legs // 2 - 1, -1, -1)), list(range(legs // 2, legs))


def _in_order(offsets: Mapping[int, float]) -> tuple[float, ...]:
    return tuple(offsets[leg] for leg in sorted(offsets))


def _tripod(legs: int) -> _Timing:
    """Even and odd legs alternate."""
    return 1 / 2, tuple(0.5 * (leg % 2) for leg in range(legs))


def _tetrapod(legs: int) -> _Timing:
    """Four feet or more on the ground: sets of diagonal legs in turn, from back to front on each side.

    Six legs: three pairs. Seven: three sets of two or three. Eight: two sets of four, which alternate.
    """
    sets = math.ceil(legs / (legs - 4))
    left, right = _sides(legs)
    offsets = {leg: (i % sets) / sets for i, leg in enumerate(left)}
    offsets |= {leg: ((i + 1) % sets) / sets for i, leg in enumerate(right)}
    return (sets - 1) / sets, _in_order(offsets)


def _ripple(legs: int) -> _Timing:
    """Back to front on each side, the sides alternating: two legs in the air, overlapping."""
    left, right = _sides(legs)
    if legs % 2:
        # The longer side begins; the other one follows half its length later.
        late = len(left) // 2
        slots = {leg: 2 * i for i, leg in enumerate(right)}
        slots |= {leg: 2 * ((i + late) % len(left)) + 1 for i, leg in enumerate(left)}
    else:
        # The right side follows half a cycle later, in an odd slot.
        late = legs // 2 + (legs // 2 + 1) % 2
        slots = {leg: 2 * i for i, leg in enumerate(left)} | {leg: (2 * i + late) % legs for i, leg in enumerate(right)}
    return (legs - 2) / legs, _in_order({leg: slot / legs for leg, slot in slots.items()})


def _wave(legs: int) -> _Timing:
    """One leg in the air: the left side from back to front, then the right side."""
    left, right = _sides(legs)
    return (legs - 1) / legs, _in_order({leg: slot / legs for slot, leg in enumerate((*left, *right))})


def _creep(legs: int) -> _Timing:
    """One leg at a time, around the ring; between two swings all feet are on the ground."""
    return 1 - 2 / (3 * legs), tuple(leg / legs for leg in range(legs))


class _Named(NamedTuple):
    """A standard gait: its timing for a number of legs, whether it exists for that number, whether the body shifts."""

    timing: Callable[[int], _Timing]
    exists: Callable[[int], bool]
    body_shift: bool = False


_NAMED = {
    "tripod": _Named(_tripod, lambda legs: legs >= 6 and legs % 2 == 0),
    "tetrapod": _Named(_tetrapod, lambda legs: 6 <= legs <= 8),
    "ripple": _Named(_ripple, lambda legs: legs >= 5),
    "wave": _Named(_wave, lambda legs: legs >= 5),
    "creep": _Named(_creep, lambda legs: legs == 4, body_shift=True),
}
_ALIASES = {"amble": "tetrapod"}

# Tolerance within which phases count as equal [cycles].
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
    body_shift : bool
        Whether the body shifts over the feet that stay on the ground before another one lifts: see
        `tarsus.gait.body_shift`.
    """

    duty_factor: float
    offsets: tuple[float, ...]
    name: str = "custom"
    body_shift: bool = False

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
    def named(cls, name: str, *, legs: int = 6, turning: float = 0.0) -> Self:
        """Return one of the standard gaits.

        Parameters
        ----------
        name : str
            ``"tripod"``: even and odd legs alternate; duty factor 1/2; an even number of legs from six.
            ``"tetrapod"`` (also called amble): sets of legs in turn, at least four feet down; 2/3 for six and seven
            legs, 1/2 for eight. ``"ripple"``: two legs in the air, overlapping; ``(legs - 2) / legs``, five legs or
            more. ``"wave"``: one leg in the air; ``(legs - 1) / legs``, five legs or more. Source 004's "ripple", with
            five feet down, is the wave. ``"creep"``: one leg at a time with a body shift; 5/6; four legs.
        legs : int
            Number of legs.
        turning : float
            Angle or yaw rate of the walk: in a clockwise turn (negative) the creep gait steps clockwise around the
            body, else counter-clockwise.

        Raises
        ------
        UnknownNameError
            If there is no such gait.
        InputError
            If the gait does not exist for that number of legs.

        Notes
        -----
        D. M. Wilson, "Insect walking", Annual Review of Entomology 11 (1966): tripod, tetrapod, ripple and wave.
        R. B. McGhee and A. A. Frank, "On the stability properties of quadruped creeping gaits", Mathematical
        Biosciences 3 (1968): a quadruped that keeps one foot at most in the air is statically stable with the order
        left rear, left front, right rear, right front, by (duty factor - 3/4) of a stride; that margin is 0 in short
        strides. With a body shift, the order around the body needs less acceleration.
        """
        key = _ALIASES.get(str(name).lower(), str(name).lower())
        if key not in _NAMED:
            raise UnknownNameError.of("gait", str(name), (*_NAMED, *_ALIASES))
        if not _NAMED[key].exists(legs):
            others = [other for other, gait in _NAMED.items() if gait.exists(legs)]
            known = f"{legs} legs have: {', '.join(others)}" if others else "gaits need four legs or more"
            raise InputError(f"the {key} gait does not exist for {legs} legs; {known}")
        duty_factor, offsets = _NAMED[key].timing(legs)
        if key == "creep" and turning < 0:
            offsets = tuple(reversed(offsets))
        return cls(duty_factor=duty_factor, offsets=offsets, name=key, body_shift=_NAMED[key].body_shift)

    @property
    def legs(self) -> int:
        """Number of legs."""
        return len(self.offsets)

    @cached_property
    def beats(self) -> int:
        """Number of lift-offs per cycle; legs that lift off together count once."""
        return len(set(self.offsets))

    @cached_property
    def fewest_feet_down(self) -> int:
        """Least number of feet on the ground during the cycle."""
        # The number decreases only at lift-offs.
        after = np.asarray(self.offsets) + self.duty_factor + 2 * _ROUNDING
        return int(self.phase(after)[2].sum(-1).min())

    def phase(
        self, clock: Float[Array, "*#batch"]
    ) -> tuple[Float[Array, "*batch legs"], Float[Array, "*batch legs"], Bool[Array, "*batch legs"]]:
        """Return the step, the phase and the contact of each leg.

        At touchdown and at lift-off a foot counts as on the ground: where one foot lifts off as another touches down,
        rounding then never leaves both in the air.

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
