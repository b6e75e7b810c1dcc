"""Servos: data of a model from its maker or from measurements."""

from __future__ import annotations

from dataclasses import dataclass

from tarsus.errors import InputError
from tarsus.representation import represented

__all__ = ["Servo"]


@represented()
@dataclass(frozen=True, kw_only=True)
class Servo:
    """A servo model; data that its source does not give are None.

    Attributes
    ----------
    name : str
        Name of the model, as in the catalogue.
    stall_torque : float
        Stall torque [N m] at a supply of `torque_at`.
    torque_at : float or None
        Supply voltage of the stall torque [V].
    no_load_speed : float or None
        No-load speed [rad/s] at a supply of `speed_at`.
    speed_at : float or None
        Supply voltage of the no-load speed [V].
    stall_current : float or None
        Stall current [A].
    rated_torque : float or None
        Rated continuous torque [N m].
    mass : float or None
        Mass [kg].
    supply : tuple of float or None
        Least and greatest supply voltage [V].
    travel : float or None
        Range of the output shaft [rad].
    maker, control, gear, feedback : str
        Manufacturer, command interface, gear material, feedback.
    confidence, source, note : str
        Confidence (A from the manufacturer, B from a secondary copy, C mostly general knowledge), source and remarks.

    Raises
    ------
    InputError
        If the stall torque or the no-load speed is not greater than 0.
    """

    name: str
    stall_torque: float
    torque_at: float | None = None
    no_load_speed: float | None = None
    speed_at: float | None = None
    stall_current: float | None = None
    rated_torque: float | None = None
    mass: float | None = None
    supply: tuple[float, float] | None = None
    travel: float | None = None
    maker: str = ""
    control: str = ""
    gear: str = ""
    feedback: str = ""
    confidence: str = ""
    source: str = ""
    note: str = ""

    def __post_init__(self) -> None:
        for name, value, unit in (
            ("stall_torque", self.stall_torque, "N m"),
            ("no_load_speed", self.no_load_speed, "rad/s"),
        ):
            if value is not None and value <= 0:
                unknown = "" if name == "stall_torque" else "; None where unknown"
                raise InputError(f"servo {self.name!r}: {name} is {value:g} {unit}; it must be greater than 0{unknown}")

    @property
    def buses(self) -> frozenset[str]:
        """Names of the buses on which the servo runs; servos with a name in common can share a bus."""
        name, _, other = self.control.partition(" (")
        if name.startswith("Dynamixel"):
            return frozenset(f"Dynamixel {number}.0" for number in (1, 2) if f"P{number}" in self.control)
        buses = {"PWM" if name.startswith("PWM") else name.removesuffix(" bus").removesuffix(" ASCII")}
        return frozenset(buses | ({"PWM"} if "PWM" in other else set())) - {""}
