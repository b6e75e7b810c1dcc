"""Frames of an animation, rendered from one figure."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from tarsus.gait.motion import Motion
from tarsus.report.drawing import RobotDrawing
from tarsus.report.gait_diagram import draw_stance
from tarsus.report.ground import Ground
from tarsus.report.sample import Sample, sample_of
from tarsus.report.skeleton import frame_axes
from tarsus.report.style import INK, new_figure
from tarsus.report.view import View

if TYPE_CHECKING:
    from PIL.Image import Image

__all__ = ["Film"]


class Film:
    """Renderer of the frames of an animation.

    Parameters
    ----------
    motion : Motion
        The motion.
    view : View
        Direction of view.
    size : tuple of int
        Width and height [pixels].
    height : callable, optional
        Height of the ground [m] at x, y [m]; flat ground where left out.
    """

    def __init__(
        self, motion: Motion, *, view: View, size: tuple[int, int], height: Callable[[Any, Any], Any] | None = None
    ) -> None:
        dpi = 100
        self.figure = new_figure(width=size[0] / dpi, height=size[1] / dpi, dpi=dpi, manual_layout=True)
        self._canvas = cast("Any", self.figure.canvas)  # FigureCanvasAgg, whose methods have no types
        self.motion, self._view, self._level = motion, view, height is None
        strip = min(0.021 * motion.robot.legs, 0.3)
        self.axes = self.figure.add_axes((0.0, strip + 0.1, 1.0, 0.8 - strip))
        self.strip = self.figure.add_axes((0.075, 0.105, 0.9, strip))
        every = max(1, len(motion.time) // 60)
        frame_axes(self.axes, [self._sample(i) for i in range(0, len(motion.time), every)], view=view)
        self._origin = view.project(self._sample(0).centre * 1000)
        self._limits = np.array([self.axes.get_xlim(), self.axes.get_ylim()])
        self._ground = Ground(self.axes, view, height)
        self.drawing = RobotDrawing(self.axes, motion.robot, view=view, names=True, shadows=self._level)
        self.caption = self.figure.text(0.015, 0.975, "", color=INK, fontsize=11, va="top")
        self._make_strip()

    def _make_strip(self) -> None:
        draw_stance(self.strip, self.motion)
        self.strip.set_xlim(0, max(self.motion.duration, 1e-9))
        self.strip.set_xlabel("time (s)", fontsize=8, labelpad=0)
        self.strip.tick_params(labelsize=7, length=2, pad=2)
        self.strip.spines[["top", "right"]].set_visible(False)
        self._time_line = self.strip.axvline(0, color=INK, linewidth=1.6)

    def _sample(self, sample_index: int) -> Sample:
        motion = self.motion
        return sample_of(
            motion.robot,
            motion.angles[sample_index],
            body=motion.body[sample_index],
            contacts=motion.contacts[sample_index],
        )

    def frame(self, sample_index: int) -> Image:
        """Render one sample.

        Parameters
        ----------
        sample_index : int
            Index of the sample in the motion.
        """
        from PIL import Image

        sample = self._sample(sample_index)
        shift = self._view.project(sample.centre * 1000) - self._origin
        self.axes.set_xlim(self._limits[0] + shift[0])
        self.axes.set_ylim(self._limits[1] + shift[1])
        self._ground.update()
        self.drawing.update(sample)
        time = float(self.motion.time[sample_index])
        self._time_line.set_xdata([time, time])
        feet_down = int(sample.contacts.sum())
        # The stability margin is left out on terrain, where contacts at different heights span no support polygon.
        margin = ""
        if self._level:
            distance = f"{sample.margin * 1000:.0f} mm" if math.isfinite(sample.margin) else "none"
            margin = f"   stability margin {distance}"
        name, gait = self.motion.robot.name, self.motion.gait.name
        self.caption.set_text(f"{name}, {gait} gait\n{time:.2f} s   {feet_down} feet on the ground{margin}")
        self._canvas.draw()
        return Image.fromarray(np.asarray(self._canvas.buffer_rgba())).convert("RGB")
