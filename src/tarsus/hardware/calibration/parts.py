"""Parts of a calibration: buses, joints, supply, sensors."""

from __future__ import annotations

from dataclasses import dataclass

from tarsus.errors import InputError
from tarsus.hardware.calibration.bus_commands import BusCommands, bus_commands
from tarsus.representation import represented

__all__ = ["BusSettings", "FootSwitches", "JointCalibration", "Mounting", "SupplySettings"]


@represented()
@dataclass(frozen=True, kw_only=True)
class BusSettings:
    """A servo bus or board of one machine.

    Attributes
    ----------
    name : str
        Name, to which joints refer.
    kind : str
        One of `BUS_COMMANDS`.
    port : str
        Serial port or I2C device; empty where it is searched for.
    baud : int, optional
        Bits per second; the kind's default where left out.
    addresses : tuple of int
        Addresses of I2C boards, in the order of their channels; the kind's default where empty.
    """

    name: str
    kind: str
    port: str = ""
    baud: int | None = None
    addresses: tuple[int, ...] = ()

    @property
    def properties(self) -> BusCommands:
        """The kind of bus, with its units and ranges."""
        return bus_commands(self.kind)


@represented()
@dataclass(frozen=True, kw_only=True)
class JointCalibration:
    """How one joint is driven: ``command = zero + direction * scale * angle``; None for what is not known yet.

    Attributes
    ----------
    bus : str
        Name of its bus.
    number : int or None
        Id of the servo, or channel of the board.
    zero : float or None
        Command at a joint angle of 0 [us or ticks]; it may be beyond the limits.
    direction : int or None
        1 where a greater command is a greater joint angle, else -1.
    scale : float or None
        Change of the command with the joint angle, positive [us/rad or ticks/rad].
    limits : (float, float) or None
        Least and greatest command that may be sent [us or ticks].
    soft_limits : (float, float) or None
        Narrower limits of the joint angle on this machine [rad].
    """

    bus: str
    number: int | None = None
    zero: float | None = None
    direction: int | None = None
    scale: float | None = None
    limits: tuple[float, float] | None = None
    soft_limits: tuple[float, float] | None = None

    @property
    def missing(self) -> tuple[str, ...]:
        """What is not known yet."""
        needed = {
            "number": self.number,
            "zero": self.zero,
            "direction": self.direction,
            "scale": self.scale,
            "limits": self.limits,
        }
        return tuple(name for name, value in needed.items() if value is None)

    @property
    def slope(self) -> float:
        """Change of the command with the joint angle, with the sign [us/rad or ticks/rad].

        Raises
        ------
        InputError
            If direction or scale is not known yet.
        """
        if self.direction is None or self.scale is None:
            raise InputError("the joint's direction and scale must be known")
        return self.direction * self.scale

    def command(self, angle: float) -> float:
        """Return the command of a joint angle, not limited [us or ticks].

        Parameters
        ----------
        angle : float
            Joint angle [rad].

        Raises
        ------
        InputError
            If zero, direction or scale is not known yet.
        """
        if self.zero is None:
            raise InputError("the joint's zero must be known")
        return self.zero + self.slope * angle


@represented()
@dataclass(frozen=True, kw_only=True)
class SupplySettings:
    """The supply of the servos.

    Attributes
    ----------
    voltage : float
        Nominal voltage [V].
    least_voltage : float
        Voltage below which the servos must not run [V].
    greatest_current : float or None
        Current that it can deliver [A].
    """

    voltage: float
    least_voltage: float
    greatest_current: float | None = None


@represented()
@dataclass(frozen=True, kw_only=True)
class FootSwitches:
    """Inputs of the foot switches.

    Attributes
    ----------
    bus : str
        Name of the bus whose board has the inputs.
    inputs : tuple of (int or None)
        Number of the input of each leg; None for a leg without a switch.
    closed : bool
        Whether an input whose foot is on the ground is high; False for switches to ground with a pull-up.
    thresholds : tuple of float
        Voltage above which the input of each leg is high, for sensors of force on inputs that measure it [V]; half of
        the highest voltage where empty.
    hysteresis : float
        By how much the voltage must pass the threshold, half of it to either side, before an input changes [V].
    """

    bus: str
    inputs: tuple[int | None, ...]
    closed: bool = True
    thresholds: tuple[float, ...] = ()
    hysteresis: float = 0.2


@represented()
@dataclass(frozen=True, kw_only=True)
class Mounting:
    """An inertial sensor on the body.

    Attributes
    ----------
    port : str
        Serial port on which it sends its attitude.
    baud : int
        Bits per second.
    rpy : tuple of float
        Roll, pitch and yaw of the sensor in B [rad].
    """

    port: str
    baud: int = 115200
    rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)
