"""Gait states: standing, or at the beginning of a walk."""

import numpy as np

from sample_stances import posture_of, setup_of, velocity_limits_of
from tarsus.control.walk.state import GaitState, StepInputs

EARTH, FACING = 0.3 - 0.2j, 0.7


def moment_of(setup, rest, **changes):
    there = EARTH + np.exp(1j * FACING) * rest
    now = GaitState.standing(there, posture_of(setup))
    return now._replace(**{"origin": EARTH, "yaw": FACING, **changes})


def step_inputs_of(setup, rest, twist, **changes):
    values = {
        "gait": setup.gait,
        "frequency": 1.0,
        "twist": np.asarray(twist, dtype=float),
        "posture": posture_of(setup),
        "bandwidth": 4 / setup.gait.duty_factor,
        "posture_bandwidth": 4.0,
        "hold_feet": False,
        "rest": rest,
        "placement_bounds": np.full((len(rest), 16), np.inf),
        "placement_radii": [np.inf] * len(rest),
        "admittance_offset": np.zeros(len(rest)),
    }
    return StepInputs(**{**values, **changes})


def begun(setup, rest):
    """A standing state with the clock at the lift-off of leg 0."""
    offsets, duty_factor = np.asarray(setup.gait.offsets), setup.gait.duty_factor
    clock = float(offsets[0]) + duty_factor
    return moment_of(setup, rest, clock=clock, step_number=np.ceil(clock - offsets - duty_factor - 1e-9))


def rest_of(name):
    return velocity_limits_of(name).rest


__all__ = ["EARTH", "FACING", "begun", "moment_of", "rest_of", "setup_of", "step_inputs_of"]
