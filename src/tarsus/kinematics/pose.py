"""Poses of rigid bodies: rotation and position, single or in a batch."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Self, overload

import numpy as np

from tarsus.arrays import (
    Array,
    Namespace,
    as_floats,
    broadcast_shapes,
    is_traced,
    namespace,
    require_finite,
    require_shape,
    stack_last,
)
from tarsus.errors import InputError
from tarsus.representation import represented

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Pose", "rpy_from_rotation", "stack_poses"]


def _locked(array: Float[Array, "... 3"]) -> Float[Array, "... 3"]:
    """Copy and lock a NumPy array; arrays of other libraries are immutable or can't be locked."""
    if isinstance(array, np.ndarray) and (array.flags.writeable or _is_writeable(array.base)):
        array = array.copy()
        array.setflags(write=False)
    return array


def _is_writeable(base: object) -> bool:
    """Return whether the base of a locked view can be written to."""
    return base is not None and not (isinstance(base, np.ndarray) and not base.flags.writeable)


def _require_rotation(xp: Namespace, rotation: Float[Array, "*batch 3 3"]) -> None:
    """Refuse matrices that are not rotations; traced ones can't be checked."""
    if is_traced(rotation):
        return
    first, second, third = (tuple(rotation[..., i, j] for j in range(3)) for i in range(3))
    size2 = xp.sum(xp.reshape(rotation * rotation, (*rotation.shape[:-2], 9)), axis=-1)
    volume = (
        first[0] * (second[1] * third[2] - second[2] * third[1])
        + first[1] * (second[2] * third[0] - second[0] * third[2])
        + first[2] * (second[0] * third[1] - second[1] * third[0])
    )
    # Among matrices with a squared Frobenius norm of 3, only rotations have determinant 1.
    error = xp.maximum(xp.abs(size2 - 3), xp.abs(volume - 1))
    if bool(xp.any(error > _TOLERANCE)):
        raise InputError(
            f"rotation is not a rotation matrix: determinant and squared norm deviate from 1 and 3 by up to "
            f"{float(xp.max(error)):.3g}; at most {_TOLERANCE:g} is allowed"
        )


# Largest deviation of determinant and squared norm of a rotation matrix, in single precision too.
_TOLERANCE = 1e-4

_IDENTITY = _locked(np.eye(3))
_ORIGIN = _locked(np.zeros(3))


