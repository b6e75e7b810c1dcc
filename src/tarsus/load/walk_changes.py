"""Changes of a walk that raise the safety factor of the servos that a robot has."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from tarsus.errors import InputError, TarsusError
from tarsus.gait.gait import GAITS, Gait
from tarsus.gait.motion import Motion
from tarsus.load.compliant.decisive_loads import decisive_loads
from tarsus.load.compliant.for_loads import compliant_or_missing
from tarsus.load.loads import JointLoads, joint_loads
from tarsus.load.verdict import CONTINUOUS_FRACTION, SAFETY_FACTOR
from tarsus.representation import represented

__all__ = ["WalkChange", "walk_changes"]

# Step by which body height and stance width are varied [m], and the greatest number of such steps.
_STEP = 0.01
_STEPS = 5
# Changes that raise the factor by less than this fraction are left out.
_NEGLIGIBLE = 0.02


@represented()
@dataclass(frozen=True, kw_only=True)
class WalkChange:
    """A change of a walk, and the safety factor with it.

    Attributes
    ----------
    text : str
        What to change.
    options : mapping
        The arguments of `plan_walk` that differ [m]: ``"body_height"``, ``"stroke"``, ``"gait"`` (a `Gait`), and
        ``"stance_width"``, a change that is added to the stance width of the walk.
    factor : float
        Smallest stall torque over peak torque of all joints.
    thermal_ratio : float
        Largest root mean square torque over the continuous limit of all joints.
    """

    text: str
    options: Mapping[str, Any]
    factor: float
    thermal_ratio: float


def walk_changes(
    loads: JointLoads, plan: Callable[..., Motion], *, safety_factor: float = SAFETY_FACTOR
) -> tuple[WalkChange, ...]:
    """Return the changes of a walk that raise the smallest safety factor, the most effective first.

    Evaluated are a higher body, feet nearer to the body, half of the stroke, the other gaits, and combinations of body,
    feet and the best gait. Of several body heights or distances, the least change with the required factor is returned,
    else that with the largest factor; of the combinations, the best, if it is better than every single change. Walks
    that are not possible are left out.

    Factors are those by which servos are judged: for each joint, that of vertical forces or that of compliant statics,
    whichever is lower.

    Parameters
    ----------
    loads : JointLoads
        Loads of the walk as it is.
    plan : callable
        Plans the walk with the `WalkChange.options` given to it.
    safety_factor : float
        Required stall torque over peak torque.

    Returns
    -------
    tuple of WalkChange
        Empty if a servo is unknown, or nothing helps.
    """
    least = float(np.min(_decisive(loads).factor))
    if not np.isfinite(least):
        return ()
    tried = _Tried(loads, plan, safety_factor, least * (1 + _NEGLIGIBLE))
    return tuple(sorted(tried.all(), key=lambda change: -change.factor))


@dataclass(frozen=True)
class _Tried:
    loads: JointLoads
    plan: Callable[..., Motion]
    required: float
    least: float

    def all(self) -> Iterator[WalkChange]:
        """Yield every kind of change that helps, and their best combination if it helps more."""
        motion = self.loads.motion
        steps = _STEP * np.arange(1, _STEPS + 1)
        higher = self.best(
            (
                f"raise the body by {1000 * step:.0f} mm to {1000 * (motion.body_height + step):.0f} mm",
                {"body_height": motion.body_height + step},
            )
            for step in steps
        )
        nearer = self.best((f"feet {1000 * step:.0f} mm nearer to the body", {"stance_width": -step}) for step in steps)
        gaits = [
            self.change(f"{gait.name} gait", {"gait": gait})
            for gait in _gaits(self.loads.robot.legs)
            if gait != motion.gait
        ]
        shorter = self.change(f"half of the stroke, {500 * motion.stroke:.0f} mm", {"stroke": motion.stroke / 2})
        single = [change for change in (higher, nearer, *gaits, shorter) if change is not None]
        yield from single
        best_gait = max((change for change in gaits if change is not None), key=lambda c: c.factor, default=None)
        useful = [change for change in (higher, nearer, best_gait) if change is not None]
        together = [
            self.change(", ".join(change.text for change in some), {k: v for c in some for k, v in c.options.items()})
            for count in (2, 3)
            for some in itertools.combinations(useful, count)
        ]
        best = max((change for change in together if change is not None), key=lambda c: c.factor, default=None)
        if best is not None and best.factor > max(change.factor for change in single):
            yield best

    def best(self, changes: Iterator[tuple[str, dict[str, Any]]]) -> WalkChange | None:
        """Return the first change with the required factor, else that with the largest factor; None if none helps."""
        found = []
        for text, options in changes:
            change = self.change(text, options)
            if change is not None:
                found.append(change)
                if change.factor >= self.required:
                    return change
        return max(found, key=lambda change: change.factor, default=None)

    def change(self, text: str, options: dict[str, Any]) -> WalkChange | None:
        """Return a change; None if its walk is not possible, or it does not help."""
        try:
            motion = self.plan(**options)
        except TarsusError:
            return None
        base = self.loads
        loads = _decisive(joint_loads(base.robot, motion, payload=base.payload, **base.conditions))
        factor = float(np.min(loads.factor))
        if not (motion.ok and loads.balanced and factor > self.least):
            return None
        thermal = float(np.max(loads.rms / (CONTINUOUS_FRACTION * loads.stall_torque)))
        return WalkChange(text=text, options=MappingProxyType(options), factor=factor, thermal_ratio=thermal)


def _decisive(loads: JointLoads) -> JointLoads:
    """Return the loads by which servos are judged, with compliant statics where they are known."""
    return decisive_loads(loads, compliant_or_missing(loads)[0])


def _gaits(legs: int) -> Iterator[Gait]:
    """Yield the gaits with a name for a number of legs."""
    for name in GAITS:
        try:
            yield Gait.named(name, legs=legs)
        except InputError:
            continue
