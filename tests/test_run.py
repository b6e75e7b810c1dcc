"""The loop of controller and plant: every kind of plant and of command source runs in it, and is stopped at its end."""

import dataclasses
import math

import numpy as np
import pytest

import tarsus
from tarsus.control.command import Command
from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.loop.recorder import Recorder
from tarsus.control.loop.run import CommandSource, TimedCommands, run
from tarsus.control.plant import IdealPlant, Plant
from tarsus.control.readings import SensorReadings
from tarsus.control.robot_controller import RobotController
from tarsus.errors import InputError
from tarsus.robot.file import load_robot
from tarsus.scenario.file import scenario_from_text
from tarsus.scenario.runner import run_scenario

STRIDER = load_robot("strider")
FORWARD = (0.05, 0.0, 0.0)


class LaggingPlant:
    """A plant whose joints follow with a lag of first order, and that notes how it is used."""

    def __init__(self, robot, *, time_constant=0.05, fails_at=math.inf):
        self.robot, self._constant, self._fails_at = robot, time_constant, fails_at
        self.calls, self._angles, self._time = [], None, 0.0

    def start(self, output):
        self.calls.append("start")
        self._angles = np.array(output.angles)

    def step(self, output, dt):
        self._time += dt
        if self._time > self._fails_at:
            raise RuntimeError("unplugged")
        self._angles = self._angles + (output.angles - self._angles) * -math.expm1(-dt / self._constant)
        return SensorReadings(joint_angles=self._angles)

    def stop(self):
        self.calls.append("stop")


def test_the_public_names_are_these():
    assert tarsus.run is run
    assert tarsus.IdealPlant is IdealPlant
    assert isinstance(IdealPlant(STRIDER), Plant)
    assert isinstance(LaggingPlant(STRIDER), Plant)
    assert isinstance(TimedCommands([]), CommandSource)


def test_an_ideal_plant_is_where_it_is_commanded_to_be():
    recording = run(RobotController(STRIDER), IdealPlant(STRIDER), [(0.0, FORWARD)], duration=2.0)
    assert recording.ok, recording.problems
    assert (recording.measured_angles[:-1] == recording.motion.angles[:-1]).all()
    assert np.isnan(recording.measured_angles[-1]).all()
    assert recording.motion.time == pytest.approx(np.arange(201) / 100)
    assert recording.twist_commanded[1:] == pytest.approx(np.tile(FORWARD, (200, 1)))
    assert recording.states[0] == "standing"
    assert recording.states[-1] == "walking"
    assert recording.rate == 100


def test_its_joint_speeds_are_those_of_the_last_tick():
    controller, plant = RobotController(STRIDER), IdealPlant(STRIDER)
    plant.start(controller.output)
    before = controller.output.angles
    for _ in range(20):
        output = controller.step(FORWARD, 0.02)
        readings = plant.step(output, 0.02)
        assert readings.joint_speeds == pytest.approx((output.angles - before) / 0.02)
        before = output.angles


def test_the_difference_between_command_and_another_plant_is_recorded():
    plant = LaggingPlant(STRIDER)
    recording = run(RobotController(STRIDER), plant, [(0.0, FORWARD), (1.5, (0.0, 0.0, 0.0))])
    assert plant.calls == ["start", "stop"]
    error = np.abs(recording.measured_angles - recording.motion.angles)[:-1]
    assert 0.01 < np.nanmax(error) < 0.5
    # A lag of 0.05 s has faded when the robot has stood for a while.
    assert np.nanmax(error[-20:]) < 1e-3


def test_the_plant_is_stopped_when_something_fails():
    plant = LaggingPlant(STRIDER, fails_at=0.5)
    with pytest.raises(RuntimeError, match="unplugged"):
        run(RobotController(STRIDER), plant, [(0.0, FORWARD)])
    assert plant.calls == ["start", "stop"]


