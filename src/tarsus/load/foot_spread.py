"""How feet are spread on the ground, and the plane of shares with which they balance a load.

Without a limit to pushing, the least squares of shares ``s_i`` with a given sum and given moments are a plane over the
feet, ``s_i = a + b x_i + c y_i``. Seen from the feet's middle, along an axis and across it, each of its three numbers
stands for itself; so feet on a line, or all but on one, need no other equations.
"""

from __future__ import annotations

from typing import NamedTuple, Self, TypeAlias

from tarsus.arrays import Array, Namespace

__all__ = ["FLAT", "Column", "Spread", "Triple", "plane"]

Column: TypeAlias = Array
Triple: TypeAlias = tuple[Column, Column, Column]

FLAT = 1e-13
"""Relative spread below which feet are on a line: a thousand roundings."""

_ROUNDING = 1e-12  # of a moment, relative to the feet's spread


class Spread(NamedTuple):
    """How some of the feet are spread: where their middle is, and along which axes.

    `swap` says where the first axis, along which they spread more, is y; `slope` how the second goes with the first;
    `along` and `across` are the sums of squares about the middle, along the first axis and independently of it.
    """

    swap: Column
    count: Column
    middle: tuple[Column, Column]
    slope: Column
    along: Column
    across: Column

    @classmethod
    def of(cls, xp: Namespace, x: Array, y: Array, which: Array) -> Self:
        """Measure the feet at ``(x, y)``, ``(legs, batch)``, that `which` names."""
        weights = xp.astype(which, x.dtype)
        count = xp.sum(weights, axis=0)
        count = xp.where(count > 0, count, 1.0)
        mid_x, mid_y = xp.sum(weights * x, axis=0) / count, xp.sum(weights * y, axis=0) / count
        u, v = weights * (x - mid_x), weights * (y - mid_y)
        uu, uv, vv = xp.sum(u * u, axis=0), xp.sum(u * v, axis=0), xp.sum(v * v, axis=0)
        swap = vv > uu
        along = xp.where(swap, vv, uu)
        slope = uv / xp.where(along > 0, along, 1.0)
        rest = xp.where(swap, u, v) - slope * xp.where(swap, v, u)
        middle = (xp.where(swap, mid_y, mid_x), xp.where(swap, mid_x, mid_y))
        return cls(swap, count, middle, slope, along, xp.sum(rest * rest, axis=0))

    def balance(self, xp: Namespace, whole: Column, moment_x: Column, moment_y: Column) -> Triple:
        """Return the plane of shares, pulling ones included, with this sum and these moments.

        Feet on a line, or a single one, balance what they can: moments along the line, or nothing but the sum.
        """
        first, second = self._moments(xp, whole, moment_x, moment_y)
        along, across = (
            xp.where(s > FLAT**2, moment / xp.where(s > FLAT**2, s, 1.0), 0.0)
            for moment, s in ((first, self.along), (second, self.across))
        )
        return self._plane(xp, whole, along, across)

    def free(self, xp: Namespace, whole: Column, moment_x: Column, moment_y: Column) -> Triple:
        """Return a plane that is zero at these feet, and rises towards those that could balance what they can't.

        Where they can't balance what is but a rounding, it is zero everywhere.
        """
        along, across = (
            xp.where((s > FLAT**2) | (xp.abs(moment) < _ROUNDING), 0.0, xp.sign(moment))
            for moment, s in zip(self._moments(xp, whole, moment_x, moment_y), (self.along, self.across), strict=True)
        )
        return self._plane(xp, xp.zeros_like(whole), along, across)

    def _moments(self, xp: Namespace, whole: Column, moment_x: Column, moment_y: Column) -> tuple[Column, Column]:
        """Return the moments about the feet's middle, along the first axis and across it."""
        first = xp.where(self.swap, moment_y, moment_x) - whole * self.middle[0]
        return first, xp.where(self.swap, moment_x, moment_y) - whole * self.middle[1] - self.slope * first

    def _plane(self, xp: Namespace, whole: Column, along: Column, across: Column) -> Triple:
        along = along - across * self.slope
        level = whole / self.count - along * self.middle[0] - across * self.middle[1]
        return level, xp.where(self.swap, across, along), xp.where(self.swap, along, across)


def plane(dual: Triple, x: Array, y: Array) -> Array:
    """Return what a plane ``a + b x + c y`` gives each foot."""
    return dual[0] + dual[1] * x + dual[2] * y
