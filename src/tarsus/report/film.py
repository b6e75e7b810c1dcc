"""The frames of an animation: one picture whose artists are moved."""

from __future__ import annotations

import math
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
    """One picture whose artists are moved from frame to frame.

    Parameters
    ----------
    motion : Motion
        The motion.
    view : View
        From where it is looked at.
    size : tuple of int
        Width and height [pixels].
    """

    def __init__(self, motion: Motion, *, view: View, size: tuple[int, int]) -> None:
        dpi = 100
        self.figure = new_figure(width=size[0] / dpi, height=size[1] / dpi, dpi=dpi, by_hand=True)
        self._canvas = cast("Any", self.figure.canvas)  # FigureCanvasAgg, whose methods have no types
        self.motion, self._view = motion, view
        strip = min(0.021 * motion.robot.legs, 0.3)
        self.axes = self.figure.add_axes((0.0, strip + 0.1, 1.0, 0.8 - strip))
        self.strip = self.figure.add_axes((0.075, 0.105, 0.9, strip))
        every = max(1, len(motion.time) // 60)
        frame_axes(self.axes, [self._sample(i) for i in range(0, len(motion.time), every)], view=view)
        self._home = view.project(self._sample(0).centre * 1000)
        self._limits = np.array([self.axes.get_xlim(), self.axes.get_ylim()])
        self._ground = Ground(self.axes, view)
        self.drawing = RobotDrawing(self.axes, motion.robot, view=view, names=True)
        self.words = self.figure.text(0.015, 0.975, "", color=INK, fontsize=11, va="top")
        self._make_strip()

    def _make_strip(self) -> None:
        draw_stance(self.strip, self.motion)
        self.strip.set_xlim(0, max(self.motion.duration, 1e-9))
        self.strip.set_xlabel("time (s)", fontsize=8, labelpad=0)
        self.strip.tick_params(labelsize=7, length=2, pad=2)
        self.strip.spines[["top", "right"]].set_visible(False)
        self._now = self.strip.axvline(0, color=INK, linewidth=1.6)

    def _sample(self, moment: int) -> Sample:
        motion = self.motion
        return sample_of(
            motion.robot, motion.angles[moment], body=motion.body[moment], contacts=motion.contacts[moment]
        )

    def frame(self, moment: int) -> Image:
        """Return the picture of one sample.

        Parameters
        ----------
        moment : int
            Which sample of the motion.
        """
        from PIL import Image

        sample = self._sample(moment)
        moved = self._view.project(sample.centre * 1000) - self._home
        self.axes.set_xlim(self._limits[0] + moved[0])
        self.axes.set_ylim(self._limits[1] + moved[1])
        self._ground.update()
        self.drawing.update(sample)
        time = float(self.motion.time[moment])
        self._now.set_xdata([time, time])
        down = int(sample.contacts.sum())
        margin = f"{sample.margin * 1000:.0f} mm" if math.isfinite(sample.margin) else "none"
        name, gait = self.motion.robot.name, self.motion.gait.name
        self.words.set_text(f"{name}, {gait} gait\n{time:.2f} s   {down} feet down   stability margin {margin}")
        self._canvas.draw()
        return Image.fromarray(np.asarray(self._canvas.buffer_rgba())).convert("RGB")
