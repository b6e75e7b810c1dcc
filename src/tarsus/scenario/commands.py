"""The commands of a scenario, a class for each kind; values in SI."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar, Literal

from tarsus.scenario.quantities import quantity
from tarsus.scenario.timed_command import TimedCommand

__all__ = [
    "COMMANDS",
    "BodyHeight",
    "CycleTime",
    "Fold",
    "FootRelease",
    "FootTarget",
    "FootVelocity",
    "Force",
    "GaitChange",
    "Ground",
    "MoveBody",
    "PowerOff",
    "Sit",
    "StanceWidth",
    "StandUp",
    "Stop",
    "Sway",
    "SwingHeight",
    "Tilt",
    "Walk",
]

_WIDE, _FAST, _TURN = 1000, 10_000, 3600


@dataclass(frozen=True, kw_only=True)
class Walk(TimedCommand):
    """Walk with a twist: vx forward, vy to the left [m/s], turn counter-clockwise [rad/s]."""

    word: ClassVar[str] = "walk"
    vx: float = quantity("mm_s", "forward", low=-_FAST, high=_FAST)
    vy: float = quantity("mm_s", "to the left", low=-_FAST, high=_FAST)
    turn: float = quantity("deg_s", "counter-clockwise", low=-_TURN, high=_TURN)


@dataclass(frozen=True, kw_only=True)
class Stop(TimedCommand):
    """Stop, every foot at its rest foothold."""

    word: ClassVar[str] = "stop"


@dataclass(frozen=True, kw_only=True)
class GaitChange(TimedCommand):
    """Change the gait."""

    word: ClassVar[str] = "gait"
    gait: str


@dataclass(frozen=True, kw_only=True)
class _SixWays(TimedCommand):
    """Base of commands with the six coordinates of a body pose [m], [rad]."""

    x: float = quantity("mm", "forward", low=-_WIDE, high=_WIDE)
    y: float = quantity("mm", "to the left", low=-_WIDE, high=_WIDE)
    z: float = quantity("mm", "up", low=-_WIDE, high=_WIDE)
    roll: float = quantity("deg", "left side up", low=-90, high=90)
    pitch: float = quantity("deg", "front down", low=-90, high=90)
    yaw: float = quantity("deg", "front to the left", low=-90, high=90)


@dataclass(frozen=True, kw_only=True)
class MoveBody(_SixWays):
    """Set the body pose over the feet, relative to standing level [m], [rad]; all 0 is level."""

    word: ClassVar[str] = "body"


@dataclass(frozen=True, kw_only=True)
class BodyHeight(TimedCommand):
    """Set the height of the body's origin over the ground [m]."""

    word: ClassVar[str] = "body_height"
    body_height: float = quantity("mm", "height of the body's origin", low=0.001, high=_WIDE, needed=True)


@dataclass(frozen=True, kw_only=True)
class SwingHeight(TimedCommand):
    """Set the height of swinging feet [m]."""

    word: ClassVar[str] = "swing_height"
    swing_height: float = quantity("mm", "height of a swinging foot", low=0, high=_WIDE, needed=True)


@dataclass(frozen=True, kw_only=True)
class StanceWidth(TimedCommand):
    """Set how much farther out than the default stance the feet rest [m]."""

    word: ClassVar[str] = "stance_width"
    stance_width: float = quantity("mm", "farther out", low=-_WIDE, high=_WIDE, needed=True)


@dataclass(frozen=True, kw_only=True)
class CycleTime(TimedCommand):
    """Set the duration of a gait cycle [s]; "auto" for the one with the highest speed."""

    word: ClassVar[str] = "cycle_time"
    cycle_time: float | Literal["auto"] = quantity(
        "s", "duration of a cycle", low=0.01, high=60, needed=True, words=("auto",)
    )


@dataclass(frozen=True, kw_only=True)
class FootTarget(TimedCommand):
    """Take a leg out of the gait and move its foot to a point in the heading frame [m]."""

    word: ClassVar[str] = "foot_target"
    leg: str
    x: float = quantity("mm", "forward", low=-_WIDE, high=_WIDE, needed=True)
    y: float = quantity("mm", "to the left", low=-_WIDE, high=_WIDE, needed=True)
    z: float = quantity("mm", "over the ground", low=-_WIDE, high=_WIDE, needed=True)


@dataclass(frozen=True, kw_only=True)
class FootVelocity(TimedCommand):
    """Take a leg out of the gait and move its foot at a velocity in the heading frame [m/s]; all 0 holds it."""

    word: ClassVar[str] = "foot_velocity"
    leg: str
    vx: float = quantity("mm_s", "forward", low=-_WIDE, high=_WIDE)
    vy: float = quantity("mm_s", "to the left", low=-_WIDE, high=_WIDE)
    vz: float = quantity("mm_s", "up", low=-_WIDE, high=_WIDE)


@dataclass(frozen=True, kw_only=True)
class FootRelease(TimedCommand):
    """Put a leg back into the gait."""

    word: ClassVar[str] = "foot_release"
    leg: str


@dataclass(frozen=True, kw_only=True)
class Sway(_SixWays):
    """Move the body periodically with the steps, with these amplitudes [m], [rad]; all 0 ends it."""

    word: ClassVar[str] = "sway"


@dataclass(frozen=True, kw_only=True)
class StandUp(TimedCommand):
    """Stand up from the belly."""

    word: ClassVar[str] = "stand_up"


@dataclass(frozen=True, kw_only=True)
class Sit(TimedCommand):
    """Stop, and lower the body until the belly rests on the ground."""

    word: ClassVar[str] = "sit"


@dataclass(frozen=True, kw_only=True)
class Fold(TimedCommand):
    """Fold the legs on the belly; a robot that stands sits down first."""

    word: ClassVar[str] = "fold"


@dataclass(frozen=True, kw_only=True)
class PowerOff(TimedCommand):
    """Release the joints in the order in which the least falls; the robot must lie on its belly."""

    word: ClassVar[str] = "power_off"


@dataclass(frozen=True, kw_only=True)
class Ground(TimedCommand):
    """Set the measured height of the ground under a foot [m]: a test of ground feedback."""

    word: ClassVar[str] = "ground"
    leg: str
    height: float = quantity("mm", "over flat ground", low=-_WIDE, high=_WIDE, needed=True)


@dataclass(frozen=True, kw_only=True)
class Tilt(TimedCommand):
    """Set the measured tilt of the ground [rad]: a test of levelling."""

    word: ClassVar[str] = "tilt"
    roll: float = quantity("deg", "left side up", low=-90, high=90)
    pitch: float = quantity("deg", "front down", low=-90, high=90)


@dataclass(frozen=True, kw_only=True)
class Force(TimedCommand):
    """Set the measured vertical force on a foot beyond its share of the weight [N]: a test of admittance."""

    word: ClassVar[str] = "force"
    leg: str
    force: float = quantity("n", "beyond its share of the weight", low=-_WIDE, high=_WIDE, needed=True)


_KINDS: tuple[type[TimedCommand], ...] = (
    *(
        StandUp,
        Walk,
        Stop,
        GaitChange,
        MoveBody,
        BodyHeight,
        SwingHeight,
        StanceWidth,
        CycleTime,
        FootTarget,
        FootVelocity,
        FootRelease,
    ),
    *(Sway, Ground, Tilt, Force, Sit, Fold, PowerOff),
)

COMMANDS: Mapping[str, type[TimedCommand]] = MappingProxyType({kind.word: kind for kind in _KINDS})
"""Every kind of command by its word."""
