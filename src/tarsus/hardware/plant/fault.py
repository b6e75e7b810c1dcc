"""Faults of servos, buses and supply, and how the robot reacts to each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import Self

from tarsus.errors import ServoFaultError
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.representation import represented

__all__ = ["REACTIONS", "FaultKind", "Reaction", "ServoFault"]


class FaultKind(StrEnum):
    """What failed."""

    NO_ANSWER = "no answer"
    CORRUPT = "corrupt answers"
    PORT_GONE = "port gone"
    BROWN_OUT = "brown-out"
    LOW_VOLTAGE = "low voltage"
    STUCK = "stuck"
    OVERHEATED = "overheated"
    OVERLOADED = "overloaded"
    INVALID_COMMAND = "invalid command"


class Reaction(StrEnum):
    """What the robot does after a fault: sit down before its servos are released, or release them at once."""

    SIT = "sit"
    LIMP = "limp"


REACTIONS: Mapping[FaultKind, tuple[Reaction, str]] = MappingProxyType(
    {
        FaultKind.NO_ANSWER: (Reaction.SIT, "Check the cable to this servo, its id and its supply."),
        FaultKind.CORRUPT: (
            Reaction.SIT,
            "Look for a second servo with this id, a loose cable, or cables of servos and data side by side.",
        ),
        FaultKind.PORT_GONE: (Reaction.LIMP, "Check the USB cable and the adapter's supply."),
        FaultKind.BROWN_OUT: (
            Reaction.LIMP,
            "Use a battery and cables that carry the peak current, which tarsus loads gives.",
        ),
        FaultKind.LOW_VOLTAGE: (
            Reaction.SIT,
            "Charge the battery; check its cable, and those from servo to servo, for the current (tarsus loads).",
        ),
        FaultKind.STUCK: (
            Reaction.SIT,
            "Free the joint, and check its gears, its limits in the calibration and that no cable blocks it.",
        ),
        FaultKind.OVERHEATED: (Reaction.SIT, "Let it cool, walk slower or with less payload (tarsus loads)."),
        FaultKind.OVERLOADED: (Reaction.SIT, "Walk with less payload or a higher body (tarsus loads)."),
        FaultKind.INVALID_COMMAND: (Reaction.SIT, "Look for a division by zero in what commands the joints."),
    }
)
"""What the robot does, and what would help, for each kind of fault."""


@represented()
@dataclass(frozen=True, kw_only=True)
class ServoFault:
    """A fault.

    Attributes
    ----------
    kind : FaultKind
        What failed.
    text : str
        What was noticed: the number against its bound.
    joint : str
        Name of the joint; empty for a whole bus or the supply.
    leg, number : int
        Numbers of the leg and the joint; -1 for a whole bus or the supply.
    time : float
        When it was noticed, on the plant's clock [s].
    """

    kind: FaultKind
    text: str
    joint: str = ""
    leg: int = -1
    number: int = -1
    time: float = 0.0

    @classmethod
    def of_joint(
        cls, kind: FaultKind, calibration: Calibration, place: tuple[int, int], *, text: str, time: float
    ) -> Self:
        """Return a fault of one joint.

        Parameters
        ----------
        kind : FaultKind
            What failed.
        calibration : Calibration
            The calibration, which has the joint's name.
        place : tuple of int
            Numbers of the leg and the joint.
        text : str
            What was noticed.
        time : float
            When [s].
        """
        leg, number = place
        joint = calibration.joint_name(leg, number)
        return cls(kind=kind, text=text, joint=joint, leg=leg, number=number, time=time)

    @property
    def reaction(self) -> Reaction:
        """What the robot does."""
        return REACTIONS[self.kind][0]

    @property
    def remedy(self) -> str:
        """What would help."""
        return REACTIONS[self.kind][1]

    def error(self) -> ServoFaultError:
        """Return the error that ends the run."""
        what = f"{self.joint}: {self.kind}" if self.joint else str(self.kind)
        sits = self.reaction is Reaction.SIT
        did = "the robot sits down, then all servos are released" if sits else "all servos are released"
        return ServoFaultError(f"{what}: {self.text}; {did}. {self.remedy}", self)
