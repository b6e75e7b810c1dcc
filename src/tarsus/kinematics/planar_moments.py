"""Least-squares fit of a plane to points: its two slopes, from the second moments of the points."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from tarsus.arrays import Array

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["PlanarMoments"]


class PlanarMoments(NamedTuple):
    """Second moments of points in the plane about their mean: floats, or arrays ``(...)``.

    Attributes
    ----------
    xx, xy, yy : float or array, shape (...)
        Sums of ``(x - x_mean)^2``, ``(x - x_mean)(y - y_mean)`` and ``(y - y_mean)^2`` [m^2].
    """

    xx: Float[Array, "*#batch"]
    xy: Float[Array, "*#batch"]
    yy: Float[Array, "*#batch"]

    @property
    def determinant(self) -> Float[Array, "*batch"]:
        """Determinant ``(...)`` of the normal equations; 0 where the points are on a line [m^4]."""
        return self.xx * self.yy - self.xy * self.xy

    def span_area(self, least: float) -> Bool[Array, "*batch"]:
        """Return whether the points span an area, rather than being on a line or nearly so.

        Parameters
        ----------
        least : float
            Least determinant, relative to the square of ``xx + yy``; 0.25 for a spread equal in all directions.

        Returns
        -------
        bool or array of bool, shape (...)
        """
        return self.determinant > least * (self.xx + self.yy) ** 2

    def slopes(
        self, xz: Float[Array, "*#batch"], yz: Float[Array, "*#batch"], *, determinant: Float[Array, "*#batch"]
    ) -> tuple[Float[Array, "*batch"] | float, Float[Array, "*batch"] | float]:
        """Solve the normal equations ``[[xx, xy], [xy, yy]] @ (a, b) = (xz, yz)`` by Cramer's rule.

        Parameters
        ----------
        xz, yz : float or array, shape (...)
            Right-hand sides: of a plane ``z = z_mean + a (x - x_mean) + b (y - y_mean)`` fitted to heights, the sums
            of ``(x - x_mean)(z - z_mean)`` and ``(y - y_mean)(z - z_mean)``.
        determinant : float or array, shape (...)
            `determinant`, or any other number where the points are on a line and the result is not used.

        Returns
        -------
        a, b : float or array, shape (...)
            Slopes along x and y.
        """
        return (self.yy * xz - self.xy * yz) / determinant, (self.xx * yz - self.xy * xz) / determinant
