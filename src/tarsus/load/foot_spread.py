"""Second moments of the foot positions, and the load fractions that balance a load with the least sum of squares.

Without the constraint that feet can only push, the load fractions ``s_i`` with a given sum, given moments and the least
sum of squares are linear in the foot position: ``s_i = a + b x_i + c y_i``. About the centroid of the feet, along an
axis and across it, the three coefficients decouple, so that feet on a line need no special equations.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Self, TypeAlias

from tarsus.arrays import Array, Namespace

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["FLAT", "Spread", "Triple", "evaluate_plane"]

Triple: TypeAlias = tuple[Array, Array, Array]

FLAT = 1e-13
"""Relative spread below which feet count as collinear: 1000 rounding errors."""

_ROUNDING = 1e-12  # of a moment, relative to the spread of the feet


class Spread(NamedTuple):
    """Centroid and second moments of a set of feet.

    The first axis is the coordinate with the larger second moment: y where `swap` is set, else x. `slope` is the
    regression slope of the second coordinate on the first; `along` and `across` are the sums of squares about the
    centroid along the first axis, and of the residuals across it.
    """

    swap: Bool[Array, "..."]
    count: Float[Array, "..."]
    centroid: tuple[Float[Array, "..."], Float[Array, "..."]]
    slope: Float[Array, "..."]
    along: Float[Array, "..."]
    across: Float[Array, "..."]

    @classmethod
    def of(
        cls,
        xp: Namespace,
        x: Float[Array, "legs batch"],
        y: Float[Array, "legs batch"],
        which: Bool[Array, "... legs batch"],
    ) -> Self:
        """Return the spread of the feet at ``(x, y)``, ``(legs, batch)``, that `which` selects."""
        weights = xp.astype(which, x.dtype)
        count = xp.sum(weights, axis=0)
        count = xp.where(count > 0, count, 1.0)
        mid_x, mid_y = xp.sum(weights * x, axis=0) / count, xp.sum(weights * y, axis=0) / count
        u, v = weights * (x - mid_x), weights * (y - mid_y)
        uu, uv, vv = xp.sum(u * u, axis=0), xp.sum(u * v, axis=0), xp.sum(v * v, axis=0)
        swap = vv > uu
        along = xp.where(swap, vv, uu)
        slope = uv / xp.where(along > 0, along, 1.0)
        residual = xp.where(swap, u, v) - slope * xp.where(swap, v, u)
        centroid = (xp.where(swap, mid_y, mid_x), xp.where(swap, mid_x, mid_y))
        return cls(swap, count, centroid, slope, along, xp.sum(residual * residual, axis=0))

    def balance(
        self, xp: Namespace, total: Float[Array, "..."], moment_x: Float[Array, "..."], moment_y: Float[Array, "..."]
    ) -> Triple:
        """Return the coefficients of the load fractions, negative ones included, with this sum and these moments.

        Collinear feet balance only the moment along their line, a single foot only the sum.
        """
        first, second = self._moments(xp, total, moment_x, moment_y)
        along, across = (
            xp.where(s > FLAT**2, moment / xp.where(s > FLAT**2, s, 1.0), 0.0)
            for moment, s in ((first, self.along), (second, self.across))
        )
        return self._plane(xp, total, along, across)

    def free(
        self, xp: Namespace, total: Float[Array, "..."], moment_x: Float[Array, "..."], moment_y: Float[Array, "..."]
    ) -> Triple:
        """Return coefficients that are zero at these feet and rise towards feet that could balance the residual moment.

        Where the residual is within rounding, they are zero.
        """
        along, across = (
            xp.where((s > FLAT**2) | (xp.abs(moment) < _ROUNDING), 0.0, xp.sign(moment))
            for moment, s in zip(self._moments(xp, total, moment_x, moment_y), (self.along, self.across), strict=True)
        )
        return self._plane(xp, xp.zeros_like(total), along, across)

    def _moments(
        self, xp: Namespace, total: Float[Array, "..."], moment_x: Float[Array, "..."], moment_y: Float[Array, "..."]
    ) -> tuple[Float[Array, "..."], Float[Array, "..."]]:
        """Return the moments about the feet's centroid, along the first axis and across it."""
        first = xp.where(self.swap, moment_y, moment_x) - total * self.centroid[0]
        return first, xp.where(self.swap, moment_x, moment_y) - total * self.centroid[1] - self.slope * first

    def _plane(
        self, xp: Namespace, total: Float[Array, "..."], along: Float[Array, "..."], across: Float[Array, "..."]
    ) -> Triple:
        along = along - across * self.slope
        constant = total / self.count - along * self.centroid[0] - across * self.centroid[1]
        return constant, xp.where(self.swap, across, along), xp.where(self.swap, along, across)


def evaluate_plane(
    dual: Triple, x: Float[Array, "legs batch"], y: Float[Array, "legs batch"]
) -> Float[Array, "... legs batch"]:
    """Return ``a + b x + c y`` at each foot."""
    return dual[0] + dual[1] * x + dual[2] * y
