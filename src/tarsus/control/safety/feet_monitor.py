"""Checks of the feet in stance: stability margin, ground plane and foot drag."""

from __future__ import annotations

import math
from itertools import combinations

from tarsus.control.safety.bounds import GuardBounds
from tarsus.control.safety.inputs import Rows
from tarsus.control.safety.interventions import InterventionKind, Violation
from tarsus.control.safety.leg_model import LegModel
from tarsus.control.safety.support_geometry import Point, plane_normal, polygon_margin, project
from tarsus.robot.robot import Robot

__all__ = ["FeetMonitor"]


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
    robot : Robot
        A single robot.
    bounds : GuardBounds
        The bounds.
    """

    def __init__(self, robot: Robot, bounds: GuardBounds) -> None:
        self._model = LegModel(robot)
        self._pairs = tuple(combinations(range(robot.legs), 2))
        self._unknown: list[float | None] = [None] * len(self._pairs)
        self._distances = self._new_distances = self._unknown
        self._radius = [float(radius) for radius in robot.foot_radius]
        # Tibia angles relative to B's plane at which the distance of each pair was stored [rad].
        self._tilts = self._new_tilts = [(0.0, 0.0)] * len(self._pairs)
        self._margin, self._drag, self._height = bounds.margin, bounds.foot_drag, bounds.foot_height
        self._slope = math.tan(bounds.ground_slope)
        self.stance: list[bool] | None = None
        self.up: Point = (0.0, 0.0, 1.0)
        self._new_stance: list[bool] | None = None
        self._new_up = self.up

    def violations(self, angles: list[float], stance: list[bool] | None, rows: Rows | None) -> list[Violation]:
        """Return the violations of a command.

        Parameters
        ----------
        angles : list of float
            Joint angles of all legs in one flat list [rad].
        stance : list of bool or None
            Feet in stance; None if unknown: nothing is checked.
        rows : list of list of float, or None
            Rotation of B in G; None to take the plane of the stance feet as horizontal.
        """
        self._new_stance = stance
        if stance is None:
            self._new_distances = self._unknown
            self._new_up = self.up if rows is None else (rows[2][0], rows[2][1], rows[2][2])
            return []
        feet, com = self._model.points(angles)
        stance_feet = [foot for foot, is_down in zip(feet, stance, strict=True) if is_down]
        up = plane_normal(stance_feet) if rows is None else (rows[2][0], rows[2][1], rows[2][2])
        self._new_up = up
        tilts = [femur + tibia for femur, tibia in zip(angles[1::3], angles[2::3], strict=True)]
        found = self._drag_violations(feet, stance, tilts)
        x, y, heights = project(stance_feet, com, up)
        margin = polygon_margin(x, y)
        if not margin >= self._margin:
            found.append(Violation(InterventionKind.STABILITY_MARGIN, -1, -1, margin, self._margin))
        if len(stance_feet) > 1:
            found += self._height_violations(stance, x, y, heights)
        return found

    def accept(self) -> None:
        """Store the last checked command as the one that is sent."""
        self.stance, self.up = self._new_stance, self._new_up
        self._distances, self._tilts = self._new_distances, self._new_tilts

    def reset_distances(self) -> None:
        """Discard the distances between the feet; the next command sets them anew."""
        self._distances = self._unknown

    def _drag_violations(self, feet: list[Point], stance: list[bool], tilts: list[float]) -> list[Violation]:
        """Return the pairs of feet whose distance has changed too much since both came into stance.

        A ball that rolls moves by at most its radius times the angle by which its tibia turns.
        """
        distances: list[float | None] = []
        references = self._tilts.copy()
        found = []
        for pair, ((i, j), before) in enumerate(zip(self._pairs, self._distances, strict=True)):
            if not (stance[i] and stance[j]):
                distances.append(None)
                continue
            now = math.dist(feet[i], feet[j])
            distances.append(now if before is None else before)
            if before is None:
                references[pair] = (tilts[i], tilts[j])
            elif abs(now - before) > self._drag:
                tilt_i, tilt_j = references[pair]
                rolled = self._radius[i] * abs(tilts[i] - tilt_i) + self._radius[j] * abs(tilts[j] - tilt_j)
                bound = self._drag + rolled
                if abs(now - before) > bound:
                    found.append(Violation(InterventionKind.FOOT_DRAG, j, -1, abs(now - before), bound))
        self._new_distances, self._new_tilts = distances, references
        return found

    def _height_violations(
        self, stance: list[bool], x: list[float], y: list[float], heights: list[float]
    ) -> list[Violation]:
        """Return the stance feet too far above or below the mean height of all stance feet."""
        count = len(heights)
        mean_x, mean_y, mean = sum(x) / count, sum(y) / count, sum(heights) / count
        found = []
        legs = (leg for leg, is_down in enumerate(stance) if is_down)
        for leg, foot_x, foot_y, height in zip(legs, x, y, heights, strict=True):
            offset = abs(height - mean)
            if offset > self._height:
                bound = self._height + self._slope * math.hypot(foot_x - mean_x, foot_y - mean_y)
                if offset > bound:
                    found.append(Violation(InterventionKind.FOOT_HEIGHT, leg, -1, offset, bound))
        return found
