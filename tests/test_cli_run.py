"""`tarsus run`: emulated servos behind terminals, faults, records, and what a kill leaves behind."""

import contextlib
import csv
import json
import os
import pty
import re
import struct
import subprocess
import sys
import time

import numpy as np
import pytest

import tarsus
from quadrupeds import random_quadruped
from sample_commands import run, run_json
from tarsus import Command, RobotController
from tarsus.errors import InputError
from tarsus.hardware import BUSES, ManualClock, PtyServer, emulate, nominal_calibration
from tarsus.hardware.bus.register_bus import RegisterBus
from tarsus.hardware.live.gamepad import Gamepad
from tarsus.hardware.live.keyboard import KEYS, Keyboard
from tarsus.hardware.live.live_commands import Input, LiveCommands
from tarsus.hardware.live.supervision import Rising, Supervised
from tarsus.hardware.plant.tick_record import TickRecord
from tarsus.hardware.telemetry.log import TelemetryLog, read_log

STRIDER = tarsus.load_robot("strider")
FAST = 1_000_000


def served(kind, tmp_path, **faults):
    """Emulated servos behind a terminal, standing, and the calibration file of them."""
    made = nominal_calibration(STRIDER, "strider", kind=kind)
    baud = FAST if kind.startswith(("feetech", "dynamixel")) else BUSES[kind].baud
    line = emulate(kind, [joint.number for row in made.joints for joint in row], baud=baud, **faults)
    commands = made.commands(RobotController(made.limited_robot).output.angles)
    for row, goals in zip(made.joints, commands.tolist(), strict=True):
        for joint, goal in zip(row, goals, strict=True):
            line.servos[joint.number].place(goal)
    server = PtyServer(line)
    bus = tarsus.hardware.BusSettings(name="main", kind=kind, port=server.port, baud=baud)
    made.replace(buses=(bus,)).save(tmp_path / "c.toml")
    return line, server


@pytest.mark.no_cover
def test_an_emulated_robot_walks_and_is_recorded(tmp_path):
    code, found = run_json("run", "strider", "--bus", "emulated", "--duration", "0.4", "--out", tmp_path)
    assert (code, found["problems"]) == (0, [])
    assert found["timing"]["ticks"] > 10
    assert found["tracking_deg"]["worst"] < 10
    assert {os.path.basename(file) for file in found["files"]} == {
        *("telemetry.csv", "telemetry.mcap", "joints.png", "log.csv", "timeline.png")
    }
    times, sent, measured = read_log(tmp_path / "telemetry.csv", STRIDER)
    assert len(times) > 40
    assert np.nanmax(np.abs(sent - measured)) < np.radians(12)
    messages = mcap_messages(tmp_path / "telemetry.mcap")
    assert len(messages) == len(times)
    assert messages[5]["name"][4] == "LM_femur"
    np.testing.assert_allclose(messages[5]["sent_deg"], np.degrees(sent[5]).ravel(), atol=1e-3)
    with pytest.raises(InputError, match="no table of telemetry"):
        read_log(tmp_path / "log.csv", STRIDER)


def mcap_messages(path):
    from mcap.reader import make_reader

    with open(path, "rb") as file:
        return [json.loads(message.data) for _, _, message in make_reader(file).iter_messages()]


@pytest.mark.no_cover
def test_a_fault_ends_with_an_exit_code_its_joint_and_a_complete_log(tmp_path):
    line, server = served("feetech-sts", tmp_path)
    with server:
        line.servos[5].temperature = 90.0
        result = run("run", "strider", "--calibration", tmp_path / "c.toml", "--start", "standing", "--out", tmp_path)
    assert result.exit_code == 1
    assert "middle left femur: overheated" in result.stdout
    assert "Let it cool" in result.stdout
    assert not any(servo.torque for servo in line.servos.values())
    with open(tmp_path / "telemetry.csv", encoding="utf-8", newline="") as file:
        faults = [row["fault"] for row in csv.DictReader(file)]
    assert "middle left femur: overheated" in "".join(faults)


@pytest.mark.no_cover
@pytest.mark.parametrize("name", ["telemetry.csv", "telemetry.mcap"])
def test_a_full_disk_ends_the_log_and_not_the_walk(name, tmp_path):
    (tmp_path / name).symlink_to("/dev/full")
    code, found = run_json("run", "strider", "--bus", "emulated", "--duration", "0.4", "--out", tmp_path)
    assert (code, found["fault"]) == (1, None)
    assert found["duration_s"] == pytest.approx(0.4, abs=0.02)
    assert found["problems"] == [f"the telemetry in {tmp_path} is not complete: No space left on device"]
    # The robot has sat down, and its records of the controller are there.
    assert {os.path.basename(file) for file in found["files"]} == {"log.csv", "timeline.png"}


