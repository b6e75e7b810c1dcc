"""The torques of one steady cycle of walking, for a whole batch of designs in one call.

A cycle of steady walking on level ground with a level body is plane statics: every force is vertical, so that a joint
bears forces times distances outward in its leg's plane, and the coxa joints bear nothing. Working in those distances,
with the legs in front and the designs behind, takes a fraction of what `joint_torques` needs for any pose at all.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from tarsus.arrays import Array, Namespace, as_array, as_floats, broadcast_shapes, namespace, require_finite, stack_last
from tarsus.blocks import Index, batch_blocks
from tarsus.errors import InputError
from tarsus.gait.cycle import cycle_feet
from tarsus.gait.gait import Gait
from tarsus.gait.setup import default_swing_height
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.mass import point_masses, total_mass
from tarsus.kinematics.pairs import columns_of
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stance import default_body_height, default_stance
from tarsus.load.contact import GRAVITY
from tarsus.load.payload import Payload, as_payload
from tarsus.load.planar_statics import (
    Block,
    LegPlane,
    feet_from_load,
    plane_by_angles,
    share_weight,
    solve_block,
    torques_in_plane,
)
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.robot import Robot
from tarsus.robot.shape import TAILS

__all__ = ["CycleTorques", "cycle_torques"]

Floats = np.ndarray[Any, np.dtype[np.float64]]

_BLOCK = 49152  # legs of all moments at a time: calls are few, and the arrays of a block stay in the cache
_MOST_PHASES = 1_000_000


@dataclass(frozen=True, eq=False, kw_only=True)
class CycleTorques:
    """One steady cycle of each of a batch of designs ``(...)``.

    Attributes
    ----------
    phases : array, shape (phases,)
        Moments, in cycles.
    contacts : array of bool, shape (phases, legs)
        Which feet are down.
    angles : array, shape (..., phases, legs, 3)
        Joint angles [rad].
    reach : array of int8, shape (..., phases, legs)
        Codes of `Reach`; torques are those at the angles, which are the nearest where a foot is out of reach.
    torques : array, shape (..., phases, legs, 3)
        What the servos must exert [N m]; on level ground nothing in the coxa joints.
    forces : array, shape (..., phases, legs, 3)
        Ground on foot [N].
    balanced : array of bool, shape (..., phases)
        Whether there is an equilibrium; if not, torques and forces are those with which the robot begins to tip.
    """

    phases: Floats
    contacts: np.ndarray[Any, np.dtype[np.bool_]]
    angles: Array
    reach: Array
    torques: Array
    forces: Array
    balanced: Array

    @cached_property
    def peak(self) -> Array:
        """Largest torque of coxa, femur and tibia over the cycle and all legs ``(..., 3)`` [N m]."""
        xp = namespace(self.torques)
        return xp.max(xp.abs(self.torques), axis=(-3, -2))

    @cached_property
    def ok(self) -> Array:
        """Whether all feet are within reach and the robot is in balance throughout ``(...)``."""
        xp = namespace(self.reach, self.balanced)
        return xp.all(self.reach == 0, axis=(-2, -1)) & xp.all(self.balanced, axis=-1)


def cycle_torques(
    robot: Robot,
    gait: Gait,
    *,
    stroke: Array,
    heading: float = 0.0,
    body_height: Array | None = None,
    swing_height: Array | None = None,
    phases: int = 32,
    payload: Payload | float = 0.0,
) -> CycleTorques:
    """Return angles, forces and torques over one steady, straight cycle, for every design of a batch.

    Footholds are those of `default_stance`; the body is level and the ground too. Quasi-static, as `joint_torques`.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs; its masses must be known.
    gait : Gait
        Its gait.
    stroke : array, shape (...)
        How far the body moves in a stance [m].
    heading : float
        Where to, counter-clockwise from the front [rad].
    body_height : array, shape (...), optional
        Height of the body's origin over the ground [m]; the robot's own where left out.
    swing_height : array, shape (...), optional
        Lift of the swinging feet [m]; the robot's own where left out.
    phases : int
        At how many even moments of the cycle.
    payload : Payload or float
        What the body carries; a number is a mass at its origin [kg].

    Raises
    ------
    MissingDataError
        If the robot's masses are unknown.
    UnreachableError
        If a leg of a design reaches the ground nowhere at that body height; the message says which.
    InputError
        If a number is not finite or out of its range, or the gait is for another number of legs.
    """
    robot.require_masses()
    gait.require_legs(robot.legs)
    carried = as_payload(payload)
    if not 1 <= phases <= _MOST_PHASES or phases != int(phases):
        raise InputError(f"phases is {phases}; it must be a whole number from 1 to {_MOST_PHASES}")
    if not math.isfinite(heading):
        raise InputError(f"heading is {heading} rad; it must be a finite number")
    body_height = default_body_height(robot) if body_height is None else body_height
    swing_height = default_swing_height(robot) if swing_height is None else swing_height
    arrays = {name: getattr(robot, name) for name in TAILS if getattr(robot, name) is not None}
    xp = namespace(stroke, body_height, swing_height, *arrays.values())
    stroke, body_height, swing_height = (
        as_floats(xp, value, name=name)
        for name, value in (("stroke", stroke), ("body_height", body_height), ("swing_height", swing_height))
    )
    require_finite("stroke", stroke)
    rest = default_stance(robot, body_height, swing_height=swing_height)
    batch = broadcast_shapes(
        "robot, stroke, body height and lift",
        robot.batch_shape,
        *(v.shape for v in (stroke, body_height, swing_height)),
    )
    cycle = _Cycle.of(gait, heading, phases)
    cycle = _Cycle.of(gait, heading, int(phases))
    sweep = _Sweep(xp, robot, carried, rest, stroke, body_height, swing_height, batch or (1,), cycle)
    return sweep.result(sweep.by_blocks() if xp is np else sweep.by_angles(), batch)


class _Cycle(NamedTuple):
    """A cycle: feet in strokes and lifts from rest ``(3, legs, phases, 1)``; moments that have the same feet down."""

    phases: Floats
    contacts: np.ndarray[Any, np.dtype[np.bool_]]
    along: Floats
    groups: list[tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]]

    @classmethod
    def of(cls, gait: Gait, heading: float, phases: int) -> _Cycle:
        moments = np.arange(phases) / phases
        twist = np.array([math.cos(heading), math.sin(heading), 0.0])
        # Straight on, a foot's way does not depend on where it rests: it is the same for all designs.
        feet, contacts = cycle_feet(gait, np.zeros((gait.legs, 3)), twist, swing_height=np.ones(()), phases=moments)
        if not contacts.any(-1).all():
            hanging = moments[int(np.argmin(contacts.any(-1)))]
            raise InputError(f"gait {gait.name!r}: no foot is on the ground at {hanging:g} of the cycle")
        patterns, which = np.unique(contacts, axis=0, return_inverse=True)
        groups = [(np.flatnonzero(down), np.flatnonzero(which.ravel() == i)) for i, down in enumerate(patterns)]
        return cls(moments, contacts, np.ascontiguousarray(feet.T[..., None]), groups)


@dataclass(frozen=True)
class _Sweep:
    """Designs over a cycle. Within, results are ``(rows, legs, phases, designs)``."""

    xp: Namespace
    robot: Robot
    payload: Payload
    rest: Array
    stroke: Array
    body_height: Array
    swing_height: Array
    batch: tuple[int, ...]
    cycle: _Cycle

    def by_blocks(self) -> tuple[Array, ...]:
        """Work through NumPy designs; those whose feet don't tell all, together at the end."""
        legs, moments = self.robot.legs, len(self.cycle.phases)
        shape = (legs, moments, *self.batch)
        angles, torques, forces = np.empty((3, *shape)), np.zeros((3, *shape)), np.zeros((3, *shape))
        reach, balanced = np.zeros(shape, dtype=np.int8), np.empty(shape[1:], dtype=bool)
        again = np.zeros(self.batch, dtype=bool)
        masses = point_masses(np, self.robot)
        for index in batch_blocks(self.batch, max(1, _BLOCK // (legs * moments))):
            block = self.block(masses, index)
            triangle, solved, plane = solve_block(block, self.cycle.along)
            femur, tibia, push, ok = self.statics(block, plane)
            into = (slice(None), slice(None), *index)
            results = zip((*angles, *torques[1:], forces[2]), (*triangle[:3], femur, tibia, push), strict=True)
            for target, values in results:
                target[into] = values.reshape(target[into].shape)
            balanced[into[1:]] = ok.reshape(balanced[into[1:]].shape)
            again[index] = ~solved.reshape(again[index].shape)
        if again.any():
            where = np.nonzero(again)
            rows = self.picked(where).by_angles()
            single: Any = (..., *where)
            for target, values in zip((angles, torques, forces), rows[:3], strict=True):
                target[single] = values
            reach[single], balanced[single] = rows[3:]
        return angles, torques, forces, reach, balanced

    def by_angles(self) -> tuple[Array, ...]:
        """Return angles, torques, forces, reach and balance of all designs, in a row, from their joint angles."""
        xp, legs, moments = self.xp, self.robot.legs, len(self.cycle.phases)
        ahead, aside, up = (as_array(xp, np.ascontiguousarray(part[..., 0].T)) for part in self.cycle.along)
        stroke, swing_height, height = (v[..., None, None] for v in (self.stroke, self.swing_height, self.body_height))
        rest = self.rest[..., None, :, :]
        parts = (
            rest[..., 0] + stroke * ahead,
            rest[..., 1] + stroke * aside,
            rest[..., 2] + height + swing_height * up,
        )
        feet = xp.stack(xp.broadcast_arrays(*parts), axis=-1)
        above = height[..., 0] + xp.zeros_like(height[..., 0])
        body = Pose(xp.eye(3, dtype=feet.dtype), stack_last(xp, (0 * above, 0 * above, above)))
        solution = inverse_kinematics(_with_axis(self.robot), feet, body)
        count = math.prod(self.batch)
        joints = xp.permute_dims(xp.reshape(solution.angles, (count, moments, legs, 3)), (3, 2, 1, 0))
        reach = xp.permute_dims(xp.reshape(solution.reach, (count, moments, legs)), (2, 1, 0))
        block = self.block(point_masses(xp, self.robot), (slice(None),) * len(self.batch))
        plane = plane_by_angles(xp, block.legs, *(joints[i, ...] for i in range(3)))
        femur, tibia, push, balanced = self.statics(block, plane)
        none = xp.zeros_like(push)
        return joints, xp.stack((none, femur, tibia)), xp.stack((none, none, push)), reach, balanced

    def block(self, masses: Array, index: Index) -> Block:
        """Return some designs, or all."""
        xp, robot = self.xp, self.robot

        def columns(values: Array, tail: int) -> Array:
            return columns_of(xp, as_array(xp, values), self.batch, index, tail=tail)

        carried = self.payload.mass
        body = as_array(xp, robot.body_mass)
        moment = body[..., None] * as_array(xp, robot.body_com) + carried * as_array(
            xp, np.array(self.payload.position)
        )
        both = columns(moment, 1)
        return Block(
            legs=LegGeometry(*(columns(values, 1)[:, None, :] for values in robot.geometry)),
            masses=tuple(part[:, None, :] for part in _rows(columns(masses, 2))),
            moment=(both[0, ...], both[1, ...]),
            mass=columns(as_array(xp, total_mass(robot)) + carried, 0),
            rest=tuple(part[:, None, :] for part in _rows(columns(self.rest, 2))),
            stroke=columns(self.stroke, 0),
            body_height=columns(self.body_height, 0),
            swing_height=columns(self.swing_height, 0),
        )

    def statics(self, block: Block, plane: LegPlane) -> tuple[Array, Array, Array, Array]:
        """Return the torques of femur and tibia, the ground's forces, and where there is an equilibrium."""
        xp = self.xp
        x, y = feet_from_load(xp, block, plane)
        pushes, balanced = [], []
        for down, moments in self.cycle.groups:
            sides = (xp.take(xp.take(side, xp.asarray(moments), axis=1), xp.asarray(down), axis=0) for side in (x, y))
            shares, ok = share_weight(xp, *(xp.reshape(side, (len(down), -1)) for side in sides))
            shares = xp.reshape(shares, (len(down), len(moments), -1))
            rows = dict(zip(down.tolist(), _rows(shares), strict=True))
            none = xp.zeros_like(shares[0, ...])
            pushes.append(xp.stack([rows.get(leg, none) for leg in range(self.robot.legs)]))
            balanced.append(xp.reshape(ok, (len(moments), -1)))
        order = xp.asarray(np.argsort(np.concatenate([moments for _, moments in self.cycle.groups])))
        push = xp.take(xp.concat(pushes, axis=1), order, axis=1) * (block.mass * -GRAVITY[2])
        femur, tibia = torques_in_plane(block, plane, push, -GRAVITY[2])
        return femur, tibia, push, xp.take(xp.concat(balanced, axis=0), order, axis=0)

    def picked(self, where: tuple[np.ndarray[Any, Any], ...]) -> _Sweep:
        """Return single designs in a row."""

        def pick(values: Array, tail: int) -> Array:
            own = np.ndim(values) - tail
            return np.broadcast_to(values, (*self.batch, *np.shape(values)[own:]))[where]

        arrays = {
            name: pick(getattr(self.robot, name), len(tail)) for name, tail in TAILS.items() if _known(self, name)
        }
        numbers = {name: pick(getattr(self, name), 0) for name in ("stroke", "body_height", "swing_height")}
        robot = self.robot.replace(**arrays)
        return replace(self, robot=robot, rest=pick(self.rest, 2), batch=(len(where[0]),), **numbers)

    def result(self, rows: tuple[Array, ...], batch: tuple[int, ...]) -> CycleTorques:
        """Put the axes into their order, without copying what is NumPy's."""
        xp, legs, moments = self.xp, self.robot.legs, len(self.cycle.phases)

        def ordered(values: Array, *front: int) -> Array:
            axes = tuple(range(len(front), len(front) + len(batch)))
            return xp.permute_dims(xp.reshape(values, (*front, *batch)), (*axes, *reversed(range(len(front)))))

        angles, torques, forces = (ordered(part, 3, legs, moments) for part in rows[:3])
        return CycleTorques(
            phases=self.cycle.phases,
            contacts=self.cycle.contacts,
            angles=angles,
            reach=ordered(rows[3], legs, moments),
            torques=torques,
            forces=forces,
            balanced=ordered(rows[4], moments),
        )


def _known(sweep: _Sweep, name: str) -> bool:
    return getattr(sweep.robot, name) is not None


def _rows(array: Array) -> tuple[Array, ...]:
    return tuple(array[i, ...] for i in range(array.shape[0]))


def _with_axis(robot: Robot) -> Robot:
    """Return designs with an axis for the moments behind their batch axes."""
    changes = {}
    for name, tail in TAILS.items():
        value = getattr(robot, name)
        if value is not None and value.ndim > len(tail):
            own = tuple(value.shape[: value.ndim - len(tail)])
            changes[name] = value.reshape((*own, 1, *value.shape[len(own) :]))
    return robot.replace(**changes)
