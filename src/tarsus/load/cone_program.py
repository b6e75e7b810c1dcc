"""Second-order cone program for contact forces in friction cones, solved by Clarabel: all samples in one problem.

In units of the weight and of the robot's size, with a foot's force f at the lever arm r, the residual wrench e and its
norm t::

    minimise    sum over feet of (f . square f) / 2 + linear . f  +  penalty * sum over samples of t
    subject to  (sum f, sum r x f) + e = (up, 0)      |f tangential| <= friction f_z      |e| <= t

The residual keeps the problem feasible: without it, one sample without an equilibrium makes the whole batch infeasible.
As its norm is penalised and not its square (an exact penalty), e is 0 wherever an equilibrium exists.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.errors import MissingDataError, TarsusError

if TYPE_CHECKING:
    from jaxtyping import Float, Int

__all__ = ["ConeProgram"]

_PENALTY = 1e3  # of the residual; the gradient of the objective is about 1 for forces that sum to 1
_TOLERANCE = 1e-12
_MAX_ITERATIONS = 200


class ConeProgram(NamedTuple):
    """Data of the program, with the feet of all samples in one axis.

    Attributes
    ----------
    sample : array of int, shape (feet,)
        Sample to which each foot belongs.
    samples : int
        Number of samples.
    arms : array, shape (feet, 3)
        Lever arms from the point where the load acts to the feet, over the robot's size.
    friction : float
        Coefficient of friction.
    up : array, shape (3,)
        Unit vector against gravity.
    square : array, shape (feet, 3, 3)
        Quadratic term of the objective.
    linear : array, shape (feet, 3)
        Linear term of the objective.
    """

    sample: Int[np.ndarray, "feet"]
    samples: int
    arms: Float[np.ndarray, "feet 3"]
    friction: float
    up: Float[np.ndarray, "3"]
    square: Float[np.ndarray, "feet 3 3"]
    linear: Float[np.ndarray, "feet 3"]

    def solve(self) -> tuple[Float[np.ndarray, "feet 3"], Float[np.ndarray, "samples 6"]]:
        """Return the contact forces and the residual wrenches, in units of weight and size.

        Returns
        -------
        forces : array, shape (feet, 3)
            Ground on foot.
        residual : array, shape (samples, 6)
            Force and moment that no forces in the cones balance.

        Raises
        ------
        MissingDataError
            If Clarabel is not installed.
        TarsusError
            If the solver does not converge.
        """
        try:
            import clarabel
            from scipy import sparse
        except ImportError as error:
            raise MissingDataError(
                f"contact forces with friction need the solver Clarabel: pip install 'tarsus[qp]' ({error})"
            ) from None
        feet, samples = len(self.arms), self.samples
        sizes = (3 * feet, 6 * samples, samples)
        row, column, entry = (np.concatenate(block) for block in zip(*self._blocks(), strict=True))
        rows = 6 * samples + 3 * feet + 7 * samples
        constraints = sparse.csc_matrix((entry, (row, column)), shape=(rows, sum(sizes)))
        i, j = np.triu_indices(3)
        offset = 3 * np.arange(feet)[:, None]
        entries = ((offset + i).ravel(), (offset + j).ravel())
        square = sparse.csc_matrix((self.square[:, i, j].ravel(), entries), shape=(sum(sizes), sum(sizes)))
        linear = np.concatenate([self.linear.ravel(), np.zeros(sizes[1]), np.full(samples, _PENALTY)])
        bounds = np.zeros(rows)
        bounds[: 6 * samples].reshape(samples, 6)[:, :3] = self.up
        cones = [
            clarabel.ZeroConeT(6 * samples),
            *[clarabel.SecondOrderConeT(3)] * feet,
            *[clarabel.SecondOrderConeT(7)] * samples,
        ]
        settings = clarabel.DefaultSettings()
        settings.verbose = False
        settings.max_iter = _MAX_ITERATIONS
        settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = _TOLERANCE
        solution = clarabel.DefaultSolver(square, linear, constraints, bounds, cones, settings).solve()
        if solution.status not in (clarabel.SolverStatus.Solved, clarabel.SolverStatus.AlmostSolved):
            raise TarsusError(f"contact forces with friction: Clarabel did not converge (status {solution.status})")
        values = np.asarray(solution.x)
        forces = values[: sizes[0]].reshape(feet, 3)
        return forces, values[sizes[0] : sizes[0] + sizes[1]].reshape(samples, 6)

    def _blocks(self) -> list[tuple[Int[np.ndarray, "..."], Int[np.ndarray, "..."], Float[np.ndarray, "..."]]]:
        """Return rows, columns and entries of the constraint matrix, block by block."""
        feet, samples = len(self.arms), self.samples
        axis = np.arange(3)
        force = 3 * np.arange(feet)[:, None] + axis
        balance = 6 * self.sample[:, None]
        moment = balance + 3 + axis
        cone = 6 * samples + force
        cone_slope = np.broadcast_to([-1.0, -1.0, -self.friction], (feet, 3))
        wrench, length = 3 * feet + np.arange(6 * samples), 3 * feet + 6 * samples + np.arange(samples)
        norm = 6 * samples + 3 * feet + 7 * np.arange(samples)
        blocks = [
            (balance + axis, force, np.ones((feet, 3))),
            (moment, np.roll(force, -2, axis=1), np.roll(self.arms, -1, axis=1)),
            (moment, np.roll(force, -1, axis=1), -np.roll(self.arms, -2, axis=1)),
            (np.arange(6 * samples), wrench, np.ones(6 * samples)),
            (np.roll(cone, -1, axis=1), force, cone_slope),
            (norm, length, -np.ones(samples)),
            ((norm[:, None] + 1 + np.arange(6)).ravel(), wrench, -np.ones(6 * samples)),
        ]
        return [(row.ravel(), column.ravel(), entry.ravel()) for row, column, entry in blocks]
