"""The keyboard of a terminal as an input device."""

from __future__ import annotations

import contextlib
import os
import re
import select
import sys
from types import TracebackType
from typing import Any, Self

from tarsus.errors import InputError
from tarsus.hardware.live.live_commands import Input

__all__ = ["KEYS", "Keyboard"]

KEYS: dict[str, tuple[Input, str]] = {
    "w": (Input(twist=(1, 0, 0)), "forward"),
    "s": (Input(twist=(-1, 0, 0)), "backward"),
    "a": (Input(twist=(0, 0, 1)), "turn left"),
    "d": (Input(twist=(0, 0, -1)), "turn right"),
    "q": (Input(twist=(0, 1, 0)), "left"),
    "e": (Input(twist=(0, -1, 0)), "right"),
    " ": (Input(twist=(0, 0, 0)), "stop"),
    "r": (Input(body_height=0.005), "body up"),
    "f": (Input(body_height=-0.005), "body down"),
    "u": (Input(state="standing"), "stand up"),
    "j": (Input(state="lying"), "sit down"),
    "1": (Input(gait="tripod"), "tripod"),
    "2": (Input(gait="ripple"), "ripple"),
    "3": (Input(gait="wave"), "wave"),
    "x": (Input(quit=True), "end"),
}
"""Keys, what they command, and what that is called."""

# Terminals have two modes, in which arrows send different sequences.
_ARROWS = {f"\x1b{mode}{arrow}": key for mode in "[O" for arrow, key in zip("ABDC", "wsad", strict=True)}
# What other keys send, also together with Alt, contains characters that are keys. A stop after the escape key is one.
_SEQUENCE = re.compile(r"\x1b+(?:\[[0-?]*[ -/]*[@-~]|O[0-?]*[@-~]|(?= )|[^\x1b\[O])")


class Keyboard:
    """Keys of a terminal, one by one as they are pressed; keep a key down to walk.

    Raises
    ------
    InputError
        If the standard input is no terminal, or the system has none of this kind.
    """

    def __init__(self) -> None:
        try:
            import termios
        except ImportError:
            raise InputError("keys need a terminal of Linux or macOS; use --scenario or --gamepad") from None
        if not sys.stdin.isatty():
            raise InputError("keys need a terminal: the standard input is none; use --scenario or --gamepad")
        self._file = sys.stdin.fileno()
        self._termios: Any = termios
        self._before: Any = None
        self._begun = ""

    def __enter__(self) -> Self:
        """Take keys without waiting for the end of a line."""
        import tty

        self._before = self._termios.tcgetattr(self._file)
        tty.setcbreak(self._file)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Give the terminal back as it was."""
        # A terminal that was closed takes nothing more.
        with contextlib.suppress(self._termios.error):
            self._termios.tcsetattr(self._file, self._termios.TCSADRAIN, self._before)

    def read(self) -> list[Input] | None:
        """Return what was pressed since the last time; None where the terminal is gone."""
        if not select.select([self._file], [], [], 0)[0]:
            # A sequence comes at once, so that was the escape key: it must not swallow the next one.
            self._begun = ""
            return []
        try:
            data = os.read(self._file, 1024)
        except OSError:
            return None
        if not data:
            return None
        text = self._begun + data.decode("utf-8", "ignore")
        keys, escape, begun = _SEQUENCE.sub(lambda found: _ARROWS.get(found[0], ""), text).partition("\x1b")
        self._begun = escape + begun
        return [KEYS[key][0] for key in keys if key in KEYS]
