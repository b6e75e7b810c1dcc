"""A plant whose commands compensate for the deflection of loaded joints."""

import dataclasses

import numpy as np
import pytest

import tarsus
from tarsus.control.compensated_plant import CompensatedPlant
from tarsus.errors import InputError, MissingDataError
from tarsus.load.deflection import SHARE
from tarsus.simulation import Outcome, SimulatedPlant, TracedPlant

ROBOT = tarsus.load_robot("strider")
SPRINGS = tarsus.JointSprings.uniform(ROBOT, 20.0)


class Executed:
    """A plant that keeps what it is given."""

    def __init__(self, robot=ROBOT):
        self.robot, self.outputs, self.stopped = robot, [], False

    def start(self, output):
        self.outputs = [output]

    def step(self, output, dt):
        self.outputs.append(output)
        return tarsus.SensorReadings(contacts=[True] * 6)

    def stop(self):
        self.stopped = True


def offsets(executed, output):
    return executed.outputs[-1].angles - output.angles


def test_a_standing_robot_is_commanded_a_share_of_torque_over_stiffness():
    executed, output = Executed(), tarsus.RobotController(ROBOT).output
    plant = CompensatedPlant(executed, springs=SPRINGS)
    plant.start(output)
    torques, _ = tarsus.joint_torques(ROBOT, output.angles, output.body, output.contacts)
    np.testing.assert_allclose(offsets(executed, output), SHARE * torques / 20.0, atol=1e-12)
    assert plant.step(output, 0.02).contacts == [True] * 6
    np.testing.assert_allclose(offsets(executed, output), SHARE * torques / 20.0, atol=1e-12)
    assert not executed.outputs[-1].angles.flags.writeable
    # All else is as the controller gave it out.
    assert executed.outputs[-1].body is output.body
    plant.stop()
    assert executed.stopped


def test_the_share_the_payload_and_the_stiffness_count():
    output = tarsus.RobotController(ROBOT).output

    def moved(**given):
        executed = Executed()
        CompensatedPlant(executed, **{"springs": SPRINGS, **given}).start(output)
        return offsets(executed, output)

    once = moved()
    np.testing.assert_allclose(moved(share=1.0), once / SHARE, atol=1e-12)
    np.testing.assert_allclose(moved(springs=tarsus.JointSprings.uniform(ROBOT, 10.0)), 2 * once, atol=1e-12)
    assert (moved(share=0.0) == 0).all()
    assert np.abs(moved(payload=0.5)).max() > 1.1 * np.abs(once).max()
    own = tarsus.JointSprings.of(ROBOT).stiffness
    np.testing.assert_allclose(moved(springs=None), once * 20.0 / own, atol=1e-12)


@pytest.mark.parametrize("changes", [{"belly": True}, {"contacts": np.zeros(6, dtype=bool)}])
def test_without_load_only_the_legs_weigh(changes):
    executed, output = Executed(), dataclasses.replace(tarsus.RobotController(ROBOT).output, **changes)
    CompensatedPlant(executed, springs=SPRINGS).start(output)
    down, up = np.ones(6, dtype=bool), np.zeros((6, 3))
    torques, _ = tarsus.joint_torques(ROBOT, output.angles, output.body, down, forces=up)
    np.testing.assert_allclose(offsets(executed, output), SHARE * torques / 20.0, atol=1e-12)


def test_a_foot_takes_over_its_load_gradually():
    executed, controller = Executed(), tarsus.RobotController(ROBOT)
    plant, output = CompensatedPlant(executed, springs=SPRINGS), controller.output
    plant.start(output)
    lifted = dataclasses.replace(output, contacts=np.array([True, False] * 3))
    before, steps = offsets(executed, output), []
    for _ in range(30):
        plant.step(lifted, 0.01)
        steps.append(offsets(executed, lifted))
    steps = np.array([before, *steps])
    torques, _ = tarsus.joint_torques(ROBOT, lifted.angles, lifted.body, lifted.contacts)
    np.testing.assert_allclose(steps[-1], SHARE * torques / 20.0, atol=1e-4)
    assert np.abs(np.diff(steps, axis=0)).max() < 0.2 * np.abs(steps[-1] - steps[0]).max()


def test_commands_stay_within_the_limits():
    executed, output = Executed(), tarsus.RobotController(ROBOT).output
    CompensatedPlant(executed, springs=tarsus.JointSprings.uniform(ROBOT, 0.1)).start(output)
    angles, limits = executed.outputs[0].angles, np.asarray(ROBOT.limits)
    assert (angles >= limits[..., 0]).all()
    assert (angles <= limits[..., 1]).all()
    # A joint that is beyond its limit is not moved further, nor back at once.
    beyond = output.angles.copy()
    beyond[0, 0] = limits[0, 0, 1] + 0.1
    CompensatedPlant(executed, springs=SPRINGS).start(dataclasses.replace(output, angles=beyond))
    assert executed.outputs[0].angles[0, 0] == pytest.approx(beyond[0, 0], abs=0.01)


@pytest.mark.parametrize("share", [-0.1, 1.1, np.nan])
def test_a_wrong_share_is_refused(share):
    with pytest.raises(InputError, match=r"share is .*; it must be a number from 0 to 1"):
        CompensatedPlant(Executed(), share=share)


def test_unknown_masses_and_servos_are_named():
    with pytest.raises(MissingDataError, match="mass_kg"):
        CompensatedPlant(Executed(tarsus.load_robot("freenove")), springs=SPRINGS)
    with pytest.raises(MissingDataError, match="servo"):
        CompensatedPlant(Executed(ROBOT.replace(servos=((None,) * 3,) * 6)))


def walked(robot, *, compensate):
    """Outcome of a live walk with servos of the catalogue, and how much the body sags in it [m]."""
    traced = TracedPlant(SimulatedPlant(robot, sensors="blind"))
    plant = CompensatedPlant(traced) if compensate else traced
    commands = [(0.0, tarsus.Command(twist=(0.04, 0.0, 0.0))), (1.6, tarsus.Command(twist=(0.0, 0.0, 0.0)))]
    tarsus.run(tarsus.RobotController(robot, tarsus.Gait.named("tripod")), plant, commands, duration=2.4)
    trace = traced.trace
    sag = trace.commanded_body.position[:, 2] + robot.foot_radius.max() - trace.body.position[:, 2]
    return Outcome.of(trace), float(np.median(sag))


def test_a_live_walk_covers_its_way_and_keeps_its_height_in_physics():
    robot = tarsus.load_robot("ch3r")
    (before, low), (after, kept) = (walked(robot, compensate=compensate) for compensate in (False, True))
    assert before.way_ratio < 0.9
    assert after.way_ratio == pytest.approx(1.0, abs=0.02)
    assert after.slip < 0.3 * before.slip
    assert low > 0.008
    assert abs(kept) < 0.3 * low
