"""That the centre of mass stays over the feet: where it is while they rest, and how far each leg shifts it."""

from __future__ import annotations

from typing import Any

import numpy as np

from tarsus.gait.live.polygon import polygon_ends
from tarsus.gait.live.stand import Stand
from tarsus.gait.live.support import margin_at_rest, safe_share
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import point_masses, total_mass
from tarsus.robot.robot import Robot

__all__ = ["Balance"]

Floats = np.ndarray[Any, Any]

# How far inside its support the centre of mass stays [m].
_LEAST_MARGIN = 0.004


class Balance:
    """Keeps a robot that walks in some order of steps from tipping over.

    Where the robot's file gives no masses, its legs count as massless.

    Parameters
    ----------
    robot : Robot
        A single robot.
    sets : array of bool, shape (n, legs)
        Feet that are down together.
    gone : tuple of int
        Legs that don't step: wherever they hang about, they shift the centre of mass.

    Attributes
    ----------
    least_margin : float
        How far inside its support the centre of mass stays [m].
    """

    def __init__(self, robot: Robot, sets: Floats, gone: tuple[int, ...] = ()) -> None:
        self._robot, self._sets, self._gone = robot, sets, list(gone)
        self.least_margin = _LEAST_MARGIN
        # Shares of the whole that the legs' points and the body's centre weigh.
        self._weights, self._body = np.zeros((robot.legs, 4)), np.asarray(robot.body_com)
        if robot.has_masses:
            total = total_mass(robot)
            self._weights = point_masses(np, robot) / total
            self._body = self._body * (robot.body_mass / total)
            reach = np.asarray(robot.coxa + robot.femur + robot.tibia) * np.asarray(robot.link_mass).sum(-1) / 4
            self.least_margin += float(reach[self._gone].sum() / total)

    def safe_share(self, stand: Stand, sides: Floats, centre: complex, shift: Floats) -> float:
        """Return by how much the feet's polygons must shrink towards the rest footholds, so that nothing tips over.

        Parameters
        ----------
        stand : Stand
            The body and the rest footholds.
        sides : array, shape (legs, 16)
            The polygons' sides [m].
        centre, shift
            From `centre_of_mass`.

        Returns
        -------
        float
            A share of the polygons' size; 0 where the robot tips over even with its feet at rest.
        """
        return safe_share(self._sets, sides, stand.rest, centre, margin=self.least_margin, shift=shift)

    def centre_of_mass(self, stand: Stand, sides: Floats) -> tuple[complex, Floats]:
        """Return the projected centre of mass with the feet at rest, and its shift by each leg at each corner.

        Parameters
        ----------
        stand : Stand
            The body and the rest footholds.
        sides : array, shape (legs, 16)
            The polygons' sides [m].

        Returns
        -------
        centre : complex
            In the heading frame [m].
        shift : complex array, shape (legs, 16)
            By each leg, at each corner of `polygon_ends` [m]; none by legs that don't step.
        """
        # Every foot at rest first, then at one of its corners after the other.
        corners = polygon_ends(sides, stand.rest)[1]
        moments, centre = self._moments(stand, np.concatenate([np.zeros((1, len(corners))), corners.T]))
        shift = (moments[1:] - moments[0]).T
        shift[self._gone] = 0.0
        return centre, shift

    def margin_at_rest(self, stand: Stand) -> float:
        """Return how far inside its supports the centre of mass is with the feet at rest [m].

        Parameters
        ----------
        stand : Stand
            The body and the rest footholds.
        """
        return margin_at_rest(self._sets, stand.rest, self._moments(stand, np.zeros((1, len(stand.rest))))[1])

    def _moments(self, stand: Stand, out: Floats) -> tuple[Floats, complex]:
        """Return what each leg adds to the centre of mass ``(n, legs)``, and where that is in the first row [m]."""
        feet = stand.rest + out
        solution = stand.solve(self._robot, feet.real, feet.imag, np.zeros((1, 1)))
        points = forward_kinematics(self._robot, np.stack(solution[:3], axis=-1))
        moments = (points * self._weights[..., None]).sum(axis=-2) @ stand.rotation.T
        moments = moments[..., 0] + 1j * moments[..., 1]
        body = stand.rotation @ self._body + stand.position
        return moments, complex(moments[0].sum() + complex(body[0], body[1]))
