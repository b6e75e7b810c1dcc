"""Signals that end a program: each is handled as Ctrl-C, so that servos are released."""

from __future__ import annotations

import contextlib
import os
import signal
import stat
import threading
from collections.abc import Iterator
from types import FrameType

__all__ = ["as_interrupts"]

_SIGNALS = ("SIGHUP", "SIGTERM")
_OUTPUTS = (1, 2)


@contextlib.contextmanager
def as_interrupts() -> Iterator[None]:
    """Treat a closed terminal (SIGHUP) and a request to end (SIGTERM) as Ctrl-C.

    Output to a closed terminal is discarded afterwards, as writing to it would be an error.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def interrupt(number: int, _frame: FrameType | None) -> None:
        if number != signal.SIGTERM:
            _leave_terminal()
        raise KeyboardInterrupt

    names = [name for name in _SIGNALS if hasattr(signal, name)]
    before = {name: signal.signal(getattr(signal, name), interrupt) for name in names}
    try:
        yield
    finally:
        for name, handler in before.items():
            signal.signal(getattr(signal, name), handler)


def _leave_terminal() -> None:
    nothing = os.open(os.devnull, os.O_WRONLY)
    for output in _OUTPUTS:
        # Only terminals are replaced: files and pipes still take output.
        with contextlib.suppress(OSError):
            if stat.S_ISCHR(os.fstat(output).st_mode):
                os.dup2(nothing, output)
    os.close(nothing)
