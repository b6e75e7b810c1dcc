"""Condition of the body, from contacts and attitude: in the air, or fallen."""

from __future__ import annotations

import math

from tarsus.control.limitation import Limitation, LimitationKind

__all__ = ["BodyCondition"]

# Time without any contact after which the robot is in the air, and time its feet must hold it to count as put down [s].
_IN_AIR, _PUT_DOWN = 0.5, 0.5
# Tilt above which the robot has fallen, and below which it is upright again [rad]; how long either must last [s].
_FALLEN, _UPRIGHT, _LASTS = math.radians(45.0), math.radians(30.0), 0.2


class BodyCondition:
    """Tells whether the robot is held in the air or has fallen; in either case it does not step.

    Attributes
    ----------
    airborne : float
        Time since any foot last touched the ground [s]; 0 where no contact is measured.
    tilt : float
        Angle of the body against gravity, as measured last [rad].
    fallen, carried : bool
        Whether the robot has fallen onto its side or back; whether it has, is in the air, or is being put down.
    """

    def __init__(self) -> None:
        self.airborne = self.tilt = self._time = self._held = 0.0
        self.fallen = self.carried = False

    @property
    def in_air(self) -> bool:
        """Whether the robot is held in the air, where its feet do not search for the ground."""
        return self.airborne > _IN_AIR

    def step(self, touches: bool, tilt: float | None, dt: float, *, held: float, lifted: bool = False) -> None:
        """Take in the contacts and the tilt of a tick.

        Parameters
        ----------
        touches : bool
            Whether any foot touches the ground; True where nothing is known.
        tilt : float or None
            Angle of the body against gravity [rad]; None where it is not measured.
        dt, held, lifted : float, float, bool
            Time since the last tick [s]; how surely the feet in contact hold the robot, 0 to 1; whether its legs have
            ceased to bear it, as joint angles tell.
        """
        self.airborne = 0.0 if touches else self.airborne + dt
        self._held = self._held + held * dt if held else 0.0
        if tilt is not None:
            self.tilt, changes = tilt, tilt < _UPRIGHT if self.fallen else tilt > _FALLEN
            self._time = self._time + dt if changes else 0.0
        if self._time > _LASTS:
            self.fallen, self._time = not self.fallen, 0.0
        self._held *= not lifted
        self.carried = self.in_air or self.fallen or lifted or (self.carried and self._held < _PUT_DOWN)

    @property
    def limitations(self) -> list[Limitation]:
        """Why the robot does not step."""
        found = []
        if self.in_air:
            found.append(Limitation(kind=LimitationKind.GROUND, cause="no foot touches it: the robot is in the air"))
        if self.fallen:
            kind, cause = LimitationKind.ATTITUDE, "the robot has fallen"
            found.append(Limitation(kind=kind, cause=cause, asked=0.0, granted=self.tilt, bound=_FALLEN))
        return found
