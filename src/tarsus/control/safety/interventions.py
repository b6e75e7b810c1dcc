"""Interventions: violations of a bound as values for records and messages; their log; the output of the guard."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping, Set
from enum import StrEnum
from operator import attrgetter
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple, Self

import numpy as np

from tarsus.representation import represented

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["GuardOutput", "GuardState", "Intervention", "InterventionKind", "InterventionLog"]


_DEGREES = 57.29577951308232


class InterventionKind(StrEnum):
    """What violates a bound; the value is the name in records.

    Attributes
    ----------
    quantity, unit : str
        The quantity that is bounded, and the unit in which it is shown.
    scale : float
        How many of these units make one SI unit.
    """

    quantity: str
    unit: str
    scale: float

    def __new__(cls, name: str, quantity: str, unit: str, scale: float) -> Self:
        """Return the member for a row of the table below."""
        kind = str.__new__(cls, name)
        kind._value_, kind.quantity, kind.unit, kind.scale = name, quantity, unit, scale
        return kind

    SHAPE = "shape", "joint angle array", "values", 1.0
    NOT_FINITE = "not_finite", "non-finite joint angle", "deg", _DEGREES
    TIME_STEP = "time_step", "time step", "s", 1.0
    TIME_GAP = "time_gap", "time gap", "s", 1.0
    JOINT_LIMIT = "joint_limit", "joint angle", "deg", _DEGREES
    JOINT_SPEED = "joint_speed", "joint speed", "deg/s", _DEGREES
    JOINT_ACCELERATION = "joint_acceleration", "joint acceleration", "deg/s^2", _DEGREES
    BRAKING_DISTANCE = "braking_distance", "braking distance", "deg", _DEGREES
    CONTACTS = "contacts", "contact array", "values", 1.0
    BODY_POSE = "body_pose", "body rotation", "values", 1.0
    STABILITY_MARGIN = "stability_margin", "stability margin", "mm", 1e3
    FOOT_DRAG = "foot_drag", "foot drag", "mm", 1e3
    FOOT_HEIGHT = "foot_height", "height off the ground plane", "mm", 1e3
    COMMAND_DISTANCE = "command_distance", "distance of the command", "deg", _DEGREES


@represented()
class Intervention(NamedTuple):
    """The reason why the guard did not pass a command.

    Attributes
    ----------
    kind : InterventionKind
        What violates the bound.
    leg, joint : str
        Short name of the leg and name of the joint; empty for none.
    value, bound : float
        The value and its bound, in SI units; NaN where there is no number.
    time : float
        Time of the guard [s].
    """

    kind: InterventionKind
    leg: str
    joint: str
    value: float
    bound: float
    time: float = 0.0

    @property
    def excess(self) -> float:
        """Distance of the value from its bound."""
        return abs(self.value - self.bound)

    def text(self) -> str:
        """Return the intervention as a line of text, in mm and degrees."""
        kind = self.kind
        place = " ".join(name for name in (self.leg, self.joint) if name)
        value = "" if math.isnan(self.value) else f" {self.value * kind.scale:.4g} {kind.unit}"
        bound = "" if math.isnan(self.bound) else f", bound {self.bound * kind.scale:.4g} {kind.unit}"
        return f"{place + ': ' if place else ''}{kind.quantity}{value}{bound}, at {self.time:.3f} s"


class GuardState(StrEnum):
    """What the guard does with the commands."""

    PASSING = "passing"
    """The command is sent."""
    HOLDING = "holding"
    """The joints brake, then hold their position."""
    SITTING = "sitting"
    """The body is lowered to the ground."""
    RECOVERING = "recovering"
    """The joints approach the command."""


@represented()
class GuardOutput(NamedTuple):
    """Output of the guard for one tick.

    Attributes
    ----------
    angles : array, shape (legs, 3)
        Joint angles that are safe to send [rad], read-only.
    ok : bool
        Whether `angles` are the commanded angles.
    state : GuardState
        What the guard does.
    time : float
        Time of the guard, to which the angles belong: the sum of all time steps above 0 and up to an hour [s].
    interventions : tuple of Intervention
        Violations of the command: the worst one of each kind.
    """

    angles: Float[np.ndarray, "legs 3"]
    ok: bool
    state: GuardState
    time: float
    interventions: tuple[Intervention, ...]


class InterventionLog:
    """Interventions of a guard, in bounded memory.

    Attributes
    ----------
    latest : deque of Intervention
        The latest interventions at the tick they began, oldest first.
    counts, worst : mapping of InterventionKind to int, and to Intervention
        How many interventions of each kind began; the worst of each.

    Parameters
    ----------
    size : int
        Capacity of `latest`.
    """

    def __init__(self, size: int) -> None:
        self._active: Set[InterventionKind] = set()
        self._counts: dict[InterventionKind, int] = {}
        self.worst: dict[InterventionKind, Intervention] = {}
        self.latest: deque[Intervention] = deque(maxlen=size)
        self.counts: Mapping[InterventionKind, int] = MappingProxyType(self._counts)

    def record(self, violations: list[Intervention], time: float) -> tuple[Intervention, ...]:
        """Log the violations of a tick; return the worst one of each kind.

        Parameters
        ----------
        violations : list of Intervention
            All violations of the tick; those of the last tick that are not among them have ended.
        time : float
            Time of the guard [s].
        """
        worst: dict[InterventionKind, Intervention] = {}
        for violation in violations:
            found = violation._replace(time=time)
            worst[found.kind] = max(worst.get(found.kind, found), found, key=attrgetter("excess"))
        for kind, found in worst.items():
            if kind not in self._active:
                self._counts[kind] = self._counts.get(kind, 0) + 1
                self.latest.append(found)
            self.worst[kind] = max(self.worst.get(kind, found), found, key=attrgetter("excess"))
        self._active = worst.keys()
        return tuple(worst.values())