def test_a_log_of_another_robot_is_not_read(tmp_path):
    with TelemetryLog(tarsus.load_robot("strider"), tmp_path):
        pass
    assert len(read_log(tmp_path / "telemetry.csv", STRIDER)[0]) == 0
    with pytest.raises(InputError, match="no table of telemetry of this robot: its columns are others"):
        read_log(tmp_path / "telemetry.csv", random_quadruped(0))


def test_a_row_that_was_cut_off_is_left_out(tmp_path):
    angles = np.full((6, 3), np.radians(-12.3456))
    shared = dict.fromkeys(("asked", "sent", "measured"), angles) | dict.fromkeys(("temperatures", "loads"), angles * 0)
    with TelemetryLog(STRIDER, tmp_path) as log:
        for tick in range(3):
            log.write(TickRecord(time=tick * 0.02, voltage=11.1, fault="füße" if tick == 2 else "", **shared))
    path = tmp_path / "telemetry.csv"
    content = path.read_bytes()
    last = content.rfind(b"\r\n", 0, -2) + 2
    for size in range(last, len(content)):
        path.write_bytes(content[:size])
        times, _, measured = read_log(path, STRIDER)
        np.testing.assert_allclose(times, [0.0, 0.02])
        np.testing.assert_allclose(measured[-1], angles)


def test_physics_runs_the_same_controller():
    code, found = run_json("run", "strider", "--bus", "simulated", "--duration", "0.3", "--start", "standing")
    assert (code, found["bus"], found["timing"]) == (0, "simulated", None)


def test_settings_of_a_scenario_hold_on_servos_and_in_physics(tmp_path):
    path = tmp_path / "s.toml"
    path.write_text('start = "sitting"\nrate_hz = 50\nlevelling = "none"\ntimeline = "at 0.2 s: walk 50 mm/s"\n')
    for bus in ("emulated", "simulated"):
        code, found = run_json("run", "strider", "--bus", bus, "--scenario", path, "--duration", "0.5")
        assert code == 1
        assert any("the robot is lying" in text for text in found["problems"])
        if found["timing"]:
            # However busy the computer is: ticks that it misses are counted.
            assert found["timing"]["ticks"] + found["timing"]["missed"] == pytest.approx(25, abs=2)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--scenario", "at 0 s: ground RF 4 mm"), "only an ideal plant simulates what sensors measure"),
        (("--bus", "simulated", "--scenario", "at 0 s: tilt roll 3 deg"), "only an ideal plant simulates"),
        (("--bus", "simulated:feetech-sts"), "only emulated buses have a kind; give --bus simulated"),
        (("--bus", "simulated", "--rate", "5"), "from 20 Hz, below which joints are slowed down"),
        (("--bus", "real"), "needs its calibration"),
        (("--bus", "usb"), "must be real, emulated"),
        (("--bus", "emulated:usb"), "no kind of bus is called 'usb'"),
        (("--port", "COM3"), "--port is for real robots; with --bus emulated leave it out"),
        (("--bus", "simulated", "--port", "COM3"), "--port is for real robots; with --bus simulated leave it out"),
        (("--keys",), "the standard input is none"),
        (("--gamepad", "/dev/none"), "no gamepad at /dev/none: No such file or directory; plug it in"),
        (("--keys", "--gamepad"), "exclude each other"),
        (("--keys", "--scenario", "at 0 s: stop"), "--scenario and --keys exclude each other"),
        (("--bus", "simulated", "--keys"), "physics does not run in real time"),
        (
            ("--bus", "simulated", "--rate", "1e9"),
            "from 20 Hz, below which joints are slowed down, to 500 Hz in physics",
        ),
        (("--duration", "-1"), "'--duration': -1 s; it must be greater than 0"),
        (("--rate", "0"), "'--rate': 0 Hz; it must be greater than 0"),
        (("--rate", "5"), "from 20 Hz, below which joints are slowed down, to the 379 Hz that the wires carry"),
        (("--rate", "1e6"), "--rate is 1e+06 Hz"),
    ],
)
def test_what_is_no_run(options, message):
    result = run("run", "strider", *options)
    assert result.exit_code == 2
    assert message in result.stderr


def test_a_calibration_does_not_become_one_of_another_bus(tmp_path):
    nominal_calibration(STRIDER, "strider", kind="feetech-sts").save(tmp_path / "c.toml")
    for bus, message in [
        ("emulated:lx16a", "c.toml is for feetech-sts; give --bus emulated"),
        ("emulated:lx16", "Did you mean 'lx16a'?"),
        ("simulated", "physics moves the joints without servo commands: leave --calibration out"),
    ]:
        result = run("run", "strider", "--calibration", tmp_path / "c.toml", "--bus", bus)
        assert result.exit_code == 2
        assert message in result.stderr


