"""The commands of a scenario: what the robot may be told at a moment. Values in SI, each a class of its own."""

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
    """Walk: vx forward, vy to the left [m/s], turn counter-clockwise [rad/s]; until told otherwise."""

    word: ClassVar[str] = "walk"
    vx: float = quantity("mm_s", "forward", low=-_FAST, high=_FAST)
    vy: float = quantity("mm_s", "to the left", low=-_FAST, high=_FAST)
    turn: float = quantity("deg_s", "counter-clockwise", low=-_TURN, high=_TURN)


@dataclass(frozen=True, kw_only=True)
class Stop(TimedCommand):
    """Come to a stop, every foot at its rest foothold."""

    word: ClassVar[str] = "stop"


@dataclass(frozen=True, kw_only=True)
class GaitChange(TimedCommand):
    """Go over to another gait."""

    word: ClassVar[str] = "gait"
    gait: str


@dataclass(frozen=True, kw_only=True)
class _SixWays(TimedCommand):
    """The six ways in which a body can be moved [m] and turned [rad]."""

    x: float = quantity("mm", "forward", low=-_WIDE, high=_WIDE)
    y: float = quantity("mm", "to the left", low=-_WIDE, high=_WIDE)
    z: float = quantity("mm", "up", low=-_WIDE, high=_WIDE)
    roll: float = quantity("deg", "left side up", low=-90, high=90)
    pitch: float = quantity("deg", "front down", low=-90, high=90)
    yaw: float = quantity("deg", "front to the left", low=-90, high=90)


@dataclass(frozen=True, kw_only=True)
class MoveBody(_SixWays):
    """Move [m] and turn [rad] the body over its feet, against standing level; all 0 is level again."""

    word: ClassVar[str] = "body"


@dataclass(frozen=True, kw_only=True)
class BodyHeight(TimedCommand):
    """Carry the body's origin so high over the ground [m]."""

    word: ClassVar[str] = "body_height"
    body_height: float = quantity("mm", "height of the body's origin", low=0.001, high=_WIDE, needed=True)


@dataclass(frozen=True, kw_only=True)
class SwingHeight(TimedCommand):
    """Lift swinging feet so high [m]."""

    word: ClassVar[str] = "swing_height"
    swing_height: float = quantity("mm", "of a swinging foot", low=0, high=_WIDE, needed=True)


@dataclass(frozen=True, kw_only=True)
class StanceWidth(TimedCommand):
    """Set the feet so much farther out than usual [m]."""

    word: ClassVar[str] = "stance_width"
    stance_width: float = quantity("mm", "farther out", low=-_WIDE, high=_WIDE, needed=True)


@dataclass(frozen=True, kw_only=True)
class CycleTime(TimedCommand):
    """Step with cycles of this duration [s]; "auto" for the one that gets the robot farthest."""

    word: ClassVar[str] = "cycle_time"
    cycle_time: float | Literal["auto"] = quantity("s", "of a cycle", low=0.01, high=60, needed=True, words=("auto",))


@dataclass(frozen=True, kw_only=True)
class FootTarget(TimedCommand):
    """Take a leg out of the gait, and move its foot to a point in the heading frame [m]."""

    word: ClassVar[str] = "foot_target"
    leg: str
    x: float = quantity("mm", "forward", low=-_WIDE, high=_WIDE, needed=True)
    y: float = quantity("mm", "to the left", low=-_WIDE, high=_WIDE, needed=True)
    z: float = quantity("mm", "over the ground", low=-_WIDE, high=_WIDE, needed=True)


@dataclass(frozen=True, kw_only=True)
class FootVelocity(TimedCommand):
    """Take a leg out of the gait, and move its foot at a speed in the heading frame [m/s]; all 0 holds it there."""

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
    """Move the body to and fro with the steps, by these amplitudes [m], [rad]; all 0 ends it."""

    word: ClassVar[str] = "sway"


@dataclass(frozen=True, kw_only=True)
class StandUp(TimedCommand):
    """Get up from where it lies."""

    word: ClassVar[str] = "stand_up"


@dataclass(frozen=True, kw_only=True)
class Sit(TimedCommand):
    """Come to a stop, and go down until the belly rests on the ground."""

    word: ClassVar[str] = "sit"


@dataclass(frozen=True, kw_only=True)
class Fold(TimedCommand):
    """Draw the legs in; the robot must sit."""

    word: ClassVar[str] = "fold"


@dataclass(frozen=True, kw_only=True)
class PowerOff(TimedCommand):
    """Release the joints, in the order in which least falls; the robot must sit."""

    word: ClassVar[str] = "power_off"


@dataclass(frozen=True, kw_only=True)
class Ground(TimedCommand):
    """Feel the ground under a leg higher (early) or lower (late) than it is by so much [m]: a test of its senses."""

    word: ClassVar[str] = "ground"
    leg: str
    height: float = quantity("mm", "over flat ground", low=-_WIDE, high=_WIDE, needed=True)


@dataclass(frozen=True, kw_only=True)
class Tilt(TimedCommand):
    """Feel the ground tilted by so much [rad]: a test of its senses."""

    word: ClassVar[str] = "tilt"
    roll: float = quantity("deg", "left side up", low=-90, high=90)
    pitch: float = quantity("deg", "front down", low=-90, high=90)


@dataclass(frozen=True, kw_only=True)
class Force(TimedCommand):
    """Feel the ground push a foot up so much more than its share of the weight [N]: a test of its senses."""

    word: ClassVar[str] = "force"
    leg: str
    force: float = quantity("n", "more than its share", low=-_WIDE, high=_WIDE, needed=True)


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
"""Every command by its word."""
