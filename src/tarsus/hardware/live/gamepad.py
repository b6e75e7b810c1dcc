"""A gamepad as an input device: the joystick interface of Linux."""

from __future__ import annotations

import os
import struct
from types import TracebackType
from typing import Self

from tarsus.errors import InputError
from tarsus.hardware.live.live_commands import Input

__all__ = ["Gamepad"]

# struct js_event of linux/joystick.h: time, value, type, number.
_EVENT = struct.Struct("IhBB")
_BUTTON, _AXIS, _INITIAL = 0x01, 0x02, 0x80
_FULL = 32767.0
# Axes of common pads in Linux: left stick, right stick; sticks point down and right for positive values.
_LEFT_X, _LEFT_Y, _RIGHT_X = 0, 1, 3
_BUTTONS = {
    0: Input(state="standing"),
    1: Input(state="lying"),
    2: Input(gait="tripod"),
    3: Input(gait="ripple"),
    4: Input(body_height=-0.005),
    5: Input(body_height=0.005),
    7: Input(quit=True),
}
# Sticks that nobody touches rest within this share of the middle.
_DEAD_ZONE = 0.12


class Gamepad:
    """The sticks and buttons of a gamepad. As long as it is connected, it counts as heard.

    Parameters
    ----------
    path : str
        Its device.

    Raises
    ------
    InputError
        If it can't be opened.
    """

    def __init__(self, path: str = "/dev/input/js0") -> None:
        try:
            self._file = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
        except (OSError, ValueError, AttributeError) as error:
            reason = getattr(error, "strerror", None) or error
            raise InputError(f"no gamepad at {path}: {reason}; plug it in, or name its device") from None
        self._axes = dict.fromkeys((_LEFT_X, _LEFT_Y, _RIGHT_X), 0.0)
        self._rest = b""

    def __enter__(self) -> Self:
        """Return the gamepad itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close it."""
        os.close(self._file)

    def read(self) -> list[Input] | None:
        """Return what was done since the last time; None where the gamepad is gone."""
        try:
            data = os.read(self._file, 64 * _EVENT.size)
        except BlockingIOError:
            data = b""
        except OSError:
            return None
        else:
            if not data:
                return None
        self._rest += data
        pressed = []
        whole = len(self._rest) // _EVENT.size * _EVENT.size
        for _, value, kind, number in _EVENT.iter_unpack(self._rest[:whole]):
            if kind & ~_INITIAL == _AXIS and number in self._axes:
                share = value / _FULL
                self._axes[number] = 0.0 if abs(share) < _DEAD_ZONE else max(-1.0, min(share, 1.0))
            elif kind == _BUTTON and value and number in _BUTTONS:
                pressed.append(_BUTTONS[number])
        self._rest = self._rest[whole:]
        # Sticks report changes only, so that their last values hold.
        twist = (-self._axes[_LEFT_Y], -self._axes[_LEFT_X], -self._axes[_RIGHT_X])
        return [Input(twist=twist), *pressed]
