"""Checks of the feet in stance: stability margin, ground plane and foot drag."""

from __future__ import annotations

import math
from itertools import combinations

from tarsus.control.safety.bounds import GuardBounds
from tarsus.control.safety.interventions import InterventionKind, Violation
from tarsus.control.safety.scalar_geometry import LegModel, Point, plane_normal, polygon_margin, project
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
    robot, bounds : Robot, GuardBounds
        A single robot; the bounds.
    """

    def __init__(self, robot: Robot, bounds: GuardBounds) -> None:
        self._model = LegModel(robot)
        self._pairs = tuple(combinations(range(robot.legs), 2))
        # Of each pair that is in stance: its distance when both feet came into stance [m], and the angles of their
        # tibiae relative to B's plane at that time [rad].
        self._unknown: list[Point | None] = [None] * len(self._pairs)
        self._references = self._new_references = self._unknown
        self._radius: list[float] = robot.foot_radius.tolist()
        self._margin, self._drag, self._height = bounds.margin, bounds.foot_drag, bounds.foot_height
        self._slope = math.tan(bounds.ground_slope)
        self.stance: list[bool] | None = None
        self.up: Point = (0.0, 0.0, 1.0)
        self._new_stance: list[bool] | None = None
        self._new_up = self.up

    def violations(self, angles: list[float], stance: list[bool] | None, up: Point | None) -> list[Violation]:
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
        self._new_stance = stance
        if stance is None:
            self._new_references, self._new_up = self._unknown, up or self.up
            return []
        feet, com = self._model.points(angles)
        stance_feet = [foot for foot, is_down in zip(feet, stance, strict=True) if is_down]
        self._new_up = up or plane_normal(stance_feet)
        tilts = [femur + tibia for femur, tibia in zip(angles[1::3], angles[2::3], strict=True)]
        found = self._drag_violations(feet, stance, tilts)
        x, y, heights = project(stance_feet, com, self._new_up)
        margin = polygon_margin(x, y)
        if not margin >= self._margin:
            found.append(Violation(InterventionKind.STABILITY_MARGIN, -1, -1, margin, self._margin))
        if len(stance_feet) > 1:
            found += self._height_violations(stance, x, y, heights)
        return found

    def accept(self) -> None:
        """Store the last checked command as the one that is sent."""
        self.stance, self.up, self._references = self._new_stance, self._new_up, self._new_references

    def reset_distances(self) -> None:
        """Discard the distances between the feet; the next command sets them anew."""
        self._references = self._unknown

    def _drag_violations(self, feet: list[Point], stance: list[bool], tilts: list[float]) -> list[Violation]:
        """Return the pairs of feet whose distance has changed too much since both came into stance.

        A ball that rolls moves by at most its radius times the angle by which its tibia turns.
        """
        self._new_references, found = [], []
        for (i, j), before in zip(self._pairs, self._references, strict=True):
            reference = None
            if stance[i] and stance[j]:
                distance = math.dist(feet[i], feet[j])
                reference = stood, tilt_i, tilt_j = before or (distance, tilts[i], tilts[j])
                rolled = self._radius[i] * abs(tilts[i] - tilt_i) + self._radius[j] * abs(tilts[j] - tilt_j)
                if abs(distance - stood) > self._drag + rolled:
                    drag = abs(distance - stood)
                    found.append(Violation(InterventionKind.FOOT_DRAG, j, -1, drag, self._drag + rolled))
            self._new_references.append(reference)
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