@represented("position", "rpy")
@dataclass(frozen=True, eq=False)
class Pose:
    """Pose of a frame in another one: ``T_to_from @ points_in_from`` gives points in the frame `to`.

    Attributes
    ----------
    rotation : array, shape (..., 3, 3)
        Rotation matrices.
    position : array, shape (..., 3)
        Position of the origin [m].
    """

    rotation: Float[Array, "*#batch 3 3"] = field(default_factory=lambda: _IDENTITY)
    position: Float[Array, "*#batch 3"] = field(default_factory=lambda: _ORIGIN)

    def __post_init__(self) -> None:
        if self.rotation is _IDENTITY and self.position is _ORIGIN:
            return
        xp = namespace(self.rotation, self.position)
        rotation = as_floats(xp, self.rotation, name="rotation")
        position = as_floats(xp, self.position, name="position")
        require_shape("rotation", rotation, (3, 3))
        require_shape("position", position, (3,))
        require_finite("rotation", rotation)
        require_finite("position", position)
        if self.rotation is not _IDENTITY:
            _require_rotation(xp, rotation)
        if rotation.ndim > 2 and position.ndim > 1:
            broadcast_shapes("a pose", rotation.shape[:-2], position.shape[:-1])
        object.__setattr__(self, "rotation", _locked(rotation))
        object.__setattr__(self, "position", _locked(position))

    @classmethod
    def from_rpy(
        cls,
        roll: Float[Array, "*#batch"] = 0.0,
        pitch: Float[Array, "*#batch"] = 0.0,
        yaw: Float[Array, "*#batch"] = 0.0,
        position: Float[Array, "*#batch 3"] = (0.0, 0.0, 0.0),
    ) -> Self:
        """Build a pose from roll, pitch and yaw: ``Rz(yaw) Ry(pitch) Rx(roll)``.

        Parameters
        ----------
        roll, pitch, yaw : array, shape (...)
            Rotations about x, y and z [rad].
        position : array, shape (..., 3)
            Position of the origin [m].

        Raises
        ------
        InputError
            If a value is not finite, or the shapes don't broadcast.
        """
        xp = namespace(roll, pitch, yaw, position)
        angles = [as_floats(xp, a, name=n) for a, n in ((roll, "roll"), (pitch, "pitch"), (yaw, "yaw"))]
        for angle, name in zip(angles, ("roll", "pitch", "yaw"), strict=True):
            require_finite(name, angle)
        broadcast_shapes("roll, pitch and yaw", *(angle.shape for angle in angles))
        (cr, cp, cy), (sr, sp, sy) = [xp.cos(a) for a in angles], [xp.sin(a) for a in angles]
        rows = (
            (cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
            (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
            (-sp, cp * sr, cp * cr),
        )
        flat = stack_last(xp, tuple(entry for row in rows for entry in row))
        rotation = xp.reshape(flat, (*flat.shape[:-1], 3, 3))
        # The matrix is a rotation by construction; checking would take as long as building it.
        pose = cls(position=position)
        if rotation.ndim > 2 and pose.position.ndim > 1:
            broadcast_shapes("a pose", rotation.shape[:-2], pose.position.shape[:-1])
        return cls.unchecked(rotation, pose.position)

    @classmethod
    def unchecked(cls, rotation: Float[Array, "*#batch 3 3"], position: Float[Array, "*#batch 3"]) -> Self:
        """Build a pose from arrays that are valid by construction; checking them takes longer than most uses.

        Parameters
        ----------
        rotation : array, shape (..., 3, 3)
            Rotation matrices, of floats.
        position : array, shape (..., 3)
            Position of the origin, finite floats [m].
        """
        pose = object.__new__(cls)
        object.__setattr__(pose, "rotation", _locked(rotation))
        object.__setattr__(pose, "position", _locked(position))
        return pose

    @property
    def batch_shape(self) -> tuple[int, ...]:
        """Broadcast batch axes of rotation and position."""
        return broadcast_shapes("a pose", self.rotation.shape[:-2], self.position.shape[:-1])

    @overload
    def __matmul__(self, other: Pose) -> Pose: ...
    @overload
    def __matmul__(self, other: Float[Array, "*#batch 3"]) -> Float[Array, "... 3"]: ...
    def __matmul__(self, other: Any) -> Any:
        """Transform points, or compose poses.

        Parameters
        ----------
        other : Pose or array, shape (..., 3)
            A pose; or points, whose leading axes are the batch axes of the pose, with any number of axes between them
            and the last: a single pose transforms ``(3,)``, ``(legs, 3)`` and ``(legs, 4, 3)``; ``n`` poses transform
            ``(n, legs, 3)``.

        Raises
        ------
        InputError
            If the points are not finite, or their axes don't broadcast with those of the pose.
        """
        if isinstance(other, Pose):
            xp = namespace(self.rotation, other.rotation, other.position)
            broadcast_shapes("the poses", self.batch_shape, other.batch_shape)
            return Pose.unchecked(
                xp.matmul(xp.asarray(self.rotation), xp.asarray(other.rotation)),
                self._transform(other.position[..., None, :])[..., 0, :],
            )
        xp = namespace(other, self.rotation, self.position)
        points = as_floats(xp, other, name="points")
        require_shape("points", points, (3,))
        require_finite("points", points)
        batch = self.batch_shape
        between = max(points.ndim - 1 - len(batch), 0)
        broadcast_shapes("the pose and the points", batch, points.shape[: points.ndim - 1 - between])
        if between == 0:
            return self._transform(points[..., None, :])[..., 0, :]
        leading, middle = points.shape[: points.ndim - 1 - between], points.shape[points.ndim - 1 - between : -1]
        transformed = self._transform(xp.reshape(points, (*leading, math.prod(middle), 3)))
        return xp.reshape(transformed, (*transformed.shape[:-2], *middle, 3))

    def _transform(self, points: Float[Array, "..."]) -> Float[Array, "*batch k 3"]:
        """Transform points ``(..., k, 3)`` whose leading axes broadcast with the batch axes."""
        xp = namespace(points, self.rotation, self.position)
        rotation, position = xp.asarray(self.rotation), xp.asarray(self.position)
        return xp.matmul(xp.asarray(points), xp.matrix_transpose(rotation)) + position[..., None, :]

    def inverse(self) -> Pose:
        """Return the inverse pose: ``T_from_to`` of ``T_to_from``."""
        xp = namespace(self.rotation, self.position)
        back = xp.matrix_transpose(xp.asarray(self.rotation))
        return Pose.unchecked(back, -xp.matmul(back, xp.asarray(self.position)[..., None])[..., 0])

    def __getitem__(self, index: Any) -> Pose:
        """Return the poses at `index` of the batch axes."""
        xp = namespace(self.rotation, self.position)
        batch = self.batch_shape
        if not batch:
            raise InputError("a single pose has no batch axes to index")
        rotation = xp.broadcast_to(xp.asarray(self.rotation), (*batch, 3, 3))
        position = xp.broadcast_to(xp.asarray(self.position), (*batch, 3))
        index = index if isinstance(index, tuple) else (index,)
        if not any(part is Ellipsis for part in index):
            index = (*index, ...)
        return Pose.unchecked(rotation[(*index, slice(None), slice(None))], position[(*index, slice(None))])

    @property
    def rpy(self) -> Float[Array, "*batch 3"]:
        """Roll, pitch and yaw ``(..., 3)`` [rad]."""
        return rpy_from_rotation(self.rotation)


def stack_poses(poses: Sequence[Pose]) -> Pose:
    """Return single poses as a batch.

    Parameters
    ----------
    poses : sequence of Pose
        The poses, at least one.

    Returns
    -------
    Pose
        A batch of shape (n,).
    """
    return Pose(np.array([pose.rotation for pose in poses]), np.array([pose.position for pose in poses]))


def rpy_from_rotation(rotation: Float[Array, "*batch 3 3"]) -> Float[Array, "*batch 3"]:
    """Return roll, pitch and yaw of rotation matrices ``Rz(yaw) Ry(pitch) Rx(roll)``.

    Parameters
    ----------
    rotation : array, shape (..., 3, 3)
        Rotation matrices.

    Returns
    -------
    array, shape (..., 3)
        Roll, pitch, yaw [rad]; pitch in -pi/2..pi/2. At pitch +-pi/2 only the sum or difference of roll and yaw is
        determined; their values are arbitrary.
    """
    xp = namespace(rotation)
    r = as_floats(xp, rotation, name="rotation")
    cos_pitch = xp.sqrt(r[..., 0, 0] ** 2 + r[..., 1, 0] ** 2)
    return stack_last(
        xp,
        (
            xp.atan2(r[..., 2, 1], r[..., 2, 2]),
            xp.atan2(-r[..., 2, 0], cos_pitch),
            xp.atan2(r[..., 1, 0], r[..., 0, 0]),
        ),
    )
