"""The mechanics, heat and current of an emulated servo."""

from __future__ import annotations

import math
from dataclasses import dataclass

from tarsus.representation import represented

__all__ = ["EmulatedServo", "ServoTraits"]

# Position error at which the motor gets its full drive [turns].
_FULL_DRIVE = 6.0 / 360.0
# Final rise of temperature at full drive [K]; thermal time constant of the case [s].
_HEATING, _HEAT_TIME = 90.0, 90.0


@represented("speed", "play", "lowest", "highest")
@dataclass(frozen=True, kw_only=True)
class ServoTraits:
    """What an emulated servo is like, in the unit of its bus.

    Attributes
    ----------
    per_turn : float
        How many units a turn has.
    lowest, highest : float
        Ends of its travel.
    speed : float
        Highest speed at the nominal voltage [units/s].
    play : float
        Gear play: how far the shaft stays behind the motor when the motor reverses [units].
    load : float
        Share of the full drive that holding the robot takes.
    stall_current : float
        Current at full drive [A].
    idle_current : float
        Current without torque [A].
    ambient : float
        Temperature of the air [deg C].
    hottest : float
        Temperature at which the servo lets go [deg C].
    """

    per_turn: float
    lowest: float
    highest: float
    speed: float
    play: float
    load: float = 0.15
    stall_current: float = 2.4
    idle_current: float = 0.01
    ambient: float = 25.0
    hottest: float = 75.0


@represented("position", "goal", "torque", "temperature")
class EmulatedServo:
    """A servo: a motor that follows its goal with limited speed, and a shaft behind gears with play.

    Parameters
    ----------
    traits : ServoTraits
        What it is like.
    position : float, optional
        Where its shaft is at first; by default in the middle of its travel.

    Attributes
    ----------
    goal : float
        Where it is told to go.
    torque : bool
        Whether the motor is driven.
    speed_limit : float
        Highest speed that it was told [units/s].
    torque_limit : float
        Highest drive that it was told, 0 to 1.
    external : float
        Load by what is outside, beside the robot's own: share of the full drive.
    stuck : bool
        Whether the shaft is jammed.
    temperature : float
        Temperature [deg C].
    overheated : bool
        Whether it let go because it was too hot.
    """

    def __init__(self, traits: ServoTraits, position: float | None = None) -> None:
        middle = (traits.lowest + traits.highest) / 2
        self.traits = traits
        self._motor = self._shaft = self.goal = middle if position is None else position
        self.torque, self.stuck, self.overheated = False, False, False
        self.speed_limit, self.torque_limit, self.external = math.inf, 1.0, 0.0
        self.temperature = traits.ambient
        self._time: float | None = None
        self._speed = 0.0

    @property
    def position(self) -> float:
        """Angle of the shaft, in the unit of the bus."""
        return self._shaft

    @property
    def speed(self) -> float:
        """Speed of the motor [units/s]."""
        return self._speed

    @property
    def load(self) -> float:
        """Drive of the motor, -1 to 1."""
        if not self.torque:
            return 0.0
        error = self.goal - self._motor
        drive = error / (_FULL_DRIVE * self.traits.per_turn) + math.copysign(self.traits.load + self.external, error)
        return max(-self.torque_limit, min(drive, self.torque_limit))

    @property
    def current(self) -> float:
        """Current [A]."""
        return self.traits.idle_current + self.traits.stall_current * abs(self.load)

    def place(self, position: float) -> None:
        """Turn the shaft by hand.

        Parameters
        ----------
        position : float
            Where it is afterwards.
        """
        self._motor = self._shaft = position

    def halt(self) -> None:
        """Stop where the motor is, and hold."""
        self.goal = self._motor

    def advance(self, now: float, supply: float) -> None:
        """Move on to a time.

        Parameters
        ----------
        now : float
            The time [s].
        supply : float
            Voltage, as a share of the nominal one.
        """
        dt = 0.0 if self._time is None else max(now - self._time, 0.0)
        self._time = now
        if dt == 0.0:
            return
        traits, before = self.traits, self._motor
        if self.torque and not self.stuck and self.external < self.torque_limit:
            reach = min(traits.speed * supply, self.speed_limit) * dt
            goal = min(max(self.goal, traits.lowest), traits.highest)
            self._motor += min(max(goal - self._motor, -reach), reach)
        self._speed = (self._motor - before) / dt
        self._shaft = min(max(self._shaft, self._motor - traits.play / 2), self._motor + traits.play / 2)
        settled = traits.ambient + _HEATING * self.load**2
        self.temperature = settled + (self.temperature - settled) * math.exp(-dt / _HEAT_TIME)
        if self.temperature >= traits.hottest:
            self.overheated, self.torque = True, False

    def reset(self) -> None:
        """Lose torque, goal and limits, as after a failure of the supply."""
        self.torque, self.overheated = False, False
        self.goal, self.speed_limit, self.torque_limit = self._motor, math.inf, 1.0
