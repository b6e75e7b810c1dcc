"""An inertial sensor that sends lines of text."""

import dataclasses
import math
import os
import pty
import time
import tty

import numpy as np
import pytest

import tarsus
from tarsus.hardware import (
    AttitudeLine,
    ManualClock,
    Mounting,
    PtyServer,
    ServoPlant,
    emulate,
    emulated_bus,
    nominal_calibration,
    open_bus,
)


class Line:
    """A line on which a test sends, after the end of a line that has begun before."""

    def __init__(self):
        self.clock, self.data, self.closed = ManualClock(), b"", False
        self._begun = b"50,3,0\n"

    def now(self):
        return self.clock.now()

    def discard(self):
        data, self.data, self._begun = self._begun + self.data, b"", b""
        return data

    def close(self):
        self.closed = True


def sensor(rpy=(0.0, 0.0, 0.0)):
    line = Line()
    return AttitudeLine(Mounting(port="COM3", rpy=rpy), line), line


@pytest.mark.parametrize("text", [b"5.0,-10,90\r\n", b" 5;-10.0 ; 90\n", b"5\t-10\t90\n"])
def test_roll_and_pitch_of_a_line(text):
    imu, line = sensor()
    assert imu.read() == math.inf
    line.data = text
    assert imu.read() == 0.0
    assert np.degrees(imu.attitude) == pytest.approx((5, -10))
    line.clock.sleep(0.3)
    assert imu.read() == pytest.approx(0.3)


@pytest.mark.parametrize(
    "text", [b"1,2\n", b"nan,0,0\n", b"1e9,0,0\n", b"400,0,0\n", b"\xff\xfe,1,2\n", b"a b c\n", b"\n"]
)
def test_what_is_no_line_changes_nothing(text):
    imu, line = sensor()
    line.data = b"1,2,3\n" + text
    imu.read()
    assert np.degrees(imu.attitude) == pytest.approx((1, 2))
    line.data = b"7" * 1000
    imu.read()
    line.data = b"\n4,5,6\n9,9"
    imu.read()
    assert np.degrees(imu.attitude) == pytest.approx((4, 5))


def test_a_line_whose_beginning_is_missing_is_none():
    imu, line = sensor()
    # The line has sent the end of another one.
    assert imu.read() == math.inf
    line.data = b"-12.50,3,0\n-12"
    imu.read()
    assert np.degrees(imu.attitude) == pytest.approx((-12.5, 3))
    for data in (b"4" * 300, b"5.0,6,0\n", b"7,"):
        line.data = data
        imu.read()
        assert np.degrees(imu.attitude) == pytest.approx((-12.5, 3))
    line.data = b"8,0\n"
    imu.read()
    assert np.degrees(imu.attitude) == pytest.approx((7, 8))


@pytest.mark.parametrize("seed", range(5))
def test_a_sensor_that_is_mounted_askew_gives_the_attitude_of_the_body(seed):
    random = np.random.default_rng(seed)
    mounted, body = random.uniform(-1.2, 1.2, 3), random.uniform(-0.5, 0.5, 3)
    # World from sensor = world from body times body from sensor.
    world = tarsus.Pose.from_rpy(*body) @ tarsus.Pose.from_rpy(*mounted)
    imu, line = sensor(tuple(mounted))
    line.data = ",".join(f"{math.degrees(angle):.6f}" for angle in world.rpy).encode() + b"\n"
    imu.read()
    assert imu.attitude == pytest.approx(tuple(body[:2]), abs=1e-6)


def test_a_plant_reads_it():
    robot = tarsus.load_robot("strider")
    made = nominal_calibration(robot, "strider", kind="servo2040")
    clock = ManualClock()
    bus, _ = emulated_bus("servo2040", range(18), clock=clock)
    imu, line = sensor()
    plant = ServoPlant(robot, made, buses={"main": bus}, clock=clock, imu=imu)
    output = tarsus.RobotController(robot).output
    plant.start(output)
    assert plant.step(output, 0.02).attitude is None
    line.data = b"3,4,0\n"
    readings = plant.step(output, 0.02)
    assert np.degrees(readings.attitude) == pytest.approx((3, 4))
    assert readings.age["attitude"] == 0.0

    def gone():
        raise tarsus.PortError("serial port", "COM3", expected="an open port", received="nothing", remedy="Plug it in.")

    line.discard = gone
    assert plant.step(output, 0.02).attitude is None
    plant.stop()
    assert plant.notes[0].startswith("the inertial sensor is gone")


def test_the_port_of_the_calibration_is_opened():
    master, slave = pty.openpty()
    tty.setraw(slave)
    imu = AttitudeLine(Mounting(port=os.ttyname(slave)))
    os.write(master, b"9,8,7\n1,2,3\n")
    time.sleep(0.05)
    imu.read()
    assert np.degrees(imu.attitude) == pytest.approx((1, 2))
    imu.close()
    for file in (master, slave):
        os.close(file)


def test_without_the_sensor_the_ports_of_the_servos_are_closed_again():
    robot = tarsus.load_robot("strider")
    made = nominal_calibration(robot, "strider", kind="lines")
    with PtyServer(emulate("lines", range(18))) as server:
        bus = dataclasses.replace(made.buses[0], port=server.port)
        with pytest.raises(tarsus.PortError, match="/dev/none"):
            ServoPlant(robot, made.replace(buses=(bus,), imu=Mounting(port="/dev/none")))
        # A port that is open can't be opened again.
        open_bus("lines", server.port).close()
