"""A servo: what a joint's motor can do, as its maker or a measurement says."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Servo"]


@dataclass(frozen=True, kw_only=True)
class Servo:
    """One model of servo; what its source does not give is None.

    Attributes
    ----------
    name : str
        The model, as in the catalogue.
    stall_torque : float
        Torque at which it stops [N m], at `torque_at` volts.
    torque_at : float or None
        Supply for the stall torque [V].
    no_load_speed : float or None
        Speed without load [rad/s], at `speed_at` volts.
    speed_at : float or None
        Supply for the speed [V].
    stall_current : float or None
        Current when stalled [A].
    rated_torque : float or None
        Torque that the maker rates for lasting use [N m].
    mass : float or None
        Mass [kg].
    supply : tuple of float or None
        Lowest and highest supply [V].
    travel : float or None
        Range of the output shaft [rad].
    maker, control, gear, feedback : str
        Who makes it, how it is commanded, of what its gears are, what it reports.
    confidence, source, note : str
        How sure the numbers are (A read at the maker, B read in a secondary copy, C mostly general knowledge),
        where they come from, and what is known beside them.
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
