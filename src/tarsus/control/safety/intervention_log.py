"""Log of interventions: counts, the worst of each kind, and the latest ones."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from types import MappingProxyType

from tarsus.control.safety.interventions import Intervention, InterventionKind, Violation
from tarsus.control.safety.output import GuardState
from tarsus.robot.robot import Robot

__all__ = ["InterventionLog"]


class InterventionLog:
    """Interventions of a guard, in bounded memory.

    Attributes
    ----------
    latest : deque of Intervention
        The latest interventions at the tick they began, oldest first.
    counts : mapping of InterventionKind to int
        How many interventions of each kind began.

    Parameters
    ----------
    robot : Robot
        The robot, for the names of its legs.
    size : int
        Capacity of `latest`.
    """

    def __init__(self, robot: Robot, size: int) -> None:
        self._robot = robot
        self._active: set[InterventionKind] = set()
        self._counts: dict[InterventionKind, int] = {}
        self._worst: dict[InterventionKind, Intervention] = {}
        self.latest: deque[Intervention] = deque(maxlen=size)
        self.counts: Mapping[InterventionKind, int] = MappingProxyType(self._counts)

    def record(self, violations: list[Violation], time: float) -> tuple[Intervention, ...]:
        """Log the violations of a tick; return the worst one of each kind as interventions.

        Parameters
        ----------
        violations : list of Violation
            All violations of the tick.
        time : float
            Time of the guard [s].
        """
        worst: dict[InterventionKind, Violation] = {}
        for violation in violations:
            if violation.kind not in worst or violation.excess > worst[violation.kind].excess:
                worst[violation.kind] = violation
        found = tuple(violation.named(self._robot, time) for violation in worst.values())
        for intervention in found:
            self._count(intervention)
        self._active = set(worst)
        return found

    def end_active(self) -> None:
        """End all active interventions: the tick has no violation."""
        if self._active:
            self._active = set()

    def _count(self, found: Intervention) -> None:
        kind = found.kind
        if kind not in self._active:
            self._counts[kind] = self._counts.get(kind, 0) + 1
            self.latest.append(found)
        worst = self._worst.get(kind)
        if worst is None or found.excess > worst.excess:
            self._worst[kind] = found

    def summary(self, time: float, state: GuardState) -> str:
        """Return the counts and the worst intervention of each kind as text.

        Parameters
        ----------
        time : float
            Time of the guard [s].
        state : GuardState
            State of the guard.
        """
        total = sum(self._counts.values())
        lines = [f"{total} intervention{'s' * (total != 1)} in {time:.2f} s, state: {state}"]
        lines += [f"  {number} x {self._worst[kind].text()}" for kind, number in self._counts.items()]
        return "\n".join(lines)
