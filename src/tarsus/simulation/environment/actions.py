"""Actions: from numbers in [-1, 1] to joint targets."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from tarsus.errors import InputError, UnknownNameError
from tarsus.gait.walk_setup import require_number
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float, Shaped

__all__ = ["ACTIONS", "ActionKind", "ActionMap"]

ActionKind = Literal["residual", "joint"]
ACTIONS = ("residual", "joint")
"""Kinds of actions."""


class ActionMap:
    """Turns actions into joint targets within the joint limits.

    ``"residual"``: what is added to the joint angles of a walk controller, as a fraction of the greatest residual.
    ``"joint"``: the targets themselves, 0 those of standing, -1 and 1 the joint limits.

    Parameters
    ----------
    robot : Robot
        A single robot.
    standing : array, shape (legs, 3)
        Joint angles of standing [rad].
    kind : str
        ``"residual"`` or ``"joint"``.
    residual : float
        Greatest residual [rad].

    Raises
    ------
    UnknownNameError
        If the kind does not exist.
    InputError
        If the residual is not a positive finite number.
    """

    def __init__(
        self, robot: Robot, standing: Float[np.ndarray, "legs 3"], *, kind: ActionKind, residual: float
    ) -> None:
        if kind not in ACTIONS:
            raise UnknownNameError.of("kind of action", kind, ACTIONS)
        require_number("residual", residual, zero=False)
        self.kind, self._standing, self._residual = kind, standing, residual
        limits = np.asarray(robot.limits)
        self._low, self._high = np.ascontiguousarray(limits[..., 0]), np.ascontiguousarray(limits[..., 1])
        self._shape = standing.shape

    def targets(
        self, action: Shaped[np.ndarray, "..."], walk: Float[np.ndarray, "legs 3"]
    ) -> Float[np.ndarray, "legs 3"]:
        """Return the joint targets ``(legs, 3)`` [rad].

        Parameters
        ----------
        action : array, shape (3 * legs,)
            The action; numbers outside [-1, 1] are clipped to it.
        walk : array, shape (legs, 3)
            Joint angles of the walk controller [rad].

        Raises
        ------
        InputError
            If the action has another size, or is not finite.
        """
        numbers = np.asarray(action, dtype=float)
        if numbers.size != self._low.size or not np.isfinite(numbers).all():
            raise InputError(f"an action must be {self._low.size} finite numbers, got {action!r}")
        part = np.minimum(np.maximum(numbers.reshape(self._shape), -1.0), 1.0)
        targets: np.ndarray
        if self.kind == "residual":
            targets = np.minimum(np.maximum(walk + self._residual * part, self._low), self._high)
        else:
            span = np.where(part > 0, self._high - self._standing, self._standing - self._low)
            targets = self._standing + part * span
        return targets

    def action(
        self, targets: Float[np.ndarray, "legs 3"], walk: Float[np.ndarray, "legs 3"]
    ) -> Float[np.ndarray, "joints"]:
        """Return the action that gives joint targets, or the nearest possible, ``(3 * legs,)``.

        Parameters
        ----------
        targets : array, shape (legs, 3)
            Joint targets [rad].
        walk : array, shape (legs, 3)
            Joint angles of the walk controller [rad].
        """
        if self.kind == "residual":
            part = (targets - walk) / self._residual
        else:
            away = targets - self._standing
            span = np.where(away > 0, self._high - self._standing, self._standing - self._low)
            part = away / np.where(span > 0, span, np.inf)
        action: np.ndarray = np.minimum(np.maximum(part, -1.0), 1.0).ravel().astype(np.float32)
        return action