def test_scenarios_run_on_any_plant():
    scenario = scenario_from_text("at 0 s: walk 50 mm/s; at 1 s: stop", robot="strider")
    lagging, ideal = run_scenario(scenario, plant=LaggingPlant(STRIDER)), run_scenario(scenario)
    assert (lagging.motion.angles == ideal.motion.angles).all()
    assert (lagging.measured_angles[50] != ideal.measured_angles[50]).any()
    with pytest.raises(InputError, match=r"at 1 s: ground RF 3 mm: only an ideal plant .* leave the command out"):
        run_scenario(scenario_from_text("at 1 s: ground RF 3 mm"), plant=LaggingPlant(STRIDER))


def test_commands_hold_until_the_next_and_the_run_ends_at_rest():
    commands = [(2.0, Command(state="lying")), (0.5, Command(twist=FORWARD, gait="wave")), (1.5, (0.0, 0.0, 0.0))]
    recording = run(RobotController(STRIDER), IdealPlant(STRIDER), commands, name="down")
    assert recording.ok, recording.problems
    assert recording.name == "down"
    assert recording.states[-1] == "lying"
    assert recording.motion.duration >= 4.0
    asked = recording.motion.time[1:][recording.twist_commanded[1:, 0] > 0]
    assert asked[[0, -1]] == pytest.approx([0.51, 1.5])
    assert recording.gaits[-1] == "wave"


def test_a_source_may_answer_to_what_the_controller_gives():
    class UntilHalfAMetre:
        def command(self, time, output, note):
            if output.body.position[0] > 0.1 and not self.noted:
                note("command", "far enough")
                self.noted = True
            return Command(twist=(0.0, 0.0, 0.0) if self.noted else FORWARD)

        def over(self, time, output):
            return self.noted and output.at_rest

        noted = False

    recording = run(RobotController(STRIDER), IdealPlant(STRIDER), UntilHalfAMetre(), rate=50.0)
    assert recording.motion.body.position[-1, 0] == pytest.approx(0.12, abs=0.03)
    assert [event.text for event in recording.events if event.kind == "command"] == ["far enough"]


def test_random_ticks_are_the_same_for_the_same_seed():
    times = [
        run(RobotController(STRIDER), IdealPlant(STRIDER), [], duration=0.5, jitter=0.004, seed=seed).motion.time
        for seed in (1, 1, 2)
    ]
    assert (times[0] == times[1]).all()
    assert (times[0][:40] != times[2][:40]).any()
    assert np.abs(np.diff(times[0]) - 0.01).max() <= 0.004


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"rate": 0.0}, "rate"),
        ({"rate": math.nan}, "rate"),
        ({"jitter": 0.02}, "jitter is 0.02 s; it must be at least 0 and less than a tick, 0.01 s"),
        ({"duration": -1.0}, "duration"),
    ],
)
def test_senseless_numbers_are_refused(arguments, words):
    with pytest.raises(InputError, match=words):
        run(RobotController(STRIDER), IdealPlant(STRIDER), [], **arguments)


def test_times_must_be_numbers():
    with pytest.raises(InputError, match="time"):
        TimedCommands([(math.nan, FORWARD)])


def test_controller_and_plant_are_of_one_robot():
    other = load_robot("phantomx")
    with pytest.raises(InputError, match=r"links or mount of .* differ by .* mm"):
        run(RobotController(STRIDER), IdealPlant(other), [])
    with pytest.raises(InputError, match="but their legs are a, b, c, d, e, f and front left"):
        run(RobotController(STRIDER), IdealPlant(other.replace(leg_names=tuple("abcdef"))), [])
    turned = STRIDER.replace(mount_yaw=STRIDER.mount_yaw + np.array([0.0, 2 * math.pi + 0.2, 0, 0, 0, 0]))
    with pytest.raises(InputError, match=r"links or mount of middle left differ by \d+\.?\d* mm; at most"):
        run(RobotController(STRIDER), IdealPlant(turned), [])
    offset = STRIDER.replace(femur_axis_offset=np.tile([0.0, 0.08], (6, 1)))
    with pytest.raises(InputError, match="links or mount of front left differ by 80 mm"):
        run(RobotController(STRIDER), IdealPlant(offset), [])


