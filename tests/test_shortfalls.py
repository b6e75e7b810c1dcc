"""Which limitations follow from a stance that does not meet all of what is commanded."""

import dataclasses

import numpy as np
import pytest

from tarsus.control.limitation import Cause, LimitationKind
from tarsus.control.transition.stance_transition import WalkParameters
from tarsus.gait.gait import Gait

CAUSE = Cause("the reason", "front left")
ASKED = WalkParameters(
    gait=Gait.named("tripod"),
    body=(0.02, 0.0, 0.0, 0.0, 0.1, 0.0),
    body_height=0.12,
    swing_height=0.03,
    stance_width=0.01,
    cycle_time=None,
)
MET = np.array([0.02, 0.0, 0.12, 0.0, 0.1, 0.0, 0.03])


def limitations(posture, stance_width=0.01, asked=ASKED):
    found = asked.shortfalls(np.array(posture), CAUSE, stance_width=stance_width)
    assert all((each.cause, each.leg) == (CAUSE.reason, CAUSE.leg) for each in found)
    return {each.kind: (each.asked, each.granted) for each in found}


def changed(axis, by):
    return MET + by * np.eye(7)[axis]


def test_a_stance_that_meets_everything_has_no_limitation():
    assert limitations(MET) == {}


def test_each_quantity_has_its_numbers():
    assert limitations(changed(2, -0.02)) == {LimitationKind.BODY_HEIGHT: (0.12, pytest.approx(0.10))}
    assert limitations(changed(6, -0.01)) == {LimitationKind.SWING_HEIGHT: (0.03, pytest.approx(0.02))}
    assert limitations(MET, stance_width=0.004) == {LimitationKind.STANCE_WIDTH: (0.01, 0.004)}
    assert limitations(changed(0, -0.005)) == {LimitationKind.BODY: (1.0, pytest.approx(0.75))}
    both = limitations(changed(0, -0.005) + changed(4, -0.1) - MET)
    assert both == {LimitationKind.BODY: (1.0, pytest.approx(0.0))}


def test_a_height_missing_from_a_commanded_body_pose_is_the_poses():
    asked = dataclasses.replace(ASKED, body=(0.0, 0.0, 0.05, 0.0, 0.0, 0.0))
    posture = [0.0, 0.0, 0.16, 0.0, 0.0, 0.0, 0.03]
    assert limitations(posture, asked=asked) == {LimitationKind.BODY: (1.0, pytest.approx(0.8))}


def test_an_axis_that_is_not_at_its_commanded_0_is_a_missing_body_pose():
    assert limitations(changed(3, 0.05)) == {LimitationKind.BODY: (1.0, 0.0)}
    # Beside an axis that is commanded, that one tells how much is met.
    both = limitations(changed(3, 0.05) + changed(0, -0.005) - MET)
    assert both == {LimitationKind.BODY: (1.0, pytest.approx(0.75))}


def test_each_rejected_parameter_has_a_limitation():
    def kinds(posture=MET, **changes):
        asked = dataclasses.replace(ASKED, **changes)
        return {each.kind: each.asked for each in asked.rejected(ASKED, posture, CAUSE)}

    gaits = kinds(None, gait=Gait.named("wave"), excluded=(0,), cycle_time=0.7)
    assert gaits == {LimitationKind.GAIT: pytest.approx(np.nan, nan_ok=True), "foot_target": 1.0, "cycle_time": 0.7}
    assert list(kinds(None, gait=Gait.named("wave"), cycle_time=None)) == [LimitationKind.GAIT]
    assert kinds(sway=(0.1,) * 6) == {LimitationKind.SWAY: 1.0}
    assert kinds(body_height=0.2) == {LimitationKind.BODY_HEIGHT: 0.2}
