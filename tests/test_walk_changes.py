"""Changes of a walk that help the servos: each factor is that of the walk planned anew."""

from dataclasses import replace

import numpy as np
import pytest

from sample_loads import robot_of, sample_loads
from tarsus.errors import UnreachableError
from tarsus.gait.gait import Gait
from tarsus.gait.path import straight_path
from tarsus.gait.plan import plan_walk
from tarsus.load.compliant.decisive_loads import decisive_loads
from tarsus.load.compliant.for_loads import compliant_or_missing
from tarsus.load.loads import joint_loads
from tarsus.load.verdict import joint_verdicts
from tarsus.load.walk_changes import walk_changes

PATH = straight_path(0.3)


def planner(name, gait="tripod", asked=None):
    robot = robot_of(name)

    def plan(**options):
        if asked is not None:
            asked.append(options)
        return plan_walk(robot, options.pop("gait", Gait.named(gait)), PATH, rate=50, **options)

    return plan


def judged(loads):
    """The loads by which servos are judged."""
    return decisive_loads(loads, compliant_or_missing(loads)[0])


@pytest.mark.parametrize("name", ["strider", "burnt-mg996r"])
def test_every_factor_is_that_of_the_walk_with_the_change(name):
    found = sample_loads(name)
    plan, least = planner(name), float(judged(found).factor.min())
    changes = walk_changes(found, plan)
    factors = [change.factor for change in changes]
    assert factors == sorted(factors, reverse=True)
    assert min(factors) > 1.02 * least
    for change in changes:
        motion = plan(**change.options)
        verdicts = joint_verdicts(judged(joint_loads(found.robot, motion)))
        assert motion.ok
        assert change.factor == pytest.approx(min(verdict.factor for verdict in verdicts))
        assert change.thermal_ratio == pytest.approx(max(verdict.thermal_ratio for verdict in verdicts))
    texts = [change.text for change in changes]
    assert any(text.startswith("raise the body by ") for text in texts)
    assert any(text.startswith("feet ") for text in texts)
    assert any(text == "wave gait" for text in texts)
    # The best is several of them together.
    assert ", " in texts[0]


def test_a_higher_body_helps_the_strider_as_much_as_any_single_change():
    changes = {change.text: change.factor for change in walk_changes(sample_loads(), planner("strider"))}
    (raised,) = (factor for text, factor in changes.items() if text.startswith("raise") and ", " not in text)
    assert raised > 0.98 * max(factor for text, factor in changes.items() if ", " not in text)
    assert raised / judged(sample_loads()).factor.min() > 1.3


def test_no_more_than_required_is_changed():
    asked = []
    changes = walk_changes(sample_loads(), planner("strider", asked=asked), safety_factor=1.8)
    (higher,) = [c for c in changes if set(c.options) == {"body_height"}]
    assert higher.factor >= 1.8
    heights = [options["body_height"] for options in asked if set(options) == {"body_height"}]
    assert max(heights) == higher.options["body_height"]


def test_nothing_helps_where_no_other_walk_is_possible_or_servos_are_unknown():
    def impossible(**options):
        raise UnreachableError("no walk")

    found = sample_loads()
    assert walk_changes(found, impossible) == ()
    assert walk_changes(replace(found, robot=found.robot.replace(servos=())), planner("strider")) == ()
    idle = replace(found, torques=np.zeros_like(found.torques))
    assert walk_changes(idle, planner("strider")) == ()


def test_walks_that_are_not_possible_are_left_out():
    fast = sample_loads()
    slow = [[replace(servo, no_load_speed=1e-3) for servo in row] for row in fast.robot.servos]
    robot = fast.robot.replace(servos=slow)

    def plan(**options):
        return plan_walk(robot, options.pop("gait", Gait.named("tripod")), PATH, rate=50, cycle_time=1.0, **options)

    assert walk_changes(replace(fast, robot=robot), plan) == ()
