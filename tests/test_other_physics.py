"""Robots feel the ground where physics and readings differ from what the controller is told."""

import pytest

import other_physics


@pytest.mark.no_cover
@pytest.mark.parametrize(
    ("robot", "ground", "differs"),
    [
        ("strider", "blocks60", "readings missing in 50 % of ticks"),
        ("phantomx", "blocks60", "payload 20 mm behind, 30 mm aside and above"),
        ("makeyourpet", "blocks60", "torsional and rolling friction of 5 mm"),
        ("makeyourpet", "flat", "twice the rotor inertia"),
        ("strider", "blocks60", "contacts of 60 ms"),
    ],
)
def test_robots_walk_on_where_something_differs(robot, ground, differs):
    found = other_physics.walk((robot, ground, differs, 0))
    assert found.way > 0.85
    assert found.steepest < 12
    assert not found.touched


@pytest.mark.no_cover
def test_feet_slip_more_where_friction_is_less_and_get_as_far():
    slick, grippy = (other_physics.walk(("phantomx", "flat", f"friction {value}", 0)) for value in (0.45, 1.6))
    assert slick.slip > 3 * grippy.slip
    assert slick.way > 0.95
    assert grippy.way > 0.95
