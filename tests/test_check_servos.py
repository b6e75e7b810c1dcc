"""Nothing moves, why? Each cause is put into emulated servos, and must be found."""

import dataclasses
import math

import pytest

import tarsus
from sample_commands import run, run_json
from tarsus.errors import PortError
from tarsus.hardware import FootSwitches, ManualClock, MemoryTransport, bus_over, emulate, nominal_calibration
from tarsus.hardware.diagnosis.check_servos import check_servos

STRIDER = tarsus.load_robot("strider")


class Bench:
    """Emulated servos on a line whose rate counts, as on a wire."""

    def __init__(self, kind="feetech-sts", baud=1_000_000):
        made = nominal_calibration(STRIDER, "strider", kind=kind, port="memory")
        self.calibration = made
        self.clock = ManualClock()
        self.ids = [joint.number for row in made.joints for joint in row]
        self.line = emulate(kind, self.ids, **({"baud": baud} if kind != "pca9685" else {}))
        for row, ends in zip(made.joints, made.command_limits.mean(-1).tolist(), strict=True):
            for joint, middle in zip(row, ends, strict=True):
                self.line.servos[joint.number].place(middle)
        self.rate = baud

    def open(self, settings, baud):
        transport = MemoryTransport(self.line, self.clock)
        bus = bus_over(settings.kind, transport)
        if (baud or settings.baud or 1_000_000) != self.rate:
            bus.scan = lambda ids=None: tarsus.hardware.Answers({}, ())
        if self.line.faults.unplugged:
            transport.write(b"")
        return bus

    def findings(self, **more):
        return list(check_servos(self.calibration, open_port=self.open, clock=self.clock, **more))

    def wrong(self, **more):
        return [finding for finding in self.findings(**more) if finding.ok is False]


def test_servos_with_which_nothing_is_wrong():
    bench = Bench()
    found = bench.findings(move=True)
    assert all(finding.ok for finding in found)
    assert [finding.remedy for finding in found] == [""] * 6
    assert "18 of 18" in found[1].measured
    assert "7.4 V" in found[2].measured
    assert not any(servo.torque for servo in bench.line.servos.values())


def _echo(bench):
    bench.line.faults.echo = True
    bench.line.faults.missing.update(bench.ids)


CAUSES = {
    "unplugged": (lambda b: setattr(b.line.faults, "unplugged", True), "Does the port open?", "Plug it in", 1),
    "no supply": (lambda b: setattr(b.line.supply, "source", 0.0), "Does any servo answer?", "supply of the serv", 1),
    "echo only": (_echo, "Does any servo answer?", "hears no servo", 1),
    "a cable": (
        lambda b: b.line.faults.missing.update({4, 5, 6}),
        "Do all servos answer?",
        "behind it in the chain",
        1,
    ),
    "an id twice": (lambda b: b.line.faults.duplicate.add(7), "Has each servo an id of its own?", "one at a time", 2),
    "low": (lambda b: setattr(b.line.supply, "source", 4.7), "Is the supply strong enough?", "Charge", 1),
    "hot": (lambda b: setattr(b.line.servos[3], "temperature", 72.0), "Do the servos report errors?", "cool", 1),
    "turned": (lambda b: b.line.servos[9].place(3500), "Are the joints within their limits?", "zero", 1),
    "jammed": (lambda b: setattr(b.line.servos[2], "stuck", True), "Does each joint move", "Free", 1),
}


@pytest.mark.parametrize("cause", CAUSES)
def test_causes_are_found_with_a_remedy(cause):
    change, question, remedy, number = CAUSES[cause]
    bench = Bench()
    change(bench)
    wrong = bench.wrong(move=True)
    assert len(wrong) == number
    assert wrong[0].question.startswith(question)
    assert remedy in wrong[0].remedy
    joint = {"a cable": "middle left coxa (id 4 on main)", "an id twice": "rear left coxa", "hot": "front left tibia"}
    joint |= {"turned": "rear left tibia at", "jammed": "front left femur (id 2 on main): 0.0 of 4 deg"}
    assert joint.get(cause, "") in wrong[0].measured


def test_another_rate_is_found():
    bench = Bench(baud=57_600)
    (wrong,) = bench.wrong()
    assert wrong.measured == "not at this rate, but at 57600"
    assert "Write baud = 57600" in wrong.remedy


def test_a_servo_with_another_id_is_named():
    bench = Bench()
    bench.calibration = bench.calibration.with_joint(1, 1, number=33)
    (wrong,) = bench.wrong()
    assert "missing: middle left femur (id 33 on main); ids that belong to no joint: 5" in wrong.measured
    assert "Set the ids of the strangers" in wrong.remedy


def test_a_port_that_goes_while_it_is_looked_at():
    bench = Bench()
    findings = check_servos(bench.calibration, open_port=bench.open, clock=bench.clock)
    assert next(findings).ok
    bench.line.faults.unplugged = True
    assert next(findings).question == "Does the port stay?"


