"""A batch of designs at every phase of a gait cycle: joint angles, contact forces and torques in blocks."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tarsus.arrays import Array, Namespace, as_array, stack_last
from tarsus.blocks import Index, batch_blocks
from tarsus.errors import InputError
from tarsus.gait.cycle import cycle_feet
from tarsus.gait.gait import Gait
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.mass import STANDARD_GRAVITY, point_masses, total_mass
from tarsus.kinematics.pairs import columns_of
from tarsus.kinematics.pose import Pose
from tarsus.load.payload import Payload
from tarsus.load.planar_statics import (
    Block,
    LegPlane,
    feet_from_load,
    plane_by_angles,
    solve_block,
    torques_in_plane,
    weight_fractions,
)
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.robot import Robot
from tarsus.robot.shape import TAILS

if TYPE_CHECKING:
    from jaxtyping import Bool, Float, Int, Shaped

__all__ = ["CyclePhases", "CycleSweep"]

_BLOCK_SIZE = 49152  # legs times phases in a block: few calls, and the arrays of a block fit in the cache


class CyclePhases(NamedTuple):
    """Phases of a cycle, in a form common to all designs.

    `offsets` are the foot offsets from rest, in strokes and swing heights, ``(3, legs, phases, 1)``. `groups` lists the
    distinct contact patterns: the feet on the ground, and the phases with that pattern.
    """

    phases: Float[np.ndarray, "phases"]
    contacts: Bool[np.ndarray, "*batch legs"]
    offsets: Float[np.ndarray, "3 legs phases 1"]
    groups: list[tuple[Int[np.ndarray, "..."], Int[np.ndarray, "..."]]]

    @classmethod
    def of(cls, gait: Gait, heading: float, phases: int) -> CyclePhases:
        """Return evenly spaced phases of a gait walking straight on in one direction."""
        phase_values = np.arange(phases) / phases
        twist = np.array([math.cos(heading), math.sin(heading), 0.0])
        # For straight walking a foot's offset from rest does not depend on the foothold: it is common to all designs.
        feet, contacts = cycle_feet(
            gait, np.zeros((gait.legs, 3)), twist, swing_height=np.ones(()), phases=phase_values
        )
        if not contacts.any(-1).all():
            airborne = phase_values[int(np.argmin(contacts.any(-1)))]
            raise InputError(f"gait {gait.name!r}: no foot is on the ground at phase {airborne:g}")
        patterns, pattern_index = np.unique(contacts, axis=0, return_inverse=True)
        groups = [(np.flatnonzero(down), np.flatnonzero(pattern_index.ravel() == i)) for i, down in enumerate(patterns)]
        return cls(phase_values, contacts, np.ascontiguousarray(feet.T[..., None]), groups)


@dataclass(frozen=True)
class CycleSweep:
    """A batch of designs over a cycle; results of the methods are ``(rows, legs, phases, designs)``."""

    xp: Namespace
    robot: Robot
    payload: Payload
    rest: Float[Array, "*#batch legs 3"]
    stroke: Float[Array, "*#batch"]
    body_height: Float[Array, "*#batch"]
    swing_height: Float[Array, "*#batch"]
    batch: tuple[int, ...]
    cycle: CyclePhases

    def by_blocks(self) -> tuple[Shaped[Array, "..."], ...]:
        """Solve NumPy designs block by block; designs that `solve_block` leaves unsolved are solved by their angles."""
        legs, phase_count = self.robot.legs, len(self.cycle.phases)
        shape = (legs, phase_count, *self.batch)
        angles, torques, forces = np.empty((3, *shape)), np.zeros((3, *shape)), np.zeros((3, *shape))
        reach, balanced = np.zeros(shape, dtype=np.int8), np.empty(shape[1:], dtype=bool)
        unsolved = np.zeros(self.batch, dtype=bool)
        masses = point_masses(np, self.robot)
        for index in batch_blocks(self.batch, max(1, _BLOCK_SIZE // (legs * phase_count))):
            block = self.block(masses, index)
            triangle, solved, plane = solve_block(block, self.cycle.offsets)
            femur, tibia, normal_force, block_balanced = self.statics(block, plane)
            at = (slice(None), slice(None), *index)
            results = zip((*angles, *torques[1:], forces[2]), (*triangle[:3], femur, tibia, normal_force), strict=True)
            for target, values in results:
                target[at] = values.reshape(target[at].shape)
            balanced[at[1:]] = block_balanced.reshape(balanced[at[1:]].shape)
            unsolved[index] = ~solved.reshape(unsolved[index].shape)
        if unsolved.any():
            where = np.nonzero(unsolved)
            rows = self.select(where).by_angles()
            unsolved_at: Any = (..., *where)
            for target, values in zip((angles, torques, forces), rows[:3], strict=True):
                target[unsolved_at] = values
            reach[unsolved_at], balanced[unsolved_at] = rows[3:]
        return angles, torques, forces, reach, balanced

    def by_angles(self) -> tuple[Shaped[Array, "..."], ...]:
        """Return angles, torques, forces, reach and equilibrium of all designs, from inverse kinematics."""
        xp, legs, phase_count = self.xp, self.robot.legs, len(self.cycle.phases)
        forward, left, up = (as_array(xp, np.ascontiguousarray(values[..., 0].T)) for values in self.cycle.offsets)
        stroke, swing_height, height = (v[..., None, None] for v in (self.stroke, self.swing_height, self.body_height))
        rest = self.rest[..., None, :, :]
        coordinates = (
            rest[..., 0] + stroke * forward,
            rest[..., 1] + stroke * left,
            rest[..., 2] + height + swing_height * up,
        )
        feet = xp.stack(xp.broadcast_arrays(*coordinates), axis=-1)
        height_column = height[..., 0] + xp.zeros_like(height[..., 0])
        body = Pose(xp.eye(3, dtype=feet.dtype), stack_last(xp, (0 * height_column, 0 * height_column, height_column)))
        solution = inverse_kinematics(_with_axis(self.robot), feet, body)
        count = math.prod(self.batch)
        joints = xp.permute_dims(xp.reshape(solution.angles, (count, phase_count, legs, 3)), (3, 2, 1, 0))
        reach = xp.permute_dims(xp.reshape(solution.reach, (count, phase_count, legs)), (2, 1, 0))
        block = self.block(point_masses(xp, self.robot), (slice(None),) * len(self.batch))
        plane = plane_by_angles(xp, block.legs, *(joints[i, ...] for i in range(3)))
        femur, tibia, normal_force, balanced = self.statics(block, plane)
        zeros = xp.zeros_like(normal_force)
        return joints, xp.stack((zeros, femur, tibia)), xp.stack((zeros, zeros, normal_force)), reach, balanced

    def block(self, masses: Float[Array, "... legs 4"], index: Index) -> Block:
        """Return the designs at an index of the batch."""
        xp, robot = self.xp, self.robot

        def columns(values: Array, tail: int) -> Array:
            return columns_of(xp, as_array(xp, values), self.batch, index, tail=tail)

        carried = self.payload.mass
        body = as_array(xp, robot.body_mass)
        moment = body[..., None] * as_array(xp, robot.body_com) + carried * as_array(
            xp, np.array(self.payload.position)
        )
        moment_columns = columns(moment, 1)
        return Block(
            legs=LegGeometry(*(columns(values, 1)[:, None, :] for values in robot.geometry)),
            masses=tuple(values[:, None, :] for values in _rows(columns(masses, 2))),
            moment=(moment_columns[0, ...], moment_columns[1, ...]),
            mass=columns(as_array(xp, total_mass(robot)) + carried, 0),
            rest=tuple(values[:, None, :] for values in _rows(columns(self.rest, 2))),
            stroke=columns(self.stroke, 0),
            body_height=columns(self.body_height, 0),
            swing_height=columns(self.swing_height, 0),
        )

    def statics(
        self, block: Block, plane: LegPlane
    ) -> tuple[
        Float[Array, "... legs m n"], Float[Array, "... legs m n"], Float[Array, "... legs m n"], Bool[Array, "..."]
    ]:
        """Return femur torques, tibia torques, normal forces and whether there is an equilibrium."""
        xp = self.xp
        x, y = feet_from_load(xp, block, plane)
        normal_forces, balanced = [], []
        for down, phases in self.cycle.groups:
            coordinates = (
                xp.take(xp.take(coordinate, xp.asarray(phases), axis=1), xp.asarray(down), axis=0)
                for coordinate in (x, y)
            )
            fractions, block_balanced = weight_fractions(xp, *(xp.reshape(c, (len(down), -1)) for c in coordinates))
            fractions = xp.reshape(fractions, (len(down), len(phases), -1))
            rows = dict(zip(down.tolist(), _rows(fractions), strict=True))
            zeros = xp.zeros_like(fractions[0, ...])
            normal_forces.append(xp.stack([rows.get(leg, zeros) for leg in range(self.robot.legs)]))
            balanced.append(xp.reshape(block_balanced, (len(phases), -1)))
        order = xp.asarray(np.argsort(np.concatenate([phases for _, phases in self.cycle.groups])))
        normal_force = xp.take(xp.concat(normal_forces, axis=1), order, axis=1) * (block.mass * STANDARD_GRAVITY)
        femur, tibia = torques_in_plane(block, plane, normal_force, STANDARD_GRAVITY)
        return femur, tibia, normal_force, xp.take(xp.concat(balanced, axis=0), order, axis=0)

    def select(self, where: tuple[Int[np.ndarray, "..."], ...]) -> CycleSweep:
        """Return selected designs as a flat batch."""

        def selection(values: Array, tail: int) -> Array:
            batch_axes = np.ndim(values) - tail
            return np.broadcast_to(values, (*self.batch, *np.shape(values)[batch_axes:]))[where]

        arrays = {
            name: selection(getattr(self.robot, name), len(tail)) for name, tail in TAILS.items() if _known(self, name)
        }
        numbers = {name: selection(getattr(self, name), 0) for name in ("stroke", "body_height", "swing_height")}
        robot = self.robot.replace(**arrays)
        return replace(self, robot=robot, rest=selection(self.rest, 2), batch=(len(where[0]),), **numbers)


def _known(sweep: CycleSweep, name: str) -> bool:
    return getattr(sweep.robot, name) is not None


def _rows(array: Float[Array, "..."]) -> tuple[Float[Array, "..."], ...]:
    return tuple(array[i, ...] for i in range(array.shape[0]))


def _with_axis(robot: Robot) -> Robot:
    """Return the designs with an axis for the phases after their batch axes."""
    changes = {}
    for name, tail in TAILS.items():
        value = getattr(robot, name)
        if value is not None and value.ndim > len(tail):
            batch_axes = tuple(value.shape[: value.ndim - len(tail)])
            changes[name] = value.reshape((*batch_axes, 1, *value.shape[len(batch_axes) :]))
    return robot.replace(**changes)
