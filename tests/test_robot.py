"""The robot as a value: its shapes, its defaults, what it refuses, and that nothing can change it."""

import array_api_strict
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from tarsus.errors import InputError, MissingDataError, UnknownNameError
from tarsus.robot.file import load_robot, robot_from_dict, robot_to_dict, save_robot
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.robot import JOINTS, GaitDefaults, Robot, Source, stack_robots
from tarsus.robot.servo import Servo

LEGS = ("front left", "middle left", "rear left", "rear right", "middle right", "front right")
NEEDED = {
    "name": "six",
    "leg_names": LEGS,
    "mount_position": np.arange(18.0).reshape(6, 3),
    "mount_yaw": np.linspace(0.5, -0.5, 6),
    "coxa": np.full(6, 0.05),
    "femur": np.full(6, 0.08),
    "tibia": np.full(6, 0.13),
    "limits": np.broadcast_to([-1.0, 2.0], (6, 3, 2)),
}


def six(**changes):
    return Robot(**{**NEEDED, **changes})


def test_omitted_values_are_defaults_or_unknown():
    robot = six()
    assert robot.legs == 6
    assert robot.batch_shape == ()
    np.testing.assert_array_equal(robot.femur_axis_offset, np.zeros((6, 2)))
    np.testing.assert_array_equal(robot.foot_radius, np.zeros(6))
    np.testing.assert_array_equal(robot.body_com, np.zeros(3))
    np.testing.assert_array_equal(robot.link_com, [[0.025, 0.04, 0.065]] * 6)
    assert (robot.link_mass, robot.body_mass, robot.body_size) == (None, None, None)
    assert robot.servos == ((None,) * len(JOINTS),) * 6
    assert robot.gait == GaitDefaults(name="tripod", body_height=None, swing_height=None)
    assert robot.sources == ()


def test_arrays_are_copied_in_and_locked():
    femur = np.full(6, 0.08)
    robot = six(femur=femur, body_mass=1)
    femur[:] = 1
    np.testing.assert_array_equal(robot.femur, 0.08)
    for name in ("femur", "limits", "body_mass", "link_com", "foot_radius"):
        assert not getattr(robot, name).flags.writeable
    with pytest.raises(ValueError, match="read-only"):
        robot.femur[0] = 1


def test_arrays_of_other_libraries_are_kept():
    femur = jnp.full(6, 0.08)
    robot = six(femur=femur)
    assert robot.femur is femur
    assert robot.link_com.shape == (6, 3)
    slope = jax.grad(lambda length: six(femur=jnp.full(6, length)).geometry.farthest2.sum())(0.1)
    assert slope == pytest.approx(6 * 2 * (0.1 + 0.13), rel=1e-6)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"femur": np.full(5, 0.08)}, r"femur has shape \(5,\); expected \(\.\.\., 6\)"),
        ({"femur": np.zeros(5)}, r"femur has shape \(5,\); expected \(\.\.\., 6\)"),
        ({"limits": np.zeros((6, 3))}, r"limits has shape \(6, 3\); expected \(\.\.\., 6, 3, 2\)"),
        ({"body_com": [0, 0]}, r"body_com has shape \(2,\); expected \(\.\.\., 3\)"),
        ({"femur": "long"}, "femur: expected an array of numbers"),
        ({"femur": [[1], [1, 2]]}, "femur: expected an array of numbers"),
        ({"mount_yaw": np.full(6, np.nan)}, "mount_yaw contains a value that is not a finite number"),
        ({"tibia": np.full(6, np.inf)}, "tibia contains a value that is not a finite number"),
        ({"femur": np.zeros(6)}, "femur is 0; it must be greater than 0"),
        ({"body_mass": -1.0}, "body_mass is -1; it must be greater than 0"),
        ({"coxa": np.full(6, -0.5)}, "coxa is -0.5; it must not be negative"),
        ({"link_mass": np.full((6, 3), -1.0)}, "link_mass is -1; it must not be negative"),
        ({"limits": np.broadcast_to([2.0, -1.0], (6, 3, 2))}, "a lower limit is greater than its upper limit"),
        ({"servos": ((None,) * 3,) * 5}, "servos must have three entries for each of the 6 legs"),
        ({"servos": ((None,) * 2,) * 6}, "servos must have three entries for each of the 6 legs"),
        ({"coxa": np.ones((2, 6)), "femur": np.ones((3, 6))}, "don't broadcast"),
        ({"name": 5}, "name of the robot is 5; it must be text"),
        ({"name": "a\ud800"}, r"'a\\ud800'; it must not contain control characters, such as U\+D800"),
        (
            {"leg_names": ["a\tb", *"cdefg"]},
            r"name of a leg is 'a\\tb'; it must not contain control .*, such as U\+0009",
        ),
    ],
)
def test_wrong_shapes_and_ranges_are_refused(changes, message):
    with pytest.raises(InputError, match=message):
        six(**changes)


