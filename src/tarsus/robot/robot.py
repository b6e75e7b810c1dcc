"""The robot: a value of arrays in SI units, a single robot or a batch of designs."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from tarsus.arrays import Array, broadcast_shapes, namespace
from tarsus.errors import InputError, MissingDataError, UnknownNameError
from tarsus.representation import Rows, represented
from tarsus.robot.about import GaitDefaults, Source
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.plain_name import require_plain_name
from tarsus.robot.preset_names import preset_names
from tarsus.robot.servo import Servo
from tarsus.robot.shape import JOINTS, OPTIONAL, TAILS, locked

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = [
    "JOINTS",
    "GaitDefaults",
    "Robot",
    "Source",
    "masses_advice",
    "require_leg_number",
    "require_robot",
    "stack_robots",
]


@represented("name", "leg_codes", "batch_shape", "coxa", "femur", "tibia", "limits", "body_mass", "link_mass", "gait")
@dataclass(frozen=True, kw_only=True, eq=False)
class Robot:
    """A legged robot, or a batch of designs: every array may have leading batch axes, which broadcast.

    NumPy arrays and sequences are copied and locked; arrays of other libraries are kept, so that a design can be
    differentiated (``robot.replace(femur=traced_array)``).

    Attributes
    ----------
    name : str
        Name of the robot.
    leg_names : tuple of str
        Names of the legs, counter-clockwise from the front left.
    mount_position : array, shape (..., legs, 3)
        Positions of the coxa axes in the body frame B [m].
    mount_yaw : array, shape (..., legs)
        Direction of each leg in B, counter-clockwise from x [rad].
    coxa, femur, tibia : array, shape (..., legs)
        Lengths of the links [m].
    femur_axis_offset : array, shape (..., legs, 2)
        Offset of the femur axis from the coxa axis, sideways and vertical [m].
    limits : array, shape (..., legs, 3, 2)
        Lower and upper limit of each joint [rad].
    foot_radius : array, shape (..., legs)
        Radius of the spherical foot, for pictures and for the least distance between feet [m].
    link_com : array, shape (..., legs, 3)
        Distance of each link's centre of mass from its inner joint, along the link [m].
    link_mass : array, shape (..., legs, 3), or None
        Masses of the links [kg]; None where unknown.
    body_mass : array, shape (...), or None
        Mass of the body [kg]; None where unknown.
    body_com : array, shape (..., 3)
        Centre of mass of the body in B [m].
    body_size : array, shape (..., 3), or None
        Size of the body's box, centred on B's origin [m]; None for the flat polygon of the coxa axes.
    servos : tuple of tuple of (Servo or None)
        The servo of each leg's joints, ``servos[leg][joint]``; None where unknown.
    gait : GaitDefaults
        Default settings of its walks.
    sources : tuple of Source
        Sources of its numbers.
    """

    name: str
    leg_names: tuple[str, ...]
    mount_position: Float[Array, "*#batch legs 3"]
    mount_yaw: Float[Array, "*#batch legs"]
    coxa: Float[Array, "*#batch legs"]
    femur: Float[Array, "*#batch legs"]
    tibia: Float[Array, "*#batch legs"]
    limits: Float[Array, "*#batch legs 3 2"]
    femur_axis_offset: Float[Array, "*#batch legs 2"] = None
    foot_radius: Float[Array, "*#batch legs"] = None
    link_com: Float[Array, "*#batch legs 3"] = None
    link_mass: Float[Array, "*#batch legs 3"] | None = None
    body_mass: Float[Array, "*#batch"] | None = None
    body_com: Float[Array, "*#batch 3"] = None
    body_size: Float[Array, "*#batch 3"] | None = None
    servos: tuple[tuple[Servo | None, ...], ...] = ()
    gait: GaitDefaults = field(default_factory=GaitDefaults)
    sources: tuple[Source, ...] = ()

    def __post_init__(self) -> None:
        require_plain_name("name of the robot", self.name)
        for leg_name in self.leg_names:
            require_plain_name(f"{self.name}: name of a leg", leg_name)
        fill = {"femur_axis_offset": (self.legs, 2), "foot_radius": (self.legs,), "body_com": (3,)}
        for name in ("mount_position", "mount_yaw", "coxa", "femur", "tibia", "limits"):
            self._lock(name, getattr(self, name))
        for name, shape in fill.items():
            value = getattr(self, name)
            self._lock(name, np.zeros(shape) if value is None else value)
        if self.link_com is None:
            lengths = (self.coxa, self.femur, self.tibia)
            xp = namespace(*lengths)
            broadcast_shapes(f"robot {self.name!r}", *(tuple(length.shape) for length in lengths))
            lengths = xp.broadcast_arrays(*lengths)
            object.__setattr__(self, "link_com", xp.stack(lengths, axis=-1) / 2)
        for name in ("link_com", *OPTIONAL):
            self._lock(name, getattr(self, name))
        object.__setattr__(self, "leg_names", tuple(self.leg_names))
        servos = tuple(tuple(row) for row in self.servos) or ((None,) * 3,) * self.legs
        object.__setattr__(self, "servos", servos)
        if [len(row) for row in servos] != [3] * self.legs:
            raise InputError(f"{self.name}: servos must have three entries for each of the {self.legs} legs")
        _ = self.batch_shape  # refuses batch axes that don't broadcast

    def _lock(self, name: str, value: Float[Array, "..."] | None) -> None:
        if value is not None:
            object.__setattr__(self, name, locked(name, value, legs=self.legs, robot=self.name))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Robot):
            return NotImplemented
        for spec in dataclasses.fields(self):
            mine, theirs = getattr(self, spec.name), getattr(other, spec.name)
            if spec.name in TAILS:
                if not np.array_equal(np.asarray(mine), np.asarray(theirs)):
                    return False
            elif mine is not theirs and mine != theirs:
                return False
        return True

    def __hash__(self) -> int:
        return hash((self.name, self.leg_names))

    def _rows(self) -> Rows:
        """Return the legs of a single robot."""
        if self.batch_shape or not isinstance(self.femur, np.ndarray):
            return ()
        position, yaw = (self.mount_position * 1000).round(1) + 0.0, np.degrees(self.mount_yaw).round(1) + 0.0
        limits = np.degrees(self.limits)
        links = {"coxa [mm]": self.coxa, "femur [mm]": self.femur, "tibia [mm]": self.tibia}
        return [
            {"leg": name}
            | {f"{axis} [mm]": f"{position[leg, i]:.1f}" for i, axis in enumerate("xyz")}
            | {"yaw [deg]": f"{yaw[leg]:.1f}"}
            | {link: f"{length[leg] * 1000:.1f}" for link, length in links.items()}
            | {f"{j} [deg]": f"{limits[leg, i, 0]:.0f} to {limits[leg, i, 1]:.0f}" for i, j in enumerate(JOINTS)}
            for leg, name in enumerate(self.leg_names)
        ]

    @property
    def legs(self) -> int:
        """Number of legs."""
        return len(self.leg_names)

    @cached_property
    def leg_codes(self) -> tuple[str, ...]:
        """Short names of the legs: ``LF`` for ``"front left"``; the full names where these are not unique."""
        words = [name.split() for name in self.leg_names]
        codes = tuple((w[1][0] + w[0][0]).upper() if len(w) == 2 else "" for w in words)
        return codes if all(codes) and len(set(codes)) == self.legs else self.leg_names

    @cached_property
    def batch_shape(self) -> tuple[int, ...]:
        """Broadcast batch axes of the robot's arrays; empty for a single robot."""
        shapes = []
        for name, tail in TAILS.items():
            value = getattr(self, name)
            if value is not None:
                shapes.append(tuple(value.shape[: value.ndim - len(tail)]))
        return broadcast_shapes(f"robot {self.name!r}", *shapes)

    @cached_property
    def geometry(self) -> LegGeometry:
        """The constants of the legs' kinematics."""
        arrays = {
            name: getattr(self, name)
            for name in (
                "mount_position",
                "mount_yaw",
                "coxa",
                "femur",
                "tibia",
                "femur_axis_offset",
                "limits",
            )
        }
        xp = namespace(*arrays.values())
        return LegGeometry.of(xp, **{n: v if xp is np else xp.asarray(v) for n, v in arrays.items()})

    @property
    def has_masses(self) -> bool:
        """Whether the masses of the body and of every link are known."""
        return self.body_mass is not None and self.link_mass is not None

    def require_masses(self) -> None:
        """Refuse a robot without masses.

        Raises
        ------
        MissingDataError
            If the mass of the body or of a link is unknown.
        """
        missing = [
            key
            for key, value in (("[body] mass_kg", self.body_mass), ("[leg] mass_kg", self.link_mass))
            if value is None
        ]
        if missing:
            raise MissingDataError(
                f"robot {self.name!r}: {' and '.join(missing)} missing from its file; {masses_advice(self)}"
            )

    def replace(self, **changes: Any) -> Self:
        """Return a copy of the robot with some attributes changed.

        Parameters
        ----------
        **changes
            Attributes and their new values.

        Raises
        ------
        InputError
            If a new value has the wrong shape or is out of range.
        UnknownNameError
            If a robot has no field of that name.
        """
        known = [spec.name for spec in dataclasses.fields(self)]
        for name in changes:
            if name not in known:
                raise UnknownNameError.of("field of a robot", name, known)
        return dataclasses.replace(self, **changes)

    def item(self, index: tuple[int, ...], *, of: tuple[int, ...] | None = None) -> Self:
        """Return a single design of the batch, with NumPy arrays.

        Parameters
        ----------
        index : tuple of int
            Index along each batch axis.
        of : tuple of int, optional
            Batch axes of `index`, to which those of the robot broadcast. Default: those of the robot.
        """
        batch = self.batch_shape if of is None else of
        if not self.batch_shape and isinstance(self.femur, np.ndarray):
            return self
        changes: dict[str, Array] = {}
        for name, tail in TAILS.items():
            value = getattr(self, name)
            if value is not None:
                array = np.asarray(value)
                changes[name] = np.broadcast_to(array, (*batch, *array.shape[array.ndim - len(tail) :]))[index]
        return self.replace(**changes)


