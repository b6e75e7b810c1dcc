"""A walk as a picture that moves: an animated GIF, in real time."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.motion import Motion
from tarsus.report.film import Film
from tarsus.report.view import View

if TYPE_CHECKING:
    from PIL.Image import Image

__all__ = ["LONGEST", "animate", "frame_times"]

LONGEST = 20.0
"""So much of a walk is shown [s]: a longer one would make a file that nobody opens."""

_VIEW = View()
_COLOURS = 64
# GIF counts time in hundredths of a second: 60 ms is 16.7 frames a second, 80 ms 12.5.
_FRAME_MS, _LONG_FRAME_MS = 60, 80
_LONG = 8.0


def animate(
    motion: Motion,
    path: str | os.PathLike[str],
    *,
    longest: float = LONGEST,
    view: View = _VIEW,
    size: tuple[int, int] = (640, 500),
    progress: Callable[[float], None] | None = None,
) -> int:
    """Write a motion as an animated GIF in real time.

    The picture follows the robot over a ground grid of 100 mm, and shows the feet that are down (filled), their
    support polygon, the centre of mass over it, the time and the gait diagram.

    Parameters
    ----------
    motion : Motion
        The motion.
    path : path
        Where to write it.
    longest : float
        How much of the motion is shown, from its start [s].
    view : View
        From where it is looked at.
    size : tuple of int
        Width and height [pixels].
    progress : callable, optional
        Called after every frame with the share that is done, up to 1.

    Returns
    -------
    int
        The number of frames.

    Raises
    ------
    InputError
        If the file can't be written, or `longest` is not positive.
    TarsusError
        If matplotlib is not installed.
    """
    times, duration = frame_times(motion, longest=longest)
    film = Film(motion, view=view, size=size)
    from PIL.Image import Dither

    frames: list[Image] = []
    palette = _palette([film.frame(_sample_at(motion, share * float(times[-1]))) for share in (0.0, 0.3, 0.6)])
    for number, time in enumerate(times):
        frames.append(film.frame(_sample_at(motion, float(time))).quantize(palette=palette, dither=Dither.NONE))
        if progress is not None:
            progress((number + 1) / len(times))
    # The last frame stays for a second, before the walk begins anew.
    durations = [duration] * (len(frames) - 1) + [1000]
    try:
        frames[0].save(path, format="GIF", save_all=True, append_images=frames[1:], duration=durations, loop=0)
    except OSError as error:
        raise InputError(f"{path} can't be written: {error.strerror or error}") from None
    return len(frames)


def frame_times(motion: Motion, *, longest: float = LONGEST) -> tuple[np.ndarray[Any, Any], int]:
    """Return when the frames are, from the start [s], and how long each is shown [ms].

    Parameters
    ----------
    motion : Motion
        The motion.
    longest : float
        How much of it is shown [s].

    Raises
    ------
    InputError
        If `longest` is not positive.
    """
    if not longest > 0:
        raise InputError(f"longest is {longest} s; it must be greater than 0")
    shown = min(motion.duration, longest)
    duration = _FRAME_MS if shown <= _LONG else _LONG_FRAME_MS
    count = math.ceil(shown * 1000 / duration - 1e-9) + 1
    return np.minimum(np.arange(count) * duration / 1000, shown), duration


def _palette(pictures: Sequence[Image]) -> Image:
    """Return the colours of some frames, pure white first: the eye sees the least tint of a whole ground."""
    from PIL import Image

    pixels = np.concatenate([np.asarray(picture).reshape(-1, 3) for picture in pictures])
    pixels = pixels[(pixels < 250).any(1)]
    colours = Image.fromarray(pixels[None]).quantize(_COLOURS - 1).getpalette() or []
    palette = Image.new("P", (1, 1))
    palette.putpalette([255, 255, 255, *colours])
    return palette


def _sample_at(motion: Motion, time: float) -> int:
    # Frames may fall between samples: the next one is taken, at most one sample late.
    return min(int(np.searchsorted(motion.time, time - 1e-9)), len(motion.time) - 1)
