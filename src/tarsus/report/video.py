"""Video files: MP4 by FFmpeg, which the package imageio-ffmpeg contains."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from tarsus.errors import InputError, TarsusError

if TYPE_CHECKING:
    from PIL.Image import Image

__all__ = ["write_video"]


def write_video(
    pictures: Iterable[Image],
    path: str | os.PathLike[str],
    *,
    rate: float,
    number: int,
    progress: Callable[[float], None] | None = None,
) -> int:
    """Write pictures as an MP4 file (H.264) that browsers play.

    Parameters
    ----------
    pictures : iterable of Image
        The frames, of the same even width and height.
    path : path
        Output file.
    rate : float
        Frames per second [1/s].
    number : int
        Number of frames, for the progress.
    progress : callable, optional
        Called after every frame with the completed fraction, up to 1.

    Returns
    -------
    int
        The number of frames.

    Raises
    ------
    TarsusError
        If imageio-ffmpeg is not installed.
    InputError
        If the file can't be written.
    """
    try:
        import imageio_ffmpeg
    except ImportError:
        raise TarsusError(
            "videos need imageio-ffmpeg: pip install 'tarsus[sim]'; or write a GIF (a name that ends in .gif)"
        ) from None
    writer, written = None, 0
    try:
        for picture in pictures:
            if writer is None:
                options = {"fps": rate, "quality": 7, "macro_block_size": 2, "ffmpeg_log_level": "error"}
                writer = imageio_ffmpeg.write_frames(os.fspath(path), picture.size, **options)
                writer.send(None)
            writer.send(picture.tobytes())
            written += 1
            if progress is not None:
                progress(written / number)
    except OSError as error:
        raise InputError(f"{os.fspath(path)} can't be written: {error.strerror or 'FFmpeg failed'}") from None
    finally:
        if writer is not None:
            writer.close()
    return written