def test_a_plant_with_errors_of_measures_is_the_same_robot():
    measured = STRIDER.replace(femur=1.02 * STRIDER.femur, body_mass=2 * STRIDER.body_mass, name="mine")
    assert run(RobotController(STRIDER), IdealPlant(measured), [], duration=0.1).motion.time[-1] == pytest.approx(0.1)


def test_a_limitation_that_ends_before_its_command_is_no_unmet_command():
    commands = [(0.0, (2.0, 0.0, 0.0)), (1.0, (0.02, 0.0, 0.0)), (2.0, Command(gait="wave", twist=(0.02, 0.0, 0.0)))]
    recording = run(RobotController(STRIDER), IdealPlant(STRIDER), commands, duration=8.0)
    (unmet,) = recording.unmet
    assert str(unmet.limitation.kind) == "twist"
    assert (unmet.time, unmet.until) == pytest.approx((0.01, 1.0), abs=0.011)
    assert unmet.limitation.granted < 1
    assert recording.problems == (f"not met in full, {unmet.text()}",)


def test_readings_that_were_rejected_for_a_moment_leave_no_command_unmet():
    class Disturbed(IdealPlant):
        def step(self, output, dt):
            bad = 0.5 < output.time < 0.6
            return dataclasses.replace(super().step(output, dt), attitude=(math.nan if bad else 0.0, 0.0))

    recording = run(RobotController(STRIDER), Disturbed(STRIDER), [(0.0, FORWARD)], duration=2.0)
    bad, settling = recording.events
    assert bad.text == "readings: attitude: not finite numbers"
    assert (bad.time, settling.until) == pytest.approx((0.52, 0.63), abs=0.011)
    assert recording.ok, recording.problems


def test_what_was_limited_until_shortly_before_its_command_was_replaced_is_met():
    controller = RobotController(STRIDER)
    limitation = Limitation(kind=LimitationKind.TWIST, cause="reach", asked=1.0, granted=0.5)
    for last, unmet in ((4, 0), (9, 1)):
        recorder = Recorder(controller)
        recorder.command(Command(twist=FORWARD))
        for tick in range(11):
            found = (limitation,) if tick <= last else ()
            recorder.tick(
                0.01 * (tick + 1), dataclasses.replace(controller.output, limitations=found), SensorReadings()
            )
        assert len(recorder.recording(name="", rate=100.0).unmet) == unmet
        recorder.command(Command(twist=(0.0, 0.0, 0.0)))
        assert len(recorder._unmet) == unmet


def test_joint_angles_that_are_not_measured_of_a_leg_are_recorded_as_missing():
    class Deaf(IdealPlant):
        def step(self, output, dt):
            return SensorReadings(joint_angles=[None, *output.angles[1:]])

    recording = run(RobotController(STRIDER), Deaf(STRIDER), [(0.0, FORWARD)], duration=0.1)
    assert np.isnan(recording.measured_angles[:, 0]).all()
    assert (recording.measured_angles[:-1, 1:] == recording.motion.angles[:-1, 1:]).all()


def test_a_command_that_changes_ends_what_was_not_met_of_it_and_nothing_else():
    controller = RobotController(STRIDER)
    recorder = Recorder(controller)
    found = (
        Limitation(kind=LimitationKind.READINGS, cause="attitude: not finite numbers"),
        Limitation(kind=LimitationKind.TWIST, cause="reach", asked=1.0, granted=0.5),
    )
    recorder.command(Command(twist=FORWARD))
    recorder.tick(0.01, dataclasses.replace(controller.output, limitations=found), SensorReadings())
    assert not recorder._unmet
    recorder.command(Command(twist=(0.0, 0.0, 0.0)))
    assert [unmet.limitation for unmet in recorder._unmet.values()] == list(found)