def test_boards_say_what_they_can(tmp_path):
    bench = Bench("servo2040", baud=115_200)
    found = bench.findings()
    assert [finding.ok for finding in found] == [True, True, None]
    assert "Connect the grounds" in found[2].remedy
    bench.line.faults.missing.update(bench.ids)
    bench.line.supply.source = 0.0


def test_the_command_prints_what_it_found(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    made = nominal_calibration(STRIDER, "strider", kind="feetech-sts")
    made.save("c.toml")
    result = run("check-servos", "c.toml")
    assert result.exit_code == 1
    assert "NO   Does the port open? the calibration names none for 'main'" in result.stdout
    code, found = run_json("check-servos", "c.toml", "--port", "/dev/none")
    assert (code, found["ok"], len(found["findings"])) == (1, False, 1)
    assert "No such file" in found["findings"][0]["measured"]
    assert run("check-servos", "c.toml", "--emulated").exit_code == 0
    dataclasses.replace(made, buses=made.buses).with_joint(0, 0, zero=None).save("n.toml")
    assert "not calibrated yet" in run("check-servos", "n.toml").stderr


def test_a_port_error_is_no_traceback():
    def refused(settings, baud):
        raise PortError("serial port", "COM9", expected="a port that opens", received="Access is denied", remedy="Ask.")

    made = nominal_calibration(STRIDER, "strider", kind="feetech-sts", port="COM9")
    (finding,) = check_servos(made, open_port=refused)
    assert (finding.ok, finding.measured, finding.remedy) == (False, "Access is denied", "Ask.")


def test_an_interrupt_releases_the_joint_that_is_moved_and_ends_its_limits():
    # Feetech servos get their speed with the next goal.
    bench = Bench("dynamixel-mx")
    sleep = bench.clock.sleep

    def interrupted(seconds):
        # While it is watched, not while an answer is waited for.
        if seconds > 0.1:
            assert sum(servo.torque for servo in bench.line.servos.values()) == 1
            raise KeyboardInterrupt
        sleep(seconds)

    bench.clock.sleep = interrupted
    with pytest.raises(KeyboardInterrupt):
        bench.findings(move=True)
    for servo in bench.line.servos.values():
        assert (servo.torque, servo.torque_limit, servo.speed_limit) == (False, 1.0, math.inf)


def test_a_board_of_foot_switches_alone_tells_their_levels(tmp_path):
    made = nominal_calibration(STRIDER, "strider", kind="feetech-sts")
    feet = dataclasses.replace(made.buses[0], name="feet", kind="lines", baud=None)
    switches = FootSwitches(bus="feet", inputs=(0, 1, 2, 3, 4, None), closed=False)
    made.replace(buses=(*made.buses, feet), foot_switches=switches).save(tmp_path / "c.toml")
    code, found = run_json("check-servos", tmp_path / "c.toml", "--emulated")
    assert code == 0
    last = found["findings"][-1]
    assert (last["question"], last["ok"]) == ("Do the foot switches answer?", None)
    assert "levels: front left 0.0, " in last["measured"]
    assert "front right" not in last["measured"]


def test_thresholds_of_sensors_of_force_are_told():
    bench = Bench("servo2040")
    switches = FootSwitches(bus="main", inputs=(0, 1, 2, 3, 4, 5), thresholds=(1.0, 1.1, 1.2, 1.3, 1.4, 1.5))
    bench.calibration = bench.calibration.replace(foot_switches=switches)
    bench.line.levels = {0: 0.4}
    (found,) = [each for each in bench.findings() if "foot switches" in each.question]
    assert "front left 0.4 (1.32 V), threshold 1.00 V, middle left 0.0 (0.00 V), threshold 1.10 V" in found.measured
    assert found.measured.endswith("a foot is on the ground above its threshold")


def test_switches_that_do_not_answer_and_servos_that_fall_silent_are_said():
    bench = Bench("servo2040")
    switches = FootSwitches(bus="main", inputs=(0, 1, 2, 3, 4, 5))
    bench.calibration = bench.calibration.replace(foot_switches=switches)
    answers, asked = bench.line._answers, []

    def silent_at_the_second():
        asked.append(1)
        if len(asked) > 1:
            bench.line._buffer = b""
            return []
        return list(answers())

    bench.line._answers = silent_at_the_second
    (wrong,) = bench.wrong()
    assert (wrong.question, wrong.measured) == ("Do the foot switches answer?", "nothing within 20 ms")
    bench = Bench()
    sleep = bench.clock.sleep

    def gone(seconds):
        sleep(seconds)
        if seconds > 0.1:
            bench.line.faults.missing.add(bench.ids[0])

    bench.clock.sleep = gone
    (wrong,) = bench.wrong(move=True)
    assert wrong.measured == "front left coxa (id 1 on main): no answer"
