"""Matplotlib artists of a robot, created once and moved for every frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.kinematics.polygon import support_polygon
from tarsus.report.sample import Sample
from tarsus.report.solid import body_solid
from tarsus.report.style import INK, WARNING, halo, leg_colours
from tarsus.report.view import View
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D
    from matplotlib.patches import Polygon

__all__ = ["RobotDrawing"]

_STABLE, _BODY, _SHADOW = "#009E73", "#9aa7b5", "#d4d4d4"
# Thickness of coxa, femur and tibia relative to the length of a leg.
_THICKNESS = (0.062, 0.058, 0.036)
_GROUND, _SOLID = 1.0, 10.0
# Range of matplotlib's zorder for depths in front of the body's origin and behind it, each.
_ORDER = 5.0
_STEP = 1e-6


class RobotDrawing:
    """Drawing of a robot; `update` moves it.

    Parameters
    ----------
    axes : Axes
        Target axes, in millimetres of the projection; their limits determine the line widths of the links.
    robot : Robot
        A single robot.
    view : View
        Direction of view.
    names : bool
        Whether to label the legs.
    shadows : bool
        Whether to draw shadows, support polygon and the projection of the centre of mass onto the plane z = 0.
    """

    def __init__(self, axes: Axes, robot: Robot, *, view: View, names: bool = False, shadows: bool = True) -> None:
        from matplotlib.patches import Polygon

        self._axes, self._robot, self._view, self._has_shadows = axes, robot, view, shadows
        self._solid = body_solid(robot)
        self._colours = leg_colours(robot)
        self._reach = float((robot.coxa + robot.femur + robot.tibia).max())
        point = self._points_per_metre()
        self._width = [max(fraction * self._reach * point, 1.5) for fraction in _THICKNESS]
        self._foot = max(2 * float(np.asarray(robot.foot_radius).max()) * point, 1.3 * self._width[2])

        def polygon(**style: Any) -> Polygon:
            patch = Polygon(np.zeros((3, 2)), closed=True, **style)
            axes.add_patch(patch)
            return patch

        self._support = polygon(alpha=0.22, linewidth=1.6, zorder=_GROUND + 0.2)
        self._shadow = polygon(facecolor=_SHADOW, linewidth=0, zorder=_GROUND)
        self._faces = [
            polygon(edgecolor=INK, linewidth=0.8, zorder=_SOLID, joinstyle="round") for _ in self._solid.faces
        ]
        self._shadows = [
            self._line(color=_SHADOW, linewidth=0.7 * self._width[2], zorder=_GROUND) for _ in range(robot.legs)
        ]
        self._edges, self._links = self._make_links(INK, extra=1.6), self._make_links(None, extra=0.0)
        self._joints = [[self._dots("o", 0.62 * self._width[2], "white", INK) for _ in range(3)] for _ in self._colours]
        self._feet = [self._dots("o", self._foot, colour, INK) for colour in self._colours]
        self._plumb = self._line(color=INK, linewidth=0.9, linestyle=(0, (2, 2)), zorder=_SOLID + _ORDER)
        self._com = self._dots("o", 7.0, "white", INK)
        self._com_down = self._dots("X", 8.0, INK, "white")
        self._com_down.set_zorder(_GROUND + 0.5)
        self._names = [self._name(leg) for leg in range(robot.legs)] if names else []

    def _points_per_metre(self) -> float:
        """Return the width of a metre in the figure, in points."""
        (left, right), box = self._axes.get_xlim(), self._axes.get_window_extent()
        return float(box.width / self._axes.figure.dpi * 72 / (right - left) * 1000)

    def _line(self, **style: Any) -> Line2D:
        (line,) = self._axes.plot([], [], solid_capstyle="round", **style)
        return line

    def _dots(self, marker: str, size: float, face: str, edge: str) -> Line2D:
        style: dict[str, Any] = {"markersize": size, "markerfacecolor": face, "markeredgecolor": edge}
        return self._line(marker=marker, linestyle="none", markeredgewidth=0.9, **style)

    def _make_links(self, colour: str | None, *, extra: float) -> list[list[Line2D]]:
        return [
            [self._line(color=colour or own, linewidth=width + extra) for width in self._width] for own in self._colours
        ]

    def _name(self, leg: int) -> Any:
        return self._axes.annotate(
            self._robot.leg_codes[leg],
            (0, 0),
            xytext=(0, 0.5 * self._width[1] + 8),
            textcoords="offset points",
            ha="center",
            va="center",
            color=self._colours[leg],
            fontweight="bold",
            path_effects=halo(),
            zorder=_SOLID + _ORDER + 1,
        )

    def update(self, sample: Sample) -> None:
        """Move the robot.

        Parameters
        ----------
        sample : Sample
            State to draw.
        """
        self._update_body(sample)
        self._update_legs(sample)
        if self._has_shadows:
            self._update_ground(sample)

    def _project(self, points: Float[np.ndarray, "*#batch 3"]) -> Float[np.ndarray, "*batch 2"]:
        return self._view.project(points * 1000)

    def _zorder(self, points: Float[np.ndarray, "*#batch 3"], sample: Sample) -> Float[np.ndarray, "*batch"]:
        """Return the zorder of points: `_SOLID` for the body's origin, and more for points nearer to the eye."""
        depth = self._view.depth(points - np.asarray(sample.body.position))
        zorder: np.ndarray = _SOLID + _ORDER * np.clip(depth / (4 * self._reach), -0.99, 0.99)
        return zorder

    def _update_body(self, sample: Sample) -> None:
        corners = np.asarray(sample.body @ self._solid.corners)
        projected = self._project(corners)
        for face, patch in zip(self._solid.faces, self._faces, strict=True):
            a, b, c = corners[list(face[:3])]
            normal = np.cross(b - a, c - b)
            normal = normal / np.linalg.norm(normal)
            patch.set_visible(bool(self._view.depth(normal) > 0))
            patch.set_xy(projected[list(face)])
            patch.set_facecolor(_shade(_BODY, 0.78 + 0.3 * normal[2] + 0.1 * normal[0]))

    def _update_legs(self, sample: Sample) -> None:
        projected = self._project(sample.points)
        link_zorder = self._zorder((sample.points[:, 1:] + sample.points[:, :-1]) / 2, sample)
        # The coxa is ordered by its axis, which is fixed to the body: this avoids flicker.
        link_zorder[:, 0] = self._zorder(sample.points[:, 0], sample)
        for leg in range(self._robot.legs):
            for link in range(3):
                x, y = projected[leg, link : link + 2].T
                for line, step in ((self._edges[leg][link], 0.0), (self._links[leg][link], _STEP)):
                    line.set_data(x, y)
                    line.set_zorder(link_zorder[leg, link] + step)
            for joint, dot in enumerate(self._joints[leg]):
                dot.set_data(*projected[leg, joint : joint + 1].T)
                dot.set_zorder(link_zorder[leg, max(joint - 1, 0) : joint + 1].max() + 2 * _STEP)
            self._feet[leg].set_data(*projected[leg, 3:].T)
            self._feet[leg].set_zorder(link_zorder[leg, 2] + 2 * _STEP)
            self._feet[leg].set_markerfacecolor(self._colours[leg] if sample.contacts[leg] else "white")
        for name, leg_points in zip(self._names, projected, strict=False):
            name.xy = tuple(leg_points[np.argmax(leg_points[:, 1])])

    def _update_ground(self, sample: Sample) -> None:
        on_ground = np.array([1.0, 1.0, 0.0])
        for line, leg in zip(self._shadows, self._project(sample.points * on_ground), strict=True):
            line.set_data(*leg.T)
        corners = np.asarray(sample.body @ self._solid.corners) * on_ground
        outline = support_polygon(corners, np.ones(len(corners), dtype=bool))
        self._shadow.set_xy(self._project(np.column_stack([outline, np.zeros(len(outline))])))
        hull = support_polygon(sample.support, np.ones(len(sample.support), dtype=bool))
        self._support.set_visible(len(hull) > 1)
        if len(hull) > 1:
            self._support.set_xy(self._project(np.column_stack([hull, np.zeros(len(hull))])))
        self._support.set_color(_STABLE if sample.margin >= 0 else WARNING)
        com = self._project(np.array([sample.com, sample.com * on_ground]))
        self._plumb.set_data(*com.T)
        self._com.set_data(*com[:1].T)
        self._com.set_zorder(_SOLID + _ORDER)
        self._com_down.set_data(*com[1:].T)


def _shade(colour: str, light: float) -> tuple[float, float, float]:
    from matplotlib.colors import to_rgb

    red, green, blue = (min(1.0, max(0.0, channel * light)) for channel in to_rgb(colour))
    return red, green, blue
