"""What a bus of servos can do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from tarsus.representation import represented

__all__ = ["Capabilities"]


@represented()
@dataclass(frozen=True, kw_only=True)
class Capabilities:
    """What a bus can do; methods for what a bus cannot do have no effect.

    Attributes
    ----------
    unit : str
        Unit of goals and positions: ``"us"`` for pulse widths, ``"tick"`` for steps of a servo's position sensor.
    lowest, highest : float
        Range of goals, in `unit`.
    per_turn : float or None
        How many units a turn has; None if that depends on the servo.
    ids : range
        Ids or channels that a servo may have.
    ping : str
        Who answers: each ``"servo"``, only the ``"board"``, or ``"none"``.
    positions : bool
        Whether the angles of the servos' shafts are measured.
    telemetry : frozenset of str
        What else is measured: names of fields of `Telemetry`.
    torque_off : str
        How a servo is released: ``"torque"`` for a command of its own, ``"pulses"`` if the pulses end (analogue servos
        then let go, many digital ones hold), ``"none"``.
    limits, speed_limit, torque_limit : bool
        Whether a servo or the board takes limits of goals, of speed and of torque.
    watchdog : tuple of float, or None
        Shortest and longest time after which servos or board stop by themselves if no packet comes [s].
    watchdog_action : str
        What they do then: ``"hold"`` where they are, or ``"release"``.
    synchronous : bool
        Whether the goals of all servos take effect at the same time.
    """

    unit: Literal["us", "tick"]
    lowest: float
    highest: float
    ids: range
    per_turn: float | None = None
    ping: Literal["servo", "board", "none"] = "none"
    positions: bool = False
    telemetry: frozenset[str] = frozenset()
    torque_off: Literal["torque", "pulses", "none"] = "none"
    limits: bool = False
    speed_limit: bool = False
    torque_limit: bool = False
    watchdog: tuple[float, float] | None = None
    watchdog_action: Literal["hold", "release", "none"] = "none"
    synchronous: bool = True
