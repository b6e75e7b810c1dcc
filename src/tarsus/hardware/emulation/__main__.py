"""Emulated servos as a process of their own: ``python -m tarsus.hardware.emulation feetech-sts 1-18``."""

from __future__ import annotations

import argparse
import sys
import time

from tarsus.errors import InputError, TarsusError
from tarsus.hardware.bus.registry import BUSES
from tarsus.hardware.calibration.bus_commands import BUS_COMMANDS
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
    parser.add_argument("ids", nargs="?", help="first and last id or channel; 1-18, or 0-17 of a board")
    parser.add_argument("--baud", type=int, help="bits per second")
    parser.add_argument("--return-delay", type=float, help="of Dynamixel servos, in microseconds; 500 as delivered")
    parser.add_argument("--seconds", type=float, help="how long; until Ctrl-C if left out")
    options = parser.parse_args(arguments)
    try:
        line: dict[str, float] = {}
        if options.baud is not None:
            line["baud"] = _within("--baud", options.baud, (300, 10_000_000), "bits per second")
        if options.return_delay is not None:
            if not options.bus.startswith("dynamixel"):
                raise InputError(f"--return-delay is for Dynamixel servos, not for {options.bus}")
            line["return_delay"] = _within("--return-delay", options.return_delay, (0, 508), "us") * 1e-6
        if options.seconds is not None:
            _within("--seconds", options.seconds, (0, 1e9), "s")
        with PtyServer(emulate(options.bus, _ids(options.bus, options.ids), **line)) as server:
            sys.stdout.write(f"{server.port}\n")
            sys.stdout.flush()
            time.sleep(1e9 if options.seconds is None else options.seconds)
    except KeyboardInterrupt:
        pass
    except TarsusError as error:
        sys.stderr.write(f"{error}\n")
        return 1
    return 0


def _within(option: str, value: float, bounds: tuple[float, float], unit: str) -> float:
    if not bounds[0] <= value <= bounds[1]:
        raise InputError(f"{option} is {value:g} {unit}; it must be from {bounds[0]:g} to {bounds[1]:g} {unit}")
    return value


def _ids(bus: str, given: str | None) -> range:
    least, greatest = BUS_COMMANDS[bus].numbers
    text = given or ("1-18" if BUS_COMMANDS[bus].feedback else "0-17")
    first, dash, last = text.partition("-")
    if first.isdecimal() and (last if dash else first).isdecimal():
        ids = range(int(first), int(last or first) + 1)
        if ids and least <= ids[0] and ids[-1] <= greatest:
            return ids
    raise InputError(f"ids are {text!r}; on {bus} they must be the first and the last of {least} to {greatest}: 1-18")


if __name__ == "__main__":
    sys.exit(main())
