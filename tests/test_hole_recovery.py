"""Hole recovery: which requests are tried, and the repeated swing. Slope limit."""

import numpy as np

from sample_gait_states import moment_of, rest_of, setup_of, step_inputs_of
from tarsus.control.sensing.ground_plane import GroundPlane
from tarsus.control.terrain.hole_recovery import HoleRecovery, repeated_swing
from tarsus.control.terrain.slope_limit import SlopeLimit
from tarsus.control.walk.stepper import advance
from tarsus.control.workspace.stance_geometry import LEVEL_TERRAIN, TerrainEstimate

ON, BACK, LEFT = (((x, y, 0.0), "so") for x, y in ((0.1, 0.0), (-0.05, 0.0), (0.0, 0.1)))


def test_the_request_that_led_to_a_hole_is_not_tried_again_others_once():
    retreat = HoleRecovery()
    assert not retreat.consider(ON, 0j)
    assert not retreat.consider(ON, 0j)
    assert retreat.consider(BACK, 0j)
    assert retreat.active
    # Once it is under way, that is that.
    assert not retreat.consider(LEFT, 0j)
    retreat.begun([2])
    assert not retreat.active
    assert not retreat.consider(BACK, 0j)
    assert retreat.consider(LEFT, 0j)
    retreat.begun([2])
    # Where the robot gets on, another try makes sense.
    assert retreat.consider(LEFT, 0.01j)
    retreat.begun([2, 3])
    retreat.landed(np.arange(6) == 1)
    retreat.landed(np.arange(6) == 2)
    assert not retreat.consider(LEFT, 0.01j)
    # All feet are down: what is asked for by then leads there, should it happen again.
    retreat.landed(np.arange(6) == 3)
    assert not retreat.consider(BACK, 0.01j)
    assert retreat.consider(ON, 0.01j)


def test_a_foot_swings_again_to_another_foothold():
    setup, rest = setup_of("strider"), rest_of("strider")
    gait, hole = setup.gait, np.arange(6) == 2
    swing = 1 - gait.duty_factor
    clock = gait.offsets[2] + 1.0 + 0.01
    number = np.ceil(clock - np.asarray(gait.offsets) - gait.duty_factor - 1e-9)
    number[2] = 0
    now = moment_of(setup, rest, clock=clock, step_number=number, down=~hole, swing_phase=np.where(hole, 1.0, 0.0))
    now = now._replace(ground_height=np.where(hole, -0.02, 0.0))
    again = repeated_swing(now, [2], gait, GroundPlane(z=0.005))
    np.testing.assert_array_equal(again.foot, now.foot)
    np.testing.assert_allclose(again.height(setup.swing_height)[2], -0.02)
    # All others wait for as long as that takes.
    since = again.clock - (np.asarray(gait.offsets) + gait.duty_factor + again.step_number)
    np.testing.assert_allclose(since[2], 0, atol=1e-12)
    assert (since[~hole] <= -swing + 1e-9).all()
    inputs = step_inputs_of(setup, rest, (-0.05, 0.0, 0.0), frequency=1.0)
    landed = again
    while not landed.down[2]:
        landed = advance(landed, inputs, 0.005)
        assert landed.down[~hole].all()
    assert np.abs(landed.foot[2] - now.foot[2]) > 0.01
    np.testing.assert_allclose(landed.ground_height[2], 0.005)
    assert landed.step_number[2] == now.step_number[2] + 1


def test_requests_within_input_noise_are_equal():
    retreat = HoleRecovery()
    assert not retreat.consider(ON, 0j)
    assert not retreat.consider(((0.105, 0.01, 0.01), "so"), 0j)
    assert retreat.consider(((0.1, 0.0, 0.0), "otherwise"), 0j)
    still = HoleRecovery()
    assert not still.consider(((0.0, 0.0, 0.0), "so"), 0j)
    assert not still.consider(((5e-4, 0.0, 0.0), "so"), 0j)
    assert still.consider(((5e-3, 0.0, 0.0), "so"), 0j)


def test_the_slope_limit_refuses_twists_towards_infeasible_ground_only():
    steep, known = SlopeLimit(), TerrainEstimate(0.1 + 0j, 0.6)
    assert not steep.forbids((0.1, 0.0, 0.0), known)
    # Who stands was led there by nothing.
    steep.record(known, (0.0, 0.0, 0.0))
    assert not steep.forbids((0.1, 0.0, 0.0), known)
    steep.record(known, (0.05, 0.01, 0.1))
    steep.record(known, (-0.05, 0.0, 0.0))
    assert steep.forbids((0.1, 0.0, 0.0), known)
    assert steep.forbids((0.0, 0.0, 0.5), known)
    assert not steep.forbids((-0.1, 0.0, 0.0), known)
    assert not steep.forbids((0.0, 0.0, 0.0), known)
    # As soon as it stands on other ground, that is over.
    assert not steep.forbids((0.1, 0.0, 0.0), LEVEL_TERRAIN)
    assert not steep.forbids((0.1, 0.0, 0.0), known)