@pytest.mark.no_cover
def test_an_interrupted_run_tells_what_was_recorded_and_what_could_not_be_released(tmp_path, monkeypatch):
    command = Supervised.command

    def interrupted(self, time, output, note):
        if time > 0.2:
            raise KeyboardInterrupt
        return command(self, time, output, note)

    held = RegisterBus.set_torque

    def holding(self, ids, on):
        if not on:
            raise OSError("no cable")
        return held(self, ids, on)

    monkeypatch.setattr(Supervised, "command", interrupted)
    monkeypatch.setattr(RegisterBus, "set_torque", holding)
    result = run("run", "strider", "--bus", "emulated", "--out", tmp_path)
    assert result.exit_code == 130
    assert "the servos on main may still hold: no cable" in result.output
    assert "interrupted" in result.output
    assert "telemetry.csv" in result.output
    times, _, _ = read_log(tmp_path / "telemetry.csv", STRIDER)
    assert times[-1] > 0.2


# The program's input becomes the terminal that controls it: closing it hangs the program up.
ON_A_TERMINAL = "import fcntl, termios; fcntl.ioctl(0, termios.TIOCSCTTY, 0); from tarsus.cli import main; main()"


class Walking:
    """`tarsus run` in a process of its own that walks on emulated servos, on a terminal."""

    def __init__(self, kind, tmp_path):
        self.line, self.server = served(kind, tmp_path)
        self._began = {number: servo.position for number, servo in self.line.servos.items()}
        scenario = "at 0 s: walk 50 mm/s; at 60 s: stop"
        options = ["--calibration", tmp_path / "c.toml", "--start", "standing", "--scenario", scenario]
        # Not by a fork, which other libraries' threads do not survive.
        self.terminal, inside = pty.openpty()
        self.process = subprocess.Popen(
            [sys.executable, "-c", ON_A_TERMINAL, "run", "strider", *map(str, options)],
            stdin=inside,
            stdout=inside,
            stderr=inside,
            start_new_session=True,
        )
        os.close(inside)
        os.set_blocking(self.terminal, False)
        await_until(self._moved, self.server, self.line)

    def _moved(self):
        with contextlib.suppress(BlockingIOError):
            os.read(self.terminal, 65536)
        return any(abs(servo.position - self._began[number]) > 5 for number, servo in self.line.servos.items())

    def exit_code(self):
        return self.process.wait()


def test_servos_let_go_after_sitting_down_when_the_terminal_is_closed(tmp_path):
    walking = Walking("feetech-sts", tmp_path)
    with walking.server:
        os.close(walking.terminal)
        assert walking.exit_code() == 130
        servos = walking.line.servos.values()
        assert not any(servo.torque for servo in servos)
    made = nominal_calibration(STRIDER, "strider", kind="feetech-sts")
    angles = made.angles(np.array([servo.position for servo in servos]).reshape(6, 3))
    assert tarsus.forward_kinematics(STRIDER, angles)[..., 3, 2].min() > -0.06


@pytest.mark.parametrize("kind", ["lines", "dynamixel-x"])
def test_a_watchdog_ends_what_a_killed_program_has_begun(kind, tmp_path):
    walking = Walking(kind, tmp_path)
    line = walking.line
    with walking.server:
        walking.process.kill()
        assert walking.exit_code() == -9
        os.close(walking.terminal)
        if kind == "lines":
            await_until(lambda: not any(servo.torque for servo in line.servos.values()), walking.server, line)
            return
        # X servos stop and hold, and take no goals until the watchdog is set anew.
        await_until(lambda: all(one.get("watchdog") == -1 for one in line.memory.values()), walking.server, line)
        assert all(servo.torque and servo.speed == 0 for servo in line.servos.values())


def await_until(condition, server, line):
    for _ in range(600):
        time.sleep(0.05)
        with server.lock:
            line.advance(time.perf_counter())
            if condition():
                return
    pytest.fail("it did not happen within 30 s")


class Scripted:
    def __init__(self, *inputs):
        self._inputs = list(inputs)

    def read(self):
        return self._inputs.pop(0) if self._inputs else []


def test_a_driver_who_falls_silent_stops_the_robot():
    clock, notes = ManualClock(), []
    output = RobotController(STRIDER).output
    live = LiveCommands(
        Scripted([Input(twist=(1, 0, -1))], [], [Input(gait="wave", body_height=0.01)]),
        speeds=(0.1, 0.05, 0.5),
        deadman=0.5,
        clock=clock,
    )

    def step():
        clock.sleep(0.3)
        return live.command(0.0, output, lambda kind, text: notes.append(text))

    assert step().twist == (0.1, 0.0, -0.5)
    assert step().twist == (0.1, 0.0, -0.5)
    third = step()
    assert (third.gait, third.twist) == ("wave", (0.1, 0.0, -0.5))
    assert third.body_height == pytest.approx(float(output.body.position[2]) + 0.01)
    assert step().twist == (0.1, 0.0, -0.5)
    assert step().twist == (0.0, 0.0, 0.0)
    assert notes == ["nothing heard for 0.5 s: stop"]
    assert not live.over(0.0, output)
    gone = LiveCommands(Scripted([Input(twist=(1, 0, 0), state="lying")], None), speeds=(1, 1, 1), clock=clock)
    assert gone.command(0.0, output, lambda *_: None).state == "lying"
    assert gone.command(0.0, output, lambda *_: None).twist == (0.0, 0.0, 0.0)
    assert gone.over(0.0, output)


