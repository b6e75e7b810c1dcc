"""Feet that bear load and sink against the others: they slide over an edge before their switches open."""

import numpy as np
import pytest

import tarsus
from sample_contacts import FEET, STANDING
from tarsus.control.contact.tipping import Sinking
from tarsus.control.readings import ValidReadings

DT = 0.04


def found(speed, legs=(0, 2, 4), seconds=0.4, deeper=0.0, noise=0.0, scale=1.0, before=2.0, seed=1):
    """The leg that is found while the foot of the first one sinks at a speed [m/s]; None if there is none."""
    sinking, rng, leg = Sinking(scale), np.random.default_rng(seed), None
    for tick in range(round((before + seconds) / DT)):
        sunk = speed * max(tick * DT - before, 0.0)
        heights = {other: noise * rng.standard_normal() - sunk * (other == legs[0]) for other in legs}
        leg = sinking.step(heights, STANDING, DT, deeper=deeper) if leg is None else leg
    return leg


def test_a_foot_sinks_that_goes_down_faster_than_feet_roll():
    assert found(0.06) == 0
    assert found(0.06, legs=(5, 1, 3)) == 5
    assert found(0.02) is None
    assert found(0.06, seconds=0.08) is None
    # Where ground may be deeper, it is not at the edge yet.
    assert found(0.06, deeper=0.03) is None
    # A small robot sinks less.
    assert found(0.035, seconds=0.16) is None
    assert found(0.035, seconds=0.16, scale=0.2) == 0


@pytest.mark.parametrize("seed", range(5))
def test_a_foot_sinks_by_more_than_the_noise_of_what_is_measured(seed):
    assert found(0.0, seconds=10.0, noise=0.003, seed=seed) is None
    assert found(0.2, noise=0.003, seed=seed) == 0


def test_a_foot_that_others_hold_the_robot_without_sinks_without_harm():
    assert found(0.06, legs=range(6)) is None
    assert found(0.06, legs=(0, 1, 2, 3, 5)) is None
    assert found(0.06, legs=(0, 3)) is None


def test_feet_are_compared_anew_where_others_bear_load():
    sinking = Sinking(1.0)
    for legs in ((0, 2, 4), (1, 3, 5)):
        heights = {leg: 0.08 * (leg == legs[0]) for leg in legs}
        assert sinking.step(heights, STANDING, DT, deeper=0.0) is None
        assert sinking.step(dict.fromkeys(legs, 0.0), STANDING, DT, deeper=0.0) == legs[0]


def test_heights_of_feet_are_measured_along_gravity():
    """A body that turns as its feet measure keeps these level; angles that are not measured tell nothing."""
    robot = tarsus.load_robot("strider")
    controller = tarsus.WalkController(robot)
    readings = tarsus.SensorReadings(contacts=[True] * 6, attitude=(0.0, 0.0))
    controller.step((0.1, 0.0, 0.0), 0.01, readings)
    state, body = controller._tick.gait, controller._walk.ground.body
    footing, given = STANDING._replace(places=FEET, down=[leg % 2 == 0 for leg in range(6)]), []
    body._sinking.step = lambda heights, *_, **__: given.append(heights)
    pose = tarsus.Pose.from_rpy(position=controller.body.position, pitch=0.1)
    turned = tarsus.inverse_kinematics(robot, controller.feet, pose).angles
    for angles, pitch in ((controller.angles, 0.0), (turned, 0.1)):
        valid = ValidReadings(joint_angles=tuple(map(tuple, angles.tolist())), attitude=(0.0, pitch))
        body.measured, body.commanded = valid, controller.angles.tolist()
        body.sinks_at(state, footing, DT)
    for unknown in ({"joint_angles": None}, {"attitude": None}, {"predicted": frozenset({2})}):
        body.measured = valid._replace(**unknown)
        body.sinks_at(state, footing, DT)
    assert given[0].keys() == given[1].keys() == {0, 2, 4}
    relative = [[heights[leg] - heights[0] for leg in (2, 4)] for heights in given[:2]]
    assert relative[0] == pytest.approx(relative[1], abs=2e-3)
    assert given[2:] == [{}] * 3
