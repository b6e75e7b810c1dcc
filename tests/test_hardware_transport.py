"""Transports: pseudo-terminals, serial ports, I2C, and clocks."""

import errno
import os
import subprocess
import sys
import time
import types

import pytest

from tarsus import hardware
from tarsus.errors import NoAnswerError, PortError
from tarsus.hardware.emulation.__main__ import main
from tarsus.hardware.transport.i2c import SmbusTransport
from tarsus.hardware.transport.served import ServedTransport

IDS = range(1, 19)


def often(action):
    for _ in range(999):
        action()


def test_a_pseudo_terminal_is_opened_like_a_serial_port():
    device = hardware.emulate("feetech-sts", IDS)
    with hardware.PtyServer(device) as server:
        bus = hardware.open_bus("feetech-sts", server.port, timeout=1.0)
        assert bus.read_positions(IDS).require() == dict.fromkeys(IDS, 2048.0)
        server.close()
        with pytest.raises(PortError, match="expected an open port"):
            often(lambda: bus.read_positions((1,)))
        bus.close()
        bus.close()


def test_pulling_the_plug_is_a_port_error():
    device = hardware.emulate("maestro", IDS)
    with hardware.PtyServer(device) as server:
        bus = hardware.open_bus("maestro", server.port, timeout=1.0)
        assert bus.ping(3)
        device.faults.unplugged = True
        with pytest.raises(PortError):
            often(lambda: bus.ping(3))


def test_a_pseudo_terminal_takes_as_long_as_the_wire_would():
    device = hardware.emulate("dynamixel-x", IDS, baud=9600)
    with hardware.PtyServer(device) as server:
        bus = hardware.open_bus("dynamixel-x", server.port, baud=9600, timeout=1.0)
        begin = bus._transport.now()
        bus.read_positions((1, 2, 3)).require()
        # At least that; a busy machine takes longer.
        assert bus._transport.now() - begin >= 0.99 * bus.timing((1, 2, 3)).positions


class Busy:
    """An emulated device that a busy computer gives its turn late."""

    def __init__(self, device):
        self._device = device

    def __getattr__(self, name):
        return getattr(self._device, name)

    def receive(self, data, now):
        time.sleep(0.06)
        return self._device.receive(data, now)


def test_emulated_servos_whose_turn_is_late_are_not_taken_for_silent():
    device = hardware.emulate("feetech-sts", IDS)
    with hardware.PtyServer(Busy(device)) as server:
        bus = hardware.bus_over("feetech-sts", ServedTransport(server, 1_000_000), timeout=0.02)
        bus.write_goals(dict.fromkeys(IDS, 2048.0))
        assert bus.read_positions(IDS).require() == dict.fromkeys(IDS, 2048.0)
        device.faults.missing = {3}
        answers = bus.read_positions((2, 3))
        assert (set(answers.values), [error.id for error in answers.errors]) == ({2}, [3])
        device.faults.late = {4: 0.5}
        assert [error.id for error in bus.read_positions((4,)).errors] == [4]
        device.faults.unplugged = True
        with pytest.raises(PortError):
            often(lambda: bus.read_positions((1,)))


def test_a_port_that_does_not_open_is_explained(tmp_path):
    with pytest.raises(PortError, match="Serial ports found"):
        hardware.SerialTransport("/dev/nowhere", 9600)
    with pytest.raises(PortError, match="received something that is no serial port"):
        hardware.SerialTransport(os.devnull, 9600)
    file = tmp_path / "port"
    file.write_bytes(b"")
    with pytest.raises(PortError, match="expected a port that opens"):
        hardware.SerialTransport(str(file), 9600)


def test_without_pyserial_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "serial", None)
    monkeypatch.setitem(sys.modules, "serial.tools", None)
    with pytest.raises(PortError, match="tarsus\\[hardware\\]"):
        hardware.SerialTransport("/dev/nowhere", 9600)
    with pytest.raises(PortError, match="tarsus\\[hardware\\]"):
        hardware.list_ports()


def test_ports_are_listed():
    assert all(isinstance(port, str) for port in hardware.list_ports())


class FakeMessage(list):
    """As much of smbus2's message as is used: an address, a direction and bytes."""

    @classmethod
    def write(cls, address, data):
        message = cls(data)
        message.address, message.reads = address, False
        return message

    @classmethod
    def read(cls, address, count):
        message = cls([0] * count)
        message.address, message.reads = address, True
        return message


class FakeBus:
    """An I2C bus of Linux with one device, in memory."""

    def __init__(self, path):
        if path == "/dev/i2c-9":
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), path)
        self.device = hardware.emulate("pca9685", range(18), addresses=(0x40,))
        self.fails = 0

    def i2c_rdwr(self, *messages):
        if self.fails or messages[0].address != 0x40:
            raise OSError(self.fails or errno.EREMOTEIO, "failed")
        if len(messages) == 1:
            self.device.write(0x40, bytes(messages[0]), 0.0)
        else:
            messages[1][:] = self.device.read(0x40, messages[0][0], len(messages[1]), 0.0)

    def close(self):
        pass


