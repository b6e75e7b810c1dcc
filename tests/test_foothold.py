"""Footholds in the air: in the middle of the stance to come, and within their bounds when the foot touches down."""

import math

import numpy as np
import pytest

from sample_gait_states import setup_of, step_inputs_of
from tarsus.control.filters import CriticallyDamped
from tarsus.control.walk.foothold import FootholdPredictor
from tarsus.control.walk.state import GaitState
from tarsus.gait.foot_polygons import NORMALS

REST = 0.2 + 0.1j


def predictor(twist, bound):
    """A predictor for feet that may be put down this far from their rest foothold."""
    bounds = {"placement_bounds": np.full((6, 16), bound), "placement_radii": [bound] * 6}
    inputs = step_inputs_of(setup_of("strider"), np.full(6, REST), twist, bandwidth=8.0, **bounds)
    now = GaitState.standing(np.full(6, REST), np.zeros(13))
    now = now._replace(origin=0.3 + 0.2j, yaw=0.4, twist=CriticallyDamped.still(np.array(twist)))
    return FootholdPredictor(now, inputs)


def seen_at_touchdown(foothold, twist, touchdown):
    """The foothold relative to the rest foothold, in the heading frame at touchdown, for a constant twist."""
    vx, vy, turn = twist
    angle = turn * touchdown
    travel = complex(vx, vy) * touchdown
    if turn:
        travel = complex(vx, vy) * (complex(math.cos(angle), math.sin(angle)) - 1) / (1j * turn)
    heading = complex(math.cos(0.4), math.sin(0.4))
    in_start = (foothold - (0.3 + 0.2j)) / heading
    return (in_start - travel) * complex(math.cos(angle), -math.sin(angle)) - REST


@pytest.mark.parametrize("twist", [(0.1, 0.0, 0.0), (0.05, -0.03, 0.4), (0.0, 0.0, -1.0)])
def test_wide_bounds_leave_the_foothold_in_the_middle_of_the_stance(twist):
    found = predictor(twist, 1.0).foothold(2, 0.2, 0.5)
    assert abs(seen_at_touchdown(found, twist, 0.5)) < 1e-9


@pytest.mark.parametrize("twist", [(0.3, 0.0, 0.0), (0.1, -0.2, 0.8), (0.0, 0.0, -2.0)])
def test_narrow_bounds_hold_at_touchdown(twist):
    found = predictor(twist, 0.004).foothold(2, 0.2, 0.5)
    out = seen_at_touchdown(found, twist, 0.2)
    distances = (out * NORMALS.conjugate()).real
    assert distances.max() == pytest.approx(0.004, abs=1e-9)
