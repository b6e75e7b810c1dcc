"""Settings of a servo plant: how it starts, what it takes for a fault, when it is derated."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from tarsus.errors import InputError
from tarsus.representation import represented

__all__ = ["PlantSettings"]


@represented()
@dataclass(frozen=True, kw_only=True)
class PlantSettings:
    """Bounds of a servo plant, in SI units.

    Attributes
    ----------
    start_speed : float
        Greatest joint speed of the soft start [rad/s].
    start_interval : float
        Time between the servos of a leg that get their first pulse, where positions are not measured [s].
    longest_tick : float
        Longest tick; joints move no farther than in this time [s].
    timeout : float
        Longest time until an answer begins [s]; three of them are less than the time in which a fault must be noticed.
    silence : float
        How long a servo may give no valid answer [s].
    least_failures, least_doubt : int, float
        How many answers in a row must have failed, and for how long [s].
    delay : float
        Time after which a servo begins to follow a command [s].
    stuck_window : float
        How long a joint that is commanded to move must stand still to be taken for stuck [s].
    stuck_angle : float
        How far it must be commanded to move in that time, beyond one and a half times the dead zone [rad].
    dead_zone, widest_dead_zone : float
        How far commands move while healthy joints stand still, before that is measured, and at most [rad].
    lag : float
        How far a joint may be behind its command, in any case [rad].
    warm, hot : float
        Temperatures from which the robot walks slower, and at which it sits down [deg C].
    heavy_load : float
        Share of the full drive above which a load is too great if it lasts for longer than `heavy_time`.
    heavy_time : float
        How long a load may be above `heavy_load` [s].
    low_time : float
        How long the voltage may be below its least value [s].
    brown_out : float
        Share of the least voltage at which a brown-out is suspected at once.
    watchdog : float
        Time after which servos or board stop by themselves, where they can; longer than a controller takes to plan how
        it stands up [s].
    """

    start_speed: float = math.radians(45)
    start_interval: float = 0.08
    longest_tick: float = 0.05
    timeout: float = 0.02
    silence: float = 0.06
    least_failures: int = 2
    least_doubt: float = 0.015
    delay: float = 0.03
    stuck_window: float = 0.08
    stuck_angle: float = math.radians(0.8)
    dead_zone: float = math.radians(3)
    widest_dead_zone: float = math.radians(6)
    lag: float = math.radians(25)
    warm: float = 60.0
    hot: float = 70.0
    heavy_load: float = 0.95
    heavy_time: float = 1.0
    low_time: float = 0.5
    brown_out: float = 0.85
    watchdog: float = 1.5

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not 0 < value < math.inf:
                raise InputError(f"{field.name} of a servo plant is {value}; it must be a finite number greater than 0")
        if self.hot <= self.warm:
            raise InputError(f"hot is {self.hot:g} deg C, not above warm, {self.warm:g} deg C")
