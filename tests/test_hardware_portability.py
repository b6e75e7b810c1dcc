"""Systems without what Linux and macOS have: pseudo-terminals, their modes, and hang-ups."""

import json
import subprocess
import sys

import pytest

# As on Windows: no such modules and functions, and pyserial's driver for POSIX systems does not import.
WITHOUT = """
import os, select, signal, sys, types

for name in ("fcntl", "grp", "pty", "pwd", "resource", "termios", "tty"):
    sys.modules[name] = None
for name in ("fork", "forkpty", "geteuid", "getuid", "openpty", "set_blocking", "ttyname"):
    delattr(os, name)
del os.O_NONBLOCK, select.epoll, select.poll, signal.SIGHUP


def sockets_only(*_):
    raise OSError("An operation was attempted on something that is not a socket")


select.select = sockets_only


class Serial:
    # Behaves like pyserial's driver for Windows: a read waits for as long as its timeout says.
    def __init__(self, port, baud, *, timeout, write_timeout, exclusive):
        assert exclusive is False
        from tarsus import hardware
        self._line = hardware.MemoryTransport(hardware.emulate("feetech-sts", range(1, 19)), hardware.SystemClock())
        self._waiting, self.timeout = b"", timeout

    @property
    def in_waiting(self):
        self._waiting += self._line.discard()
        return len(self._waiting)

    def read(self, count):
        if not self.in_waiting and count:
            self._waiting += self._line.read(self.timeout)
        data, self._waiting = self._waiting[:count], self._waiting[count:]
        return data

    def write(self, data):
        self._line.write(data)

    def close(self):
        pass


class Errors(Exception):
    pass


serial = types.ModuleType("serial")
serial.Serial, serial.SerialException = Serial, Errors
sys.modules["serial"] = serial
import tarsus.hardware.transport.serial as driver
driver._POSIX = False
"""


def without_posix(program, *arguments):
    return subprocess.run(
        [sys.executable, "-c", WITHOUT + program, *arguments], capture_output=True, text=True, check=False
    )


def test_all_of_hardware_and_the_command_line_import_without_posix():
    done = without_posix(
        "import tarsus.cli\nfrom tarsus import hardware\nprint(len([getattr(hardware, n) for n in hardware.__all__]))"
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert int(done.stdout) > 20


def test_servos_answer_on_a_serial_port_without_posix():
    program = """
from tarsus import hardware
bus = hardware.open_bus("feetech-sts", "COM3")
print(sorted(bus.scan(range(1, 19)).values) == list(range(1, 19)))
bus.write_goals({1: 2100})
print(dict(bus.read_positions((1, 2)).require()))
bus.close()
"""
    done = without_posix(program)
    assert (done.returncode, done.stdout) == (0, "True\n{1: 2048.0, 2: 2048.0}\n"), done.stderr


RUN = "from tarsus.cli import main; main()"


def test_the_emulated_robot_walks_without_pseudo_terminals():
    done = without_posix(RUN, "run", "strider", "--bus", "emulated", "--duration", "0.2", "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["problems"] == []


@pytest.mark.parametrize(
    ("program", "arguments", "code", "message"),
    [
        (RUN, ("run", "strider", "--keys"), 2, "keys need a terminal of Linux or macOS; use --scenario"),
        (RUN, ("run", "strider", "--gamepad"), 2, "no gamepad at /dev/input/js0"),
        (
            "from tarsus.hardware.emulation.__main__ import main; sys.exit(main())",
            ("lx16a", "1-3"),
            1,
            "expected a system with pseudo-terminals, received",
        ),
    ],
)
def test_what_needs_posix_says_so(program, arguments, code, message):
    done = without_posix(program, *arguments)
    assert done.returncode == code
    assert message in done.stderr
    assert "Traceback" not in done.stderr
