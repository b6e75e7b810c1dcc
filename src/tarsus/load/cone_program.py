"""The conic program of forces in friction cones, for Clarabel: all samples at once, a block each.

In units of the weight and of the robot's size, with a foot's force f at the arm r, what is missing e and its length t::

    least   sum over feet of (f . square f) / 2 + linear . f  +  price * sum over samples of t
    with    (sum f, sum r x f) + e = (up, 0)      |f along the ground| <= friction f_z      |e| <= t

Where no forces in the cones balance, the problem without e has no solution, and one such sample would spoil the
others'. With it there always is one, and e is 0 wherever it can be: a length, not a square, costs more than balancing.
"""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np

from tarsus.errors import MissingDataError, TarsusError

__all__ = ["ConeProgram", "Floats"]

Floats: TypeAlias = np.ndarray[Any, np.dtype[np.float64]]

_PRICE = 1e3  # of a missing balance; least squares of forces that sum to 1 have slopes of about 1
_TOLERANCE = 1e-12
_MOST_ROUNDS = 200


class ConeProgram(NamedTuple):
    """The numbers of the program; the feet of all samples are in one row.

    Attributes
    ----------
    sample : array of int, shape (feet,)
        Whose foot it is.
    samples : int
        How many there are.
    arms : array, shape (feet, 3)
        Where the feet are, seen from where the load acts.
    friction : float
        Coefficient of friction.
    up : array, shape (3,)
        Against gravity.
    square, linear : array, shape (feet, 3, 3) and (feet, 3)
        What is to be least.
    """

    sample: np.ndarray[Any, np.dtype[np.int64]]
    samples: int
    arms: Floats
    friction: float
    up: Floats
    square: Floats
    linear: Floats

    def solve(self) -> tuple[Floats, Floats]:
        """Return forces ``(feet, 3)`` and what is missing ``(samples, 6)``.

        Raises
        ------
        MissingDataError
            If Clarabel is not installed.
        TarsusError
            If it gives up.
        """
        try:
            import clarabel
            from scipy import sparse
        except ImportError as error:
            raise MissingDataError(
                f"forces with friction need the solver Clarabel: pip install 'tarsus[qp]' ({error})"
            ) from None
        feet, samples = len(self.arms), self.samples
        sizes = (3 * feet, 6 * samples, samples)
        row, column, entry = (np.concatenate(part) for part in zip(*self._blocks(), strict=True))
        rows = 6 * samples + 3 * feet + 7 * samples
        conditions = sparse.csc_matrix((entry, (row, column)), shape=(rows, sum(sizes)))
        i, j = np.triu_indices(3)
        first = 3 * np.arange(feet)[:, None]
        where = ((first + i).ravel(), (first + j).ravel())
        square = sparse.csc_matrix((self.square[:, i, j].ravel(), where), shape=(sum(sizes), sum(sizes)))
        linear = np.concatenate([self.linear.ravel(), np.zeros(sizes[1]), np.full(samples, _PRICE)])
        right = np.zeros(rows)
        right[: 6 * samples].reshape(samples, 6)[:, :3] = self.up
        cones = [
            clarabel.ZeroConeT(6 * samples),
            *[clarabel.SecondOrderConeT(3)] * feet,
            *[clarabel.SecondOrderConeT(7)] * samples,
        ]
        settings = clarabel.DefaultSettings()
        settings.verbose = False
        settings.max_iter = _MOST_ROUNDS
        settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = _TOLERANCE
        solution = clarabel.DefaultSolver(square, linear, conditions, right, cones, settings).solve()
        if solution.status not in (clarabel.SolverStatus.Solved, clarabel.SolverStatus.AlmostSolved):
            raise TarsusError(f"forces with friction: the solver gave up, saying {solution.status}")
        values = np.asarray(solution.x)
        forces = values[: sizes[0]].reshape(feet, 3)
        return forces, values[sizes[0] : sizes[0] + sizes[1]].reshape(samples, 6)

    def _blocks(self) -> list[tuple[Floats, Floats, Floats]]:
        """Return rows, columns and entries of the conditions, block by block."""
        feet, samples = len(self.arms), self.samples
        axis = np.arange(3)
        force = 3 * np.arange(feet)[:, None] + axis
        own = 6 * self.sample[:, None]
        turn = own + 3 + axis
        cone = 6 * samples + force
        slip = np.broadcast_to([-1.0, -1.0, -self.friction], (feet, 3))
        wrench, length = 3 * feet + np.arange(6 * samples), 3 * feet + 6 * samples + np.arange(samples)
        far = 6 * samples + 3 * feet + 7 * np.arange(samples)
        blocks = [
            (own + axis, force, np.ones((feet, 3))),
            (turn, np.roll(force, -2, axis=1), np.roll(self.arms, -1, axis=1)),
            (turn, np.roll(force, -1, axis=1), -np.roll(self.arms, -2, axis=1)),
            (np.arange(6 * samples), wrench, np.ones(6 * samples)),
            (np.roll(cone, -1, axis=1), force, slip),
            (far, length, -np.ones(samples)),
            ((far[:, None] + 1 + np.arange(6)).ravel(), wrench, -np.ones(6 * samples)),
        ]
        return [(row.ravel(), column.ravel(), entry.ravel()) for row, column, entry in blocks]