def test_a_field_that_a_robot_lacks_is_named_with_the_nearest():
    with pytest.raises(
        UnknownNameError, match=r"^no field of a robot is called 'femr'\. Did you mean 'femur'\? There are"
    ):
        six().replace(femr=np.full(6, 0.1))


def test_an_empty_batch_of_designs():
    assert six(femur=np.ones((0, 6))).batch_shape == (0,)


def test_robots_are_equal_when_every_number_is():
    robot = six(body_mass=1.0)
    same = six(body_mass=1.0)
    assert robot == same
    assert hash(robot) == hash(same)
    assert len({robot, same}) == 1
    assert robot != six()
    assert robot != six(body_mass=1.0, femur=np.full(6, 0.081))
    assert robot != six(body_mass=1.0, gait=GaitDefaults(name="wave"))
    assert robot != six(body_mass=1.0, sources=(Source(of=("leg",), source="me", confidence="A"),))
    assert robot != six(body_mass=1.0, servos=((Servo(name="x", stall_torque=1.0),) * 3,) * 6)
    assert robot != "six"


def test_robots_of_which_one_lacks_an_array_differ():
    robot = six(body_mass=1.0, body_size=[0.2, 0.1, 0.05], link_mass=np.full((6, 3), 0.1))
    for name in ("body_mass", "body_size", "link_mass"):
        lacking = robot.replace(**{name: None})
        assert robot != lacking
        assert lacking != robot
        assert lacking == robot.replace(**{name: None})


def test_a_batch_of_designs_broadcasts():
    robot = six(femur=np.full((4, 1, 6), 0.1), coxa=np.full((3, 6), 0.02), body_mass=np.ones(3))
    assert robot.batch_shape == (4, 3)
    assert robot.geometry.farthest2.shape == (4, 1, 6)


def test_replacing_checks_again():
    robot = six()
    assert robot.replace(name="other").name == "other"
    with pytest.raises(InputError, match="femur is -1"):
        robot.replace(femur=np.full(6, -1.0))


def test_missing_masses_are_refused_where_required():
    assert six(body_mass=1.0, link_mass=np.ones((6, 3))).has_masses
    six(body_mass=1.0, link_mass=np.ones((6, 3))).require_masses()
    for changes, missing in [
        ({}, r"\[body\] mass_kg and \[leg\] mass_kg missing"),
        ({"body_mass": 1.0}, r"'six': \[leg\] mass_kg missing"),
        ({"link_mass": np.ones((6, 3))}, r"'six': \[body\] mass_kg missing"),
    ]:
        robot = six(**changes)
        assert not robot.has_masses
        with pytest.raises(MissingDataError, match=missing):
            robot.require_masses()


@pytest.mark.parametrize(
    ("names", "codes"),
    [
        (LEGS, ("LF", "LM", "LR", "RR", "RM", "RF")),
        (("front left", "far left", "rear left", "rear right", "middle right", "front right"), None),
        (("a", "b", "c", "d", "e", "f"), None),
    ],
)
def test_legs_have_short_names_where_these_are_unique(names, codes):
    assert six(leg_names=names).leg_codes == (codes or names)


def test_robots_are_stacked_along_a_new_first_axis():
    longer = six(femur=np.full(6, 0.1))
    both = stack_robots([six(), longer])
    assert both.batch_shape == (2,)
    np.testing.assert_array_equal(both.femur, [[0.08] * 6, [0.1] * 6])
    assert both.body_mass is None
    assert stack_robots([both, both]).batch_shape == (2, 2)


