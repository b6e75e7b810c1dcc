"""Checks of the feet in stance: stability margin, ground plane and foot drag."""

from __future__ import annotations

import math
from itertools import combinations
from typing import TypeAlias

from tarsus.control.safety.bounds import GuardBounds
from tarsus.control.safety.interventions import Intervention, InterventionKind
from tarsus.control.safety.scalar_geometry import LegModel, Point, plane_normal, polygon_margin, project
from tarsus.robot.robot import Robot

__all__ = ["FeetMonitor"]

# For each pair of feet in stance: their distance when both had come into stance [m], and the angles of their tibiae to
# B's xy plane at that time [rad].
_References: TypeAlias = dict[tuple[int, int], Point]


class FeetMonitor:
    """Checks the feet of each command, and their distances from tick to tick.

    Attributes
    ----------
    stance : list of bool or None
        Feet in stance at the last accepted command; None if contacts were not given.
    up : Point
        Upward direction in B at that command.

    Parameters
    ----------
    robot, bounds : Robot, GuardBounds
        A single robot; the bounds.
    """

    def __init__(self, robot: Robot, bounds: GuardBounds) -> None:
        self._model, self._codes = LegModel(robot), robot.leg_codes
        self._radius: list[float] = robot.foot_radius.tolist()
        self._bounds, self._slope = bounds, math.tan(bounds.ground_slope)
        self.stance: list[bool] | None = None
        self.up: Point = (0.0, 0.0, 1.0)
        self._references: _References = {}
        # What becomes `stance`, `up` and the references once the command is accepted.
        self._checked: tuple[list[bool] | None, Point, _References] = None, self.up, {}

    def violations(self, angles: list[float], stance: list[bool] | None, up: Point | None) -> list[Intervention]:
        """Return the violations of a command.

        Parameters
        ----------
        angles : list of float
            Joint angles of all legs in one flat list [rad].
        stance : list of bool or None
            Feet in stance; None if unknown: nothing is checked.
        up : Point or None
            Upward direction in B; None to take the plane of the stance feet as horizontal.
        """
        if stance is None:
            self._checked = None, up or self.up, {}
            return []
        feet, com = self._model.points(angles)
        legs = [leg for leg, is_down in enumerate(stance) if is_down]
        stance_feet = [feet[leg] for leg in legs]
        up = up or plane_normal(stance_feet)
        found, references = self._drag_violations(legs, feet, angles)
        self._checked = stance, up, references
        places, heights = project(stance_feet, com, up)
        margin = polygon_margin(places)
        if not margin >= self._bounds.margin:
            found.append(Intervention(InterventionKind.STABILITY_MARGIN, "", "", margin, self._bounds.margin))
        if len(legs) > 1:
            found += self._height_violations(legs, places, heights)
        return found

    def accept(self) -> None:
        """Store the last checked command as the one that is sent."""
        self.stance, self.up, self._references = self._checked

    def reset_distances(self) -> None:
        """Discard the distances between the feet; the next command sets them anew."""
        self._references = {}

    def _drag_violations(
        self, legs: list[int], feet: list[Point], angles: list[float]
    ) -> tuple[list[Intervention], _References]:
        """Return violations for pairs of feet whose distance has changed too much in stance, and the references.

        A ball that rolls moves by at most its radius times the angle by which its tibia turns.
        """
        tilts = [femur + tibia for femur, tibia in zip(angles[1::3], angles[2::3], strict=True)]
        found, references = list[Intervention](), _References()
        for i, j in combinations(legs, 2):
            distance = math.dist(feet[i], feet[j])
            reference = self._references.get((i, j), (distance, tilts[i], tilts[j]))
            references[i, j] = stood, tilt_i, tilt_j = reference
            rolled = self._radius[i] * abs(tilts[i] - tilt_i) + self._radius[j] * abs(tilts[j] - tilt_j)
            drag, bound = abs(distance - stood), self._bounds.foot_drag + rolled
            if drag > bound:
                found.append(Intervention(InterventionKind.FOOT_DRAG, self._codes[j], "", drag, bound))
        return found, references

    def _height_violations(self, legs: list[int], places: list[complex], heights: list[float]) -> list[Intervention]:
        """Return violations for stance feet too far above or below the mean height of all stance feet."""
        middle, mean, found = sum(places) / len(places), sum(heights) / len(heights), []
        for leg, place, height in zip(legs, places, heights, strict=True):
            offset, bound = abs(height - mean), self._bounds.foot_height + self._slope * abs(place - middle)
            if offset > bound:
                found.append(Intervention(InterventionKind.FOOT_HEIGHT, self._codes[leg], "", offset, bound))
        return found
