"""Violations of a bound; interventions: violations as values for records and messages; the output of the guard."""

from __future__ import annotations

import math
from enum import StrEnum
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.representation import represented
from tarsus.robot.robot import JOINTS, Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["GuardOutput", "GuardState", "Intervention", "InterventionKind", "Violation"]


class InterventionKind(StrEnum):
    """What violates a bound; the value is the name in records."""

    SHAPE = "shape"
    NOT_FINITE = "not_finite"
    TIME_STEP = "time_step"
    TIME_GAP = "time_gap"
    JOINT_LIMIT = "joint_limit"
    JOINT_SPEED = "joint_speed"
    JOINT_ACCELERATION = "joint_acceleration"
    BRAKING_DISTANCE = "braking_distance"
    CONTACTS = "contacts"
    BODY_POSE = "body_pose"
    STABILITY_MARGIN = "stability_margin"
    FOOT_DRAG = "foot_drag"
    FOOT_HEIGHT = "foot_height"
    COMMAND_DISTANCE = "command_distance"


_DEGREES = 57.29577951308232

# Quantity, unit of display, and display units per SI unit.
_TEXTS = {
    InterventionKind.SHAPE: ("joint angle array", "values", 1.0),
    InterventionKind.NOT_FINITE: ("non-finite joint angle", "deg", _DEGREES),
    InterventionKind.TIME_STEP: ("time step", "s", 1.0),
    InterventionKind.TIME_GAP: ("time gap", "s", 1.0),
    InterventionKind.JOINT_LIMIT: ("joint angle", "deg", _DEGREES),
    InterventionKind.JOINT_SPEED: ("joint speed", "deg/s", _DEGREES),
    InterventionKind.JOINT_ACCELERATION: ("joint acceleration", "deg/s^2", _DEGREES),
    InterventionKind.BRAKING_DISTANCE: ("braking distance", "deg", _DEGREES),
    InterventionKind.CONTACTS: ("contact array", "values", 1.0),
    InterventionKind.BODY_POSE: ("body rotation", "values", 1.0),
    InterventionKind.STABILITY_MARGIN: ("stability margin", "mm", 1e3),
    InterventionKind.FOOT_DRAG: ("foot drag", "mm", 1e3),
    InterventionKind.FOOT_HEIGHT: ("height off the ground plane", "mm", 1e3),
    InterventionKind.COMMAND_DISTANCE: ("distance of the command", "deg", _DEGREES),
}


class Violation(NamedTuple):
    """A violated bound, with the leg and the joint as indices.

    Attributes
    ----------
    kind : InterventionKind
        What violates the bound.
    leg, joint : int
        Index of the leg and of the joint; -1 for none.
    value, bound : float
        The value and its bound, in SI units; NaN where there is no number.
    """

    kind: InterventionKind
    leg: int
    joint: int
    value: float
    bound: float

    def named(self, robot: Robot, time: float) -> Intervention:
        """Return the violation with the names of leg and joint.

        Parameters
        ----------
        robot, time : Robot, float
            The robot; time of the guard [s].
        """
        leg = robot.leg_codes[self.leg] if self.leg >= 0 else ""
        joint = JOINTS[self.joint] if self.joint >= 0 else ""
        return Intervention(self.kind, leg, joint, self.value, self.bound, time)


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
    time: float

    @property
    def excess(self) -> float:
        """Distance of the value from its bound."""
        return abs(self.value - self.bound)

    def text(self) -> str:
        """Return the intervention as a line of text, in mm and degrees."""
        quantity, unit, scale = _TEXTS[self.kind]
        place = " ".join(name for name in (self.leg, self.joint) if name)
        value = "" if math.isnan(self.value) else f" {self.value * scale:.4g} {unit}"
        bound = "" if math.isnan(self.bound) else f", bound {self.bound * scale:.4g} {unit}"
        return f"{place + ': ' if place else ''}{quantity}{value}{bound}, at {self.time:.3f} s"


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
        Time of the guard, to which the angles belong: the sum of all valid time steps [s].
    interventions : tuple of Intervention
        Violations of the command: the worst one of each kind.
    """

    angles: Float[np.ndarray, "legs 3"]
    ok: bool
    state: GuardState
    time: float
    interventions: tuple[Intervention, ...]