def test_robots_that_differ_in_shape_are_not_stacked():
    with pytest.raises(InputError, match="the sequence of robots is empty"):
        stack_robots([])
    with pytest.raises(InputError, match="body_mass is known for some of the robots and unknown for others"):
        stack_robots([six(), six(body_mass=1.0)])
    with pytest.raises(InputError, match="femur differs in shape between the robots"):
        stack_robots([six(), six(femur=np.ones((2, 6)))])


def test_the_geometry_is_computed_once():
    robot = six(femur_axis_offset=np.broadcast_to([0.01, -0.02], (6, 2)))
    geometry = robot.geometry
    assert geometry is robot.geometry
    np.testing.assert_array_equal(geometry.cos_yaw, np.cos(robot.mount_yaw))
    np.testing.assert_array_equal(geometry.sin_yaw, np.sin(robot.mount_yaw))
    np.testing.assert_array_equal([geometry.mount_x, geometry.mount_y, geometry.mount_z], robot.mount_position.T)
    np.testing.assert_array_equal(geometry.side, 0.01)
    np.testing.assert_array_equal(geometry.up, -0.02)
    np.testing.assert_allclose(geometry.farthest2, 0.21**2)
    np.testing.assert_allclose(geometry.nearest2, 0.05**2)
    np.testing.assert_allclose(geometry.sum2, 0.08**2 + 0.13**2)
    np.testing.assert_allclose(geometry.difference2, 0.08**2 - 0.13**2)
    np.testing.assert_array_equal(geometry.femur_lower, -1)
    np.testing.assert_array_equal(geometry.tibia_upper, 2)


def test_the_geometry_moves_to_another_library():
    geometry = six().geometry
    assert geometry.to(np) is geometry
    strict = geometry.to(array_api_strict)
    for mine, theirs in zip(geometry, strict, strict=True):
        assert isinstance(theirs, type(array_api_strict.asarray(0.0)))
        np.testing.assert_array_equal(np.asarray(theirs), mine)


def test_the_geometry_of_single_legs():
    picked = six().geometry.pick((np.array([0, 1]), np.array([0, 5])), (2, 6))
    assert isinstance(picked, LegGeometry)
    np.testing.assert_array_equal(picked.mount_x, [0, 15])


def test_the_geometry_of_a_block_is_transposed():
    geometry = six(femur=np.arange(1.0, 31.0).reshape(5, 6)).geometry
    part = geometry.take((slice(1, 3),), (2,))
    np.testing.assert_array_equal(part.femur, geometry.femur[1:3].T)
    np.testing.assert_array_equal(part.coxa, geometry.coxa[:, None])


def test_one_design_of_a_batch():
    femur = np.arange(1.0, 37.0).reshape(3, 2, 6)
    batch = six(femur=femur, coxa=np.arange(12.0).reshape(2, 6), body_mass=np.arange(1.0, 4.0)[:, None])
    one = batch.item((2, 1))
    assert one.batch_shape == ()
    np.testing.assert_array_equal(one.femur, femur[2, 1])
    np.testing.assert_array_equal(one.coxa, np.arange(6.0, 12.0))
    assert one.body_mass == 3
    assert one.link_mass is None
    np.testing.assert_array_equal(six(femur=femur[0]).item((2, 1), of=(3, 2)).femur, femur[0, 1])
    single = six()
    assert single.item(()) is single
    assert isinstance(six(femur=jnp.full(6, 0.08)).item(()).femur, np.ndarray)


def test_a_preset_survives_its_dict_and_a_file(tmp_path):
    robot = load_robot("strider")
    assert robot_from_dict(robot_to_dict(robot)) == robot
    save_robot(robot, tmp_path / "strider.toml")
    assert load_robot(tmp_path / "strider.toml") == robot


def test_limits_beyond_half_a_turn_are_refused():
    robot = load_robot("strider")
    limits = np.array(robot.limits)
    limits[0, 1, 1] = np.pi
    assert robot.replace(limits=limits).limits[0, 1, 1] == np.pi
    limits[0, 1, 1] = np.radians(200)
    with pytest.raises(InputError, match=r"limits reach 200.0 deg; they must be from -180 to 180 deg"):
        robot.replace(limits=limits)
