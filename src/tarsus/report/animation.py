"""Animation of a walk: an animated GIF in real time."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.motion import Motion
from tarsus.report.film import Film
from tarsus.report.video import write_video
from tarsus.report.view import View

if TYPE_CHECKING:
    from jaxtyping import Float
    from PIL.Image import Image

__all__ = ["MAX_DURATION", "animate", "frame_times"]

MAX_DURATION = 20.0
"""Longest part of a walk to animate [s]; longer animations would make very large files."""

_VIEW = View()
_COLOURS = 64
# GIF frame durations are multiples of 10 ms: 60 ms is 16.7 frames per second, 80 ms 12.5.
_FRAME_MS, _LONG_FRAME_MS = 60, 80
_LONG = 8.0


def animate(
    motion: Motion,
    path: str | os.PathLike[str],
    *,
    max_duration: float = MAX_DURATION,
    view: View = _VIEW,
    size: tuple[int, int] = (640, 500),
    height: Callable[[Any, Any], Any] | None = None,
    progress: Callable[[float], None] | None = None,
) -> int:
    """Write a motion as an animated GIF in real time, or as a video where the path ends in ``.mp4``.

    The view follows the robot over a ground grid of 100 mm. It shows the feet on the ground (filled), the support
    polygon, the centre of mass above it, the time and the gait diagram.

    Parameters
    ----------
    motion : Motion
        The motion.
    path : path
        Output file.
    max_duration : float
        Duration to show, from the start of the motion [s].
    view : View
        Direction of view.
    size : tuple of int
        Width and height [pixels].
    height : callable, optional
        Height of the ground [m] at x, y [m]; flat ground where left out.
    progress : callable, optional
        Called after every frame with the completed fraction, up to 1.

    Returns
    -------
    int
        The number of frames.

    Raises
    ------
    InputError
        If the file can't be written, or `max_duration` is not positive.
    TarsusError
        If matplotlib is not installed, or imageio-ffmpeg for a video.
    """
    times, duration = frame_times(motion, max_duration=max_duration)
    film = Film(motion, view=view, size=size, height=height)
    if os.fspath(path).lower().endswith(".mp4"):
        pictures = (film.frame(_sample_at(motion, float(time))) for time in times)
        return write_video(pictures, path, rate=1000 / duration, number=len(times), progress=progress)
    from PIL.Image import Dither

    frames: list[Image] = []
    palette = _palette([film.frame(_sample_at(motion, fraction * float(times[-1]))) for fraction in (0.0, 0.3, 0.6)])
    for number, time in enumerate(times):
        frames.append(film.frame(_sample_at(motion, float(time))).quantize(palette=palette, dither=Dither.NONE))
        if progress is not None:
            progress((number + 1) / len(times))
    # The last frame is shown for a second before the loop restarts.
    durations = [duration] * (len(frames) - 1) + [1000]
    try:
        frames[0].save(path, format="GIF", save_all=True, append_images=frames[1:], duration=durations, loop=0)
    except OSError as error:
        raise InputError(f"{path} can't be written: {error.strerror or error}") from None
    return len(frames)


def frame_times(motion: Motion, *, max_duration: float = MAX_DURATION) -> tuple[Float[np.ndarray, "n"], int]:
    """Return the times of the frames, from the start [s], and the duration of a frame [ms].

    Parameters
    ----------
    motion : Motion
        The motion.
    max_duration : float
        Duration to show [s].

    Raises
    ------
    InputError
        If `max_duration` is not positive.
    """
    if not max_duration > 0:
        raise InputError(f"max_duration is {max_duration} s; it must be greater than 0")
    shown = min(motion.duration, max_duration)
    duration = _FRAME_MS if shown <= _LONG else _LONG_FRAME_MS
    count = math.ceil(shown * 1000 / duration - 1e-9) + 1
    return np.minimum(np.arange(count) * duration / 1000, shown), duration


def _palette(pictures: Sequence[Image]) -> Image:
    """Return a palette from some frames, with pure white added first so that the background is not tinted."""
    from PIL import Image

    pixels = np.concatenate([np.asarray(picture).reshape(-1, 3) for picture in pictures])
    pixels = pixels[(pixels < 250).any(1)]
    colours = Image.fromarray(pixels[None]).quantize(_COLOURS - 1).getpalette() or []
    palette = Image.new("P", (1, 1))
    palette.putpalette([255, 255, 255, *colours])
    return palette


def _sample_at(motion: Motion, time: float) -> int:
    # A frame between two samples shows the later one.
    return min(int(np.searchsorted(motion.time, time - 1e-9)), len(motion.time) - 1)
