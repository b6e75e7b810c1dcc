"""Resting pose of the robot on flat ground for given joint angles."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import Array, Namespace, as_array, broadcast_shapes, is_traced, namespace, stack_last
from tarsus.blocks import BLOCK, Index, batch_blocks, block_shape
from tarsus.errors import InputError
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.lowered import Lowered, stands_as_lowered
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.pairs import columns_of
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.roll import Settled, rotation_rows, settle
from tarsus.representation import represented
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float, Int

__all__ = ["RestingPose", "rest_of_points", "resting_pose"]

CORNERS = np.array(list(itertools.product((-0.5, 0.5), repeat=3)))
"""Corners of the body's box in units of its size, in the order of `RestingPose.corners_down`: x varies slowest."""


@represented("robot", "body", "contacts", "margin", "stable", "rolls")
@dataclass(frozen=True, kw_only=True, eq=False)
class RestingPose:
    """How a robot rests on flat ground, for one configuration or a batch.

    Attributes
    ----------
    robot : Robot
        The robot, or the batch of designs.
    body : Pose
        Pose of B in G, with yaw 0, above G's origin. At a pitch of +-90 deg, roll is 0.
    contacts : array of bool, shape (..., legs)
        Feet on the ground.
    leg_points_down : array of bool, shape (..., legs, 4)
        Leg points on the ground: coxa axis, femur axis, knee, foot.
    corners_down : array of bool, shape (..., 8) or (..., 0)
        Corners of the body's box on the ground, in the order of `CORNERS`; ``(..., 0)`` without a box.
    margin : array, shape (...)
        Margin of the centre of mass in the convex hull of all contact points [m].
    stable : array of bool, shape (...)
        Whether it rests. False where it was still rolling after `max_rolls`, or where the centre of mass of the robot
        file is outside the robot, so that no pose is stable.
    rolls : array of int, shape (...)
        Number of rolls from one set of contacts to the next.
    """

    robot: Robot
    body: Pose
    contacts: Bool[Array, "*#batch legs"]
    leg_points_down: Bool[Array, "*#batch legs 4"]
    corners_down: Bool[Array, "*#batch 8"] | Bool[Array, "*#batch 0"]
    margin: Float[Array, "*#batch"]
    stable: Bool[Array, "*#batch"]
    rolls: Int[Array, "*#batch"]

    def describe(self) -> str:
        """Return a sentence on how the robot rests.

        Raises
        ------
        InputError
            If this is a batch.
        """
        if self.margin.ndim:
            raise InputError(
                f"describe() needs a single configuration; this is a batch of shape {tuple(self.margin.shape)}"
            )
        contacts = self._describe_contacts(np.asarray(self.leg_points_down))
        if not bool(self.stable):
            return f"does not come to rest; after {int(self.rolls)} rolls it {contacts}"
        massless = "" if self.robot.has_masses else " (masses unknown: margin of the body's centre)"
        return f"{contacts}; stability margin {1000 * float(self.margin):.1f} mm{massless}"

    def _describe_contacts(self, down: Bool[Array, "legs 4"]) -> str:
        names = self.robot.leg_codes
        parts = []
        for point, part in ((3, "foot"), (2, "knee"), (1, "femur axis")):
            legs = [name for name, touches in zip(names, down[:, point], strict=True) if touches]
            if legs:
                parts.append(f"the {_PLURALS[part] if len(legs) > 1 else part} {', '.join(legs)}")
        if bool(np.any(np.asarray(self.corners_down))) or bool(down[:, 0].any()):
            return f"lies on {' and '.join([self._face(), *parts])}"
        if down[:, 1:3].any():
            return f"rests on {' and '.join(parts)}"
        feet = [name for name, touches in zip(names, down[:, 3], strict=True) if touches]
        return f"stands on {len(feet)} {'foot' if len(feet) == 1 else 'feet'}: {', '.join(feet)}"

    def _face(self) -> str:
        """Return the side of the body that faces down."""
        up = np.asarray(self.body.rotation)[2]
        axis = int(np.argmax(np.abs(up)))
        return _FACES[axis][int(up[axis] > 0)]


_PLURALS = {"foot": "feet", "knee": "knees", "femur axis": "femur axes"}
_FACES = (("its front", "its rear"), ("its left side", "its right side"), ("its back", "its belly"))


