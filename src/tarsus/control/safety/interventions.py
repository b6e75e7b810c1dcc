"""What a guard found and did: named, counted, and the last of it kept."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from tarsus.robot.robot import JOINTS, Robot

__all__ = ["KINDS", "GuardOutput", "Intervention", "InterventionLog", "Violation"]

_DEGREES = 57.29577951308232

KINDS: Mapping[str, tuple[str, float]] = MappingProxyType(
    {
        "shape": ("values", 1.0),
        "finite": ("deg", _DEGREES),
        "time_step": ("s", 1.0),
        "gap": ("s", 1.0),
        "limit": ("deg", _DEGREES),
        "speed": ("deg/s", _DEGREES),
        "acceleration": ("deg/s^2", _DEGREES),
        "braking": ("deg", _DEGREES),
        "contacts": ("values", 1.0),
        "body": ("values", 1.0),
        "stability": ("mm", 1e3),
        "drag": ("mm", 1e3),
        "ground": ("mm", 1e3),
        "away": ("deg", _DEGREES),
    }
)
"""The kinds of intervention: the unit that each is shown in, and how many of these make one of SI."""


class Violation(NamedTuple):
    """Something that breaks a bound: what kind, which leg and joint (-1: none), the number and its bound."""

    kind: str
    leg: int
    joint: int
    value: float
    bound: float

    @property
    def excess(self) -> float:
        """How far the number is beyond its bound."""
        return abs(self.value - self.bound)


class Intervention(NamedTuple):
    """Why a guard did not let angles through.

    Attributes
    ----------
    kind : str
        One of `KINDS`.
    leg, joint : str
        The leg's short name and the joint's; empty where it is about none in particular.
    value, bound : float
        The number and the bound that it breaks, in SI units; NaN where there is no number.
    time : float
        The guard's time [s].
    """

    kind: str
    leg: str
    joint: str
    value: float
    bound: float
    time: float

    def text(self) -> str:
        """Return it as a line of text, in mm and degrees."""
        unit, scale = KINDS[self.kind]
        where = " ".join(name for name in (self.leg, self.joint) if name)
        number = "" if math.isnan(self.value) else f" {self.value * scale:.4g} {unit}"
        bound = "" if math.isnan(self.bound) else f" (bound {self.bound * scale:.4g})"
        return f"{self.kind}:{' ' + where if where else ''}{number}{bound} at {self.time:.3f} s"


class GuardOutput(NamedTuple):
    """What a guard says about one tick.

    Attributes
    ----------
    angles : array, shape (legs, 3)
        What may be sent [rad], read-only.
    ok : bool
        Whether these are the commanded angles.
    state : str
        ``"passing"``, ``"holding"``, ``"sitting"`` or ``"recovering"``.
    time : float
        The guard's time, which the angles are for [s]: the sum of the sane time steps.
    interventions : tuple of Intervention
        What is wrong with what was commanded, at most one of each kind: its worst.
    """

    angles: np.ndarray[Any, np.dtype[np.float64]]
    ok: bool
    state: str
    time: float
    interventions: tuple[Intervention, ...]


class InterventionLog:
    """The interventions so far: counted by kind, the worst of each kind, and the last few."""

    def __init__(self, robot: Robot, size: int) -> None:
        self._legs = robot.leg_codes
        self._present: set[str] = set()
        self._counts: dict[str, int] = {}
        self._worst: dict[str, Intervention] = {}
        self.log: deque[Intervention] = deque(maxlen=size)
        self.counts: Mapping[str, int] = MappingProxyType(self._counts)

    def note(self, faults: list[Violation], time: float) -> tuple[Intervention, ...]:
        """Return the faults of a tick as interventions, the worst of each kind; count those that are new."""
        worst: dict[str, Violation] = {}
        for fault in faults:
            if fault.kind not in worst or fault.excess > worst[fault.kind].excess:
                worst[fault.kind] = fault
        found = tuple(self._named(fault, time) for fault in worst.values())
        for intervention in found:
            self._count(intervention)
        self._present = set(worst)
        return found

    def quiet(self) -> None:
        """Take note of a tick without a fault."""
        if self._present:
            self._present = set()

    def _named(self, fault: Violation, time: float) -> Intervention:
        leg = self._legs[fault.leg] if fault.leg >= 0 else ""
        joint = JOINTS[fault.joint] if fault.joint >= 0 else ""
        return Intervention(fault.kind, leg, joint, fault.value, fault.bound, time)

    def _count(self, found: Intervention) -> None:
        kind = found.kind
        if kind not in self._present:
            self._counts[kind] = self._counts.get(kind, 0) + 1
            self.log.append(found)
        before = self._worst.get(kind)
        if before is None or abs(found.value - found.bound) > abs(before.value - before.bound):
            self._worst[kind] = found

    def summary(self, time: float, state: str) -> str:
        """Return the counts and the worst of each kind as text."""
        total = sum(self._counts.values())
        lines = [f"{total} intervention{'s' * (total != 1)} in {time:.2f} s, now {state}"]
        lines += [f"  {number} x {self._worst[kind].text()}" for kind, number in self._counts.items()]
        return "\n".join(lines)
