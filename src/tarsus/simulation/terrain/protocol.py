"""What every terrain offers: its height, and how it is added to a physics model."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

import numpy as np

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Terrain"]


@runtime_checkable
class Terrain(Protocol):
    """Ground in G: z up, x forward from where the robot starts."""

    @property
    def friction(self) -> float:
        """Coefficient of friction between ground and feet."""

    def height(self, x: Any, y: Any) -> Float[np.ndarray, "*batch"]:
        """Return the height of the ground.

        Parameters
        ----------
        x, y : array, shape (...)
            Where, in G [m].

        Returns
        -------
        array, shape (...)
            Height in G [m].
        """

    def add_to(self, spec: Any) -> None:
        """Add the ground to the world of a model.

        Parameters
        ----------
        spec : mujoco.MjSpec
            The model; it is changed.
        """