def resting_pose(robot: Robot, angles: Float[Array, "*#batch legs 3"], *, max_rolls: int = 64) -> RestingPose:
    """Return the pose in which the robot rests on flat ground with its joints held at the given angles.

    The robot is lowered upright, B's z up, until it touches the ground, and rolls quasi-statically from contact to
    contact until its centre of mass is supported: on its feet, a knee, its belly, side or back. Contact points are the
    leg points (the foot as a point) and the corners of the body's box, centred on B's origin; without ``body_size``,
    the coxa axes stand for the body. Points less than 1 nm above the ground are in contact (8 um in single precision).

    Balanced on a point, it tips forward (along B's x, seen from above); on an edge, to its forward side, or to the left
    where the edge is parallel to x. With the centre of mass exactly above the edge of a polygon with an area, it rests
    with margin 0.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs; without masses, see `centre_of_mass`.
    angles : array, shape (..., legs, 3)
        Joint angles [rad].
    max_rolls : int
        Most rolls; after that `RestingPose.stable` is False. 0 tests whether the robot rests as lowered.

    Returns
    -------
    RestingPose
        Pose of the body, contacts and margin.

    Raises
    ------
    InputError
        If the angles have the wrong shape, are not finite or are traced by JAX, or `max_rolls` is negative.

    Notes
    -----
    Follows the steepest descent of the centre of mass exactly: see `tarsus.kinematics.roll`.
    """
    if max_rolls < 0:
        raise InputError(f"max_rolls is {max_rolls}; it must not be negative")
    points = forward_kinematics(robot, angles)
    return rest_of_points(robot, points, centre_of_mass(robot, angles, points=points), max_rolls=max_rolls)


def rest_of_points(
    robot: Robot,
    points: Float[Array, "*#batch legs 4 3"],
    com: Float[Array, "*#batch 3"],
    *,
    max_rolls: int = 64,
) -> RestingPose:
    """Return the resting pose, as `resting_pose`, where leg points and centre of mass are known already.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.
    points : array, shape (..., legs, 4, 3)
        Result of `forward_kinematics` [m].
    com : array, shape (..., 3)
        Result of `centre_of_mass` [m].
    max_rolls : int
        Most rolls, at least 0.

    Raises
    ------
    InputError
        If an array is traced by JAX.
    """
    if any(is_traced(array) for array in (points, com, robot.body_size)):
        raise InputError("resting_pose can't be traced: the number of rolls depends on the values; call it outside jit")
    xp = namespace(points, com, robot.body_size)
    points, com = as_array(xp, points), as_array(xp, com)
    cloud = [xp.reshape(points, (*points.shape[:-3], 4 * robot.legs, 3))]
    if robot.body_size is not None:
        cloud.append(as_array(xp, robot.body_size)[..., None, :] * xp.asarray(CORNERS))
    batch = broadcast_shapes("robot and angles", com.shape[:-1], *(part.shape[:-2] for part in cloud))
    if xp is np and not batch and (standing := stands_as_lowered(np.concatenate(cloud), com)) is not None:
        return _as_lowered(robot, standing)
    size = BLOCK // robot.legs if xp is np else max(1, math.prod(batch))
    blocks = [_settle_block(xp, cloud, com, batch, index, max_rolls) for index in batch_blocks(batch, size)]
    return _rest(xp, robot, blocks, batch)


def _as_lowered(robot: Robot, standing: Lowered) -> RestingPose:
    legs = 4 * robot.legs
    leg_points = standing.down[:legs].reshape(robot.legs, 4)
    return RestingPose(
        robot=robot,
        body=Pose(position=np.array([0.0, 0.0, standing.height])),
        contacts=leg_points[:, 3],
        leg_points_down=leg_points,
        corners_down=standing.down[legs:],
        margin=np.array(standing.margin),
        stable=np.array(True),
        rolls=np.array(0, dtype=np.int32),
    )


def _settle_block(
    xp: Namespace,
    cloud: list[Float[Array, "... 3"]],
    com: Float[Array, "... 3"],
    batch: tuple[int, ...],
    index: Index,
    max_rolls: int,
) -> Settled:
    parts = [columns_of(xp, part, batch, index, tail=2) for part in cloud]
    centre = columns_of(xp, com, batch, index, tail=1)
    items = math.prod(block_shape(batch, index))
    points = xp.concat([xp.broadcast_to(part, (*part.shape[:2], items)) for part in parts], axis=1)
    centre = xp.broadcast_to(centre, (3, items))
    return settle(
        xp,
        (points[0, ...], points[1, ...], points[2, ...]),
        (centre[0, ...], centre[1, ...], centre[2, ...]),
        max_rolls=max_rolls,
    )


def _rest(xp: Namespace, robot: Robot, blocks: list[Settled], batch: tuple[int, ...]) -> RestingPose:
    def joined(parts: list[Array], *tail: int) -> Array:
        return xp.reshape(xp.concat(parts, axis=0), (*batch, *tail))

    up = [joined([block.up[axis] for block in blocks]) for axis in range(3)]
    rows = rotation_rows(xp, (up[0], up[1], up[2]))
    rotation = xp.reshape(stack_last(xp, (*rows[0], *rows[1], *rows[2])), (*batch, 3, 3))
    height = joined([block.height for block in blocks])
    level = xp.zeros_like(height)
    down = joined([xp.matrix_transpose(block.down) for block in blocks], blocks[0].down.shape[0])
    leg_points = xp.reshape(down[..., : 4 * robot.legs], (*batch, robot.legs, 4))
    return RestingPose(
        robot=robot,
        body=Pose(rotation, stack_last(xp, (level, level, height))),
        contacts=leg_points[..., 3],
        leg_points_down=leg_points,
        corners_down=down[..., 4 * robot.legs :],
        margin=joined([block.margin for block in blocks]),
        stable=joined([block.stable for block in blocks]),
        rolls=joined([block.rolls for block in blocks]),
    )