def require_robot(robot: object) -> None:
    """Refuse anything that is not a robot.

    Parameters
    ----------
    robot : object
        Expected: a `Robot`.

    Raises
    ------
    InputError
        If it is not.
    """
    if not isinstance(robot, Robot):
        advice = f"; load_robot({robot!r}) loads one" if isinstance(robot, str) else ""
        raise InputError(f"robot is {robot!r}; it must be a Robot{advice}")


def require_leg_number(name: str, leg: object, legs: int) -> None:
    """Refuse anything that is not the number of a leg.

    Parameters
    ----------
    name, leg : str, object
        What needs the leg, for messages; the value, expected: the number of a leg.
    legs : int
        How many legs the robot has.

    Raises
    ------
    InputError
        If the robot has no such leg.
    """
    if leg not in range(legs):
        raise InputError(f"{name}: the robot has no leg {leg!r}; its legs are 0 to {legs - 1}")


def masses_advice(robot: Robot) -> str:
    """Return what to do about the missing masses of a robot.

    Parameters
    ----------
    robot : Robot
        The robot.
    """
    measure = "weigh the body with its battery, and one leg's links with their servos"
    if robot.name in preset_names():
        return (
            f"no masses are published for this preset: copy it with tarsus robots new my-{robot.name} --from "
            f"{robot.name}, {measure}, and fill in the masses there"
        )
    return f"{measure}, and add mass_kg under [body] and [leg]; estimates are marked in [[sources]] as a guess"


def stack_robots(robots: Sequence[Robot]) -> Robot:
    """Stack robots into a batch of designs along a new first axis.

    Parameters
    ----------
    robots : sequence of Robot
        At least one; all with the same number of legs, and masses known for all or for none.

    Raises
    ------
    InputError
        If there is none, or they differ in the shapes or presence of arrays.
    """
    if not robots:
        raise InputError("stack_robots: the sequence of robots is empty")
    first = robots[0]
    changes: dict[str, Array] = {}
    for name in TAILS:
        values = [getattr(robot, name) for robot in robots]
        if any((v is None) != (values[0] is None) for v in values):
            raise InputError(f"stack_robots: {name} is known for some of the robots and unknown for others")
        if values[0] is not None:
            if any(v.shape != values[0].shape for v in values):
                raise InputError(f"stack_robots: {name} differs in shape between the robots")
            changes[name] = np.stack([np.asarray(v) for v in values])
    return first.replace(**changes)
