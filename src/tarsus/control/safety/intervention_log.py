"""Log of interventions: counts, the worst of each kind, and the latest ones."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Set
from operator import attrgetter
from types import MappingProxyType

from tarsus.control.safety.interventions import GuardState, Intervention, InterventionKind, Violation
from tarsus.robot.robot import Robot

__all__ = ["InterventionLog"]

_EXCESS = attrgetter("excess")


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
        self._active: Set[InterventionKind] = set()
        self._counts: dict[InterventionKind, int] = {}
        self._worst: dict[InterventionKind, Intervention] = {}
        self.latest: deque[Intervention] = deque(maxlen=size)
        self.counts: Mapping[InterventionKind, int] = MappingProxyType(self._counts)

    def record(self, violations: list[Violation], time: float) -> tuple[Intervention, ...]:
        """Log the violations of a tick; return the worst one of each kind as interventions.

        Parameters
        ----------
        violations : list of Violation
            All violations of the tick; those of the last tick that are not among them have ended.
        time : float
            Time of the guard [s].
        """
        worst: dict[InterventionKind, Intervention] = {}
        for violation in violations:
            found = violation.named(self._robot, time)
            worst[found.kind] = max(worst.get(found.kind, found), found, key=_EXCESS)
        for kind, found in worst.items():
            if kind not in self._active:
                self._counts[kind] = self._counts.get(kind, 0) + 1
                self.latest.append(found)
            self._worst[kind] = max(self._worst.get(kind, found), found, key=_EXCESS)
        self._active = worst.keys()
        return tuple(worst.values())

    def summary(self, time: float, state: GuardState) -> str:
        """Return the counts and the worst intervention of each kind as text.

        Parameters
        ----------
        time, state : float, GuardState
            Time of the guard [s]; state of the guard.
        """
        total = sum(self._counts.values())
        lines = [f"{total} intervention{'s' * (total != 1)} in {time:.2f} s, state: {state}"]
        lines += [f"  {number} x {self._worst[kind].text()}" for kind, number in self._counts.items()]
        return "\n".join(lines)