def test_body_heights_add_up_and_stop_soon_after_the_last_one():
    up, controller = Input(body_height=0.005), RobotController(STRIDER)
    start = float(controller.output.body.position[2])
    live = LiveCommands(Scripted([up, up], [], [up], [up] * 10, [up]), speeds=(1, 1, 1))

    def height():
        return live.command(0.0, controller.output, lambda *_: None).body_height

    assert height() == pytest.approx(start + 0.01)
    assert height() is None
    assert height() == pytest.approx(start + 0.015)
    # A key that is kept down asks for more than the body can do meanwhile.
    assert height() == height() == pytest.approx(start + 0.02)
    # After sitting down, the height is what it is.
    lying, standing = RobotController(STRIDER, start="lying"), controller
    live = LiveCommands(Scripted([up, up], [up], [up]), speeds=(1, 1, 1))
    assert height() == pytest.approx(start + 0.01)
    controller = lying
    assert height() is None
    controller = standing
    assert height() == pytest.approx(start + 0.005)


def test_keys_of_a_terminal(monkeypatch):
    master, slave = pty.openpty()
    with os.fdopen(slave, "r") as terminal:
        monkeypatch.setattr(sys, "stdin", terminal)
        with Keyboard() as keyboard:
            assert keyboard.read() == []

            def pressed(sent):
                os.write(master, sent)
                time.sleep(0.05)
                return keyboard.read()

            def named(keys):
                return [KEYS[key][0] for key in keys]

            assert pressed(b"w\x1b[Cz x") == named("wd x")
            assert pressed(b"\x1bOA\x1bOB\x1b[D\x1b[A") == named("wsaw")
            # Delete, Home, F5, F1, Ctrl and up, Alt and x, Alt and Delete, Alt and left.
            for other in (b"[3~", b"[1~", b"[15~", b"OP", b"[1;5A", b"x", b"\x1b[3~", b"\x1b[D"):
                assert pressed(b"a\x1b" + other + b"d") == named("ad")
            # What arrives in parts.
            assert pressed(b"w\x1b") == named("w")
            assert pressed(b"[") == []
            assert pressed(b"3") == []
            assert pressed(b"~\x1b[Bd") == named("sd")
            # The escape key swallows no other.
            assert pressed(b"\x1b") == []
            assert keyboard.read() == []
            assert pressed(b" ") == pressed(b"\x1b\x1b ") == named(" ")
            os.close(master)
            assert keyboard.read() is None


def test_sticks_and_buttons_of_a_gamepad(tmp_path):
    path = tmp_path / "js0"
    os.mkfifo(path)
    with Gamepad(str(path)) as pad:
        # A fifo without a writer ends at once; a pad that is unplugged, too.
        assert pad.read() is None
        with open(path, "wb", buffering=0) as writer:
            for value, kind, number in [
                (-32767, 2, 1),
                (20000, 0x82, 3),
                (1500, 2, 0),
                (1, 1, 3),
                (0, 1, 3),
                (9, 2, 9),
            ]:
                writer.write(struct.pack("IhBB", 0, value, kind, number))
            writer.write(b"abc")
            stick, button = pad.read()
            assert stick.twist == pytest.approx((1.0, 0.0, -20000 / 32767))
            assert button == Input(gait="ripple")
            assert pad.read() == [stick]


def test_warm_servos_and_a_robot_that_lies_come_first():
    class Plant:
        speed_factor = 0.5

    class Source:
        def command(self, time, output, note):
            return Command(twist=(0.1, 0.0, 0.0)) if time < 1 else Command()

        def over(self, time, output):
            return time > 2

    controller, notes = RobotController(STRIDER, start="lying"), []
    source = Supervised(Rising(Source()), Plant())
    first = source.command(0.0, controller.output, lambda kind, text: notes.append(text))
    assert first.state == "standing"
    assert not source.over(9.0, controller.output)
    standing = RobotController(STRIDER).output
    assert source.command(3.0, standing, lambda *_: None).twist == (0.05, 0.0, 0.0)
    assert source.command(4.5, standing, lambda *_: None).twist == (0.0, 0.0, 0.0)
    assert source.over(5.5, standing)
    assert re.match("servos are warm: 50 % of", notes[0])