def test_boards_on_an_i2c_bus_of_linux(monkeypatch):
    monkeypatch.setitem(sys.modules, "smbus2", types.SimpleNamespace(SMBus=FakeBus, i2c_msg=FakeMessage))
    with pytest.raises(PortError, match="raspi-config"):
        hardware.open_bus("pca9685", "/dev/i2c-9")
    bus = hardware.open_bus("pca9685", "/dev/i2c-1", baud=100_000)
    assert bus.timing(range(16)).goals == pytest.approx((9 * 66 + 2) / 100_000)
    assert set(bus.scan((0, 15, 16)).values) == {0, 15}
    assert set(bus.scan((0, 15, 16)).values) == {0, 15}
    bus.write_goals({0: 1500, 1: 1000})
    device = bus._transport._bus.device
    assert [device.pulses[0], device.pulses[1]] == pytest.approx([1500, 1000], abs=3)
    with pytest.raises(NoAnswerError, match="0x41"):
        bus.write_goals({16: 1500})
    bus._transport._bus.fails = errno.ENODEV
    with pytest.raises(PortError, match="expected an open I2C bus"):
        bus.write_goals({0: 1500})
    with pytest.raises(PortError, match="expected an open I2C bus"):
        bus.ping(0)
    assert bus._transport.now() <= bus._transport.now()
    bus.close()


def test_without_smbus2_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "smbus2", None)
    with pytest.raises(PortError, match="tarsus\\[hardware\\]"):
        SmbusTransport("/dev/i2c-1")


def test_clocks():
    manual = hardware.ManualClock(5.0)
    manual.sleep(2.0)
    manual.sleep(-1.0)
    assert manual.now() == 7.0
    system = hardware.SystemClock()
    before = system.now()
    system.sleep(0.001)
    system.sleep(-1.0)
    assert system.now() >= before + 0.001


def test_servos_in_memory_run_on_the_machines_clock_too():
    bus, _ = hardware.emulated_bus("feetech-sts", IDS, clock=hardware.SystemClock())
    assert set(bus.read_positions((1, 2)).require()) == {1, 2}


def test_emulated_servos_run_as_a_process_of_their_own(capsys):
    command = [sys.executable, "-m", "tarsus.hardware.emulation", "lx16a", "3-5"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        bus = hardware.open_bus("lx16a", process.stdout.readline().strip(), timeout=1.0)
        assert bus.read_positions((3, 4, 5)).require() == dict.fromkeys((3, 4, 5), 500.0)
        process.kill()
        with pytest.raises(PortError):
            often(lambda: bus.read_positions((3,)))
    for bus, arguments in [("ssc32", ("0-17", "--baud", "9600")), ("servo2040", ()), ("lx16a", ("7",))]:
        assert main([bus, *arguments, "--seconds", "0"]) == 0
    assert capsys.readouterr().out.startswith("/dev/")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("ssc32", "all"), "ids are 'all'; on ssc32 they must be the first and the last of 0 to 31"),
        (("lx16a", "5-1"), "ids are '5-1'"),
        (("lx16a", "1-"), "ids are '1-'"),
        (("lx16a", "0-400"), "on lx16a they must be the first and the last of 0 to 253"),
        (("lx16a", "1-3", "--baud", "0"), "--baud is 0 bits per second; it must be from 300"),
        (("lx16a", "1-3", "--return-delay", "5"), "--return-delay is for Dynamixel servos, not for lx16a"),
        (("dynamixel-x", "1-3", "--return-delay", "nan"), "--return-delay is nan us; it must be from 0 to 508 us"),
        (("lx16a", "1-3", "--seconds", "-1"), "--seconds is -1 s"),
    ],
)
def test_what_can_not_be_emulated_is_refused(arguments, message, capsys):
    assert main(list(arguments)) == 1
    assert message in capsys.readouterr().err


CLIENT = """
import sys, time
from tarsus import hardware
bus = hardware.open_bus("dynamixel-x", sys.argv[1], baud=1_000_000, timeout=1.0)
bus.set_watchdog((1, 2), 0.5)
bus.set_torque(None, True)
bus.set_speed_limit((1, 2), 50)
while True:
    bus.write_goals({1: 4000, 2: 4000})
    bus.read_positions((1, 2)).require()
    print("driven", flush=True)
    time.sleep(0.02)
"""


def test_when_the_driving_process_is_killed_the_servos_watchdog_stops_them():
    device = hardware.emulate("dynamixel-x", (1, 2), baud=1_000_000)
    with hardware.PtyServer(device) as server:
        command = [sys.executable, "-c", CLIENT, server.port]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
            assert process.stdout.readline() == "driven\n"
            process.kill()
        with server.lock:
            stopped = device.positions(time.perf_counter() + 0.6)
            later = device.positions(time.perf_counter() + 5.0)
    assert all(memory.get("watchdog") == -1 for memory in device.memory.values())
    assert later == stopped
    assert all(2048 < position < 2500 for position in later.values())
