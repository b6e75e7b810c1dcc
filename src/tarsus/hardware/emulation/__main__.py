"""Emulated servos as a process of their own: ``python -m tarsus.hardware.emulation feetech-sts 1-18``."""

from __future__ import annotations

import argparse
import sys
import time

from tarsus.errors import TarsusError
from tarsus.hardware.bus.registry import BUSES
from tarsus.hardware.emulation.registry import emulate
from tarsus.hardware.transport.pty import PtyServer

__all__ = ["main"]


def main(arguments: list[str] | None = None) -> int:
    """Serve emulated servos behind a pseudo-terminal, whose path is printed, until the process is ended.

    Parameters
    ----------
    arguments : list of str, optional
        Arguments of the command line.
    """
    parser = argparse.ArgumentParser(prog="python -m tarsus.hardware.emulation", description=__doc__)
    parser.add_argument("bus", choices=[name for name, kind in BUSES.items() if kind.transport == "serial"])
    parser.add_argument("ids", nargs="?", default="1-18", help="first and last id or channel, such as 1-18")
    parser.add_argument("--baud", type=int, help="bits per second")
    parser.add_argument("--return-delay", type=float, help="of Dynamixel servos, in microseconds; 500 as delivered")
    parser.add_argument("--seconds", type=float, help="how long; until Ctrl-C if left out")
    options = parser.parse_args(arguments)
    first, _, last = options.ids.partition("-")
    try:
        ids = range(int(first), int(last or first) + 1)
        line: dict[str, float] = {"baud": options.baud} if options.baud else {}
        if options.return_delay is not None:
            line["return_delay"] = options.return_delay * 1e-6
        with PtyServer(emulate(options.bus, ids, **line)) as server:
            sys.stdout.write(f"{server.port}\n")
            sys.stdout.flush()
            time.sleep(1e9 if options.seconds is None else options.seconds)
    except KeyboardInterrupt:
        pass
    except (TarsusError, ValueError) as error:
        sys.stderr.write(f"{error}\n")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
