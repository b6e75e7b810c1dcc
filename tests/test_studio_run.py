"""A run that the view Drive drives: sessions without a browser, emulated servos in their own time."""

import json
import threading
import time

import click
import numpy as np
import pytest
from websockets.sync.client import connect

import tarsus
from sample_commands import run as run_command
from sample_driven_machine import Machine
from sample_studio import table
from tarsus.cli.run import studio_drive
from tarsus.studio.machine.driven_run import DEADMAN
from tarsus.studio.messages import SOCKET
from tarsus.studio.messages.state import StudioState
from tarsus.studio.state_text import text_of

STRIDER = tarsus.load_robot("strider")
FORWARD = {"velocity_mm_s": [50, 0], "turn_deg_s": 0}


@pytest.mark.no_cover
def test_the_view_drive_commands_the_servos_and_shows_what_they_measure():
    machine = Machine()
    asked = machine.visitor()
    seen = []
    welcome = asked("hello", "welcome", state=None)
    assert welcome["run"] == {"bus": "emulated: feetech-sts"}
    assert asked.types("drive", on=True) == ["done"]
    # A page repeats its command while a stick is deflected.
    drive = {0.1 * i: lambda: asked.types("command", **FORWARD) for i in range(25)}
    look = {2.35: lambda: seen.append(asked.session.frame(1 / 30))}
    recording = machine.go(2.5, drive | look)
    assert recording.ok, recording.problems
    assert recording.states[-1] == "walking"
    (frame,) = seen
    machine_part = frame.machine
    measured = table(machine_part.angles_deg, 3)
    behind = np.abs(measured - table(frame.angles_deg, 3))
    assert 0.05 < behind.max() < 10
    assert machine_part.behind_joint.rpartition(" ")[0] in STRIDER.leg_names
    assert 0 < machine_part.behind_deg < 10
    assert machine_part.rate_hz == pytest.approx(100, abs=1)
    assert machine_part.voltage_v > 6
    assert machine_part.temperature_c > 20
    assert (machine_part.problems, machine_part.stopped) == ([], False)


@pytest.mark.no_cover
@pytest.mark.parametrize("leaves", [True, False])
def test_the_robot_stops_when_its_driver_leaves_or_is_not_heard(leaves):
    machine = Machine()
    asked = machine.visitor()
    asked.types("drive", on=True)
    plan = {0.02 * i: lambda: asked.types("command", **FORWARD) for i in range(50)}
    if leaves:
        plan[1.0] = asked.session.close
    seen = []
    plan[4.0] = lambda: seen.append(asked.session.frame(0.03))
    recording = machine.go(4.1, plan)
    # The twist is 0 within the deadman's time; then the feet return to the stance.
    stopped = max(at for at, command in machine.given if any(command.twist))
    assert 0.9 <= stopped <= (1.01 if leaves else 0.98 + DEADMAN + 0.02)
    assert recording.states[-1] == "standing"
    assert seen[0] is None if leaves else seen[0].machine.stopped
    assert machine.notes == ["the driver has left: stop" if leaves else "nothing heard for 0.7 s: stop"]


def test_one_visitor_drives_and_the_next_one_may_when_the_first_is_gone():
    machine = Machine()
    first, second = machine.visitor(), machine.visitor()
    assert first.types("drive", on=True) == ["done"]
    assert "another visitor drives this robot" in second.error("drive", on=True)["text"]
    assert not second.session.driving
    assert second.types("command", **FORWARD) == ["done"]
    assert machine.run.command(0.0, machine.controller.output, print).twist == (0.0, 0.0, 0.0)
    first.session.close()
    assert second.types("drive", on=True) == ["done"]
    # What arrives after a visitor has left, from another thread, drives no more.
    assert first.types("drive", on=True) == ["error", "done"]
    second.session.close()
    first.types("drive", on=True)
    assert not first.session.driving


def test_other_views_and_robots_are_not_available_while_a_robot_runs():
    asked = Machine().visitor()
    link = text_of(StudioState(view="loads"))
    assert asked("hello", "state", state=link)["state"]["view"] == "drive"
    for kind, more in [
        ("robot", {"preset": "phantomx"}),
        ("view", {"view": "loads"}),
        ("walk", {"walk": {}}),
        ("undo", {}),
        ("open", {"state": link}),
        ("download", {"what": "html"}),
    ]:
        assert "only the view Drive is available until the run ends" in asked.error(kind, **more)["text"]
    assert asked.types("view", view="drive", picture={"camera": "top"}) == ["done"]


@pytest.mark.parametrize(
    ("command", "message"),
    [({"gait": "trot"}, "trot"), ({"cycle_time_s": 0}, "cycle_time")],
)
def test_a_command_that_the_controller_refuses_does_not_end_the_run(command, message):
    machine = Machine()
    asked = machine.visitor()
    asked.types("drive", on=True)
    asked.types("command", **FORWARD)
    assert message in asked("command", "error", **FORWARD, **command)["text"]
    recording = machine.go(0.1)
    assert recording.ok
    assert (machine.given[-1][1].gait, machine.given[-1][1].twist[0]) == (None, 0.05)


@pytest.mark.no_cover
def test_a_visitor_ends_the_run_when_the_robot_stands():
    machine = Machine()
    asked = machine.visitor()
    assert "no run is driven" in asked.error("end_run")["text"]
    asked.types("drive", on=True)
    plan = {0.0: lambda: asked.types("command", **FORWARD), 0.5: lambda: asked.types("end_run")}
    recording = machine.go(20.0, plan)
    assert 0.5 < recording.motion.duration < 10
    assert recording.states[-1] == "standing"
    assert not any(servo.torque for servo in machine.line.servos.values())


def test_a_run_that_was_ended_before_it_began_is_a_run():
    machine = Machine()
    asked = machine.visitor()
    asked.types("drive", on=True)
    asked.types("end_run")
    assert machine.go(5.0).ok


def test_a_fault_is_shown_with_its_joint_and_what_helps():
    machine = Machine()
    asked = machine.visitor()
    asked.types("drive", on=True)
    machine.line.servos[5].temperature = 90.0
    with pytest.raises(tarsus.errors.ServoFaultError):
        machine.go(1.0)
    (problem,) = asked.session.frame(0.03).machine.problems
    assert "middle left femur: overheated" in problem
    assert "Let it cool" in problem


def test_servos_without_positions_are_shown_as_commanded():
    machine = Machine("pca9685")
    asked = machine.visitor()
    asked.types("drive", on=True)
    before = asked.session.frame(0.03).machine
    machine.go(0.2)
    frame = json.loads(asked.session.frame(0.03).model_dump_json())["machine"]
    assert frame["angles_deg"] == before.angles_deg == [None] * 18
    assert (frame["behind_deg"], frame["behind_joint"], frame["voltage_v"]) == (None, None, None)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--studio", "here"), "it must be HOST:PORT"),
        (("--studio", "127.0.0.1:99999"), "it must be HOST:PORT"),
        (("--studio", "--keys"), "--keys and --studio exclude each other"),
        (("--studio", "--scenario", "at 0 s: stop"), "--scenario and --studio exclude each other"),
        (("--bus", "simulated", "--studio"), "physics does not run in real time"),
    ],
)
def test_what_is_no_run_with_a_studio(options, message):
    result = run_command("run", "strider", *options)
    assert result.exit_code == 2
    assert message in result.stderr


def test_the_command_serves_the_view_drive_of_its_run(monkeypatch):
    """A page's messages over the socket, at the link that the command prints."""
    links, found = [], {}
    echo = click.echo
    monkeypatch.setattr(studio_drive.click, "echo", lambda text, **more: (links.append(text), echo(text, **more)))

    def visit():
        while not links:
            time.sleep(0.01)
        link = links[0].removeprefix("drive it here: ")
        with connect(f"{link.replace('http', 'ws')}{SOCKET[1:]}", max_size=None) as socket:
            for number, message in enumerate(({"type": "hello"}, {"type": "drive", "on": True}), 1):
                socket.send(json.dumps({"id": number, **message}))
            while found.get("type") != "frame":
                found.update(json.loads(socket.recv()))
            socket.send(json.dumps({"id": 3, "type": "end_run"}))
            while json.loads(socket.recv())["id"] != 3:
                pass

    visitor = threading.Thread(target=visit)
    visitor.start()
    # Without feedback: what a busy computer delays can't be taken for a fault.
    options = ("--bus", "emulated:pca9685", "--studio", "127.0.0.1:0", "--duration", "60")
    result = run_command("run", "strider", *options)
    visitor.join()
    assert result.exit_code == 0, result.stderr
    assert "possible" in result.stdout
    assert (found["machine"]["problems"], found["state"]) == ([], "standing")
