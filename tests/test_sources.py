"""The five source documents, row by row: what is right in them is reproduced, what is wrong is held to its correction.

docs/sources.md describes the documents, maps their symbols and lists the errata; every test here is named there.
"""

from __future__ import annotations

import inspect
import math
import re
import sys
from pathlib import Path

import numpy as np
import pytest

from gait_robots import point_feet
from tarsus import (
    Gait,
    Pose,
    Reach,
    Robot,
    coxa_frames,
    curved_path,
    default_stance,
    forward_kinematics,
    inverse_kinematics,
    leg_jacobian,
    load_robot,
    plan_walk,
    reachable_band,
    stability_margin,
    straight_path,
)
from tarsus.load.handbook.method import handbook
from tarsus.load.torque import joint_torques

PAGE = Path(__file__).parent.parent / "docs" / "sources.md"

# Source 004's numbers [kg, m, m/s^2, rad, s]. The lever arms of its stance torques are not those of its links.
S004 = {
    "g": 9.8,
    "body": 1.386,
    "coxa": 0.04,
    "femur": 0.16,
    "tibia": 0.08,
    "coxa as written in the sums": 0.05,
    "L_coxa": 0.068,
    "L_femur": 0.098,
    "L_tibia": 0.181,
    "com_coxa": 0.034,
    "com_femur": 0.049,
    "com_tibia": 0.078,
    "R_b": 0.086,
    "stance L_femur": 0.069,
    "stance com_femur": 0.0345,
    "swing": 1.0472,
    "time": 2.0,
    "a": 1.0,
    "rod about its end": 0.33,
    "rod about its middle": 0.0833,
    "cube": 0.1666,
    "safety": 3.0,
}

TIGHT = 1e-12

R_B = np.array([S004["R_b"], 0.0, 0.0])


def one_leg(
    coxa: float = 0.052,
    femur: float = 0.066,
    tibia: float = 0.133,
    *,
    offset: tuple[float, float] = (0.0, 0.0),
    position: tuple[float, float, float] = (0.0, 0.0, 0.0),
    yaw: float = 0.0,
) -> Robot:
    """A robot of one leg, by default with its coxa frame as the body frame; it can't turn its back on a foot."""
    return Robot(
        name="one leg",
        leg_names=("front left",),
        mount_position=[position],
        mount_yaw=[yaw],
        coxa=[coxa],
        femur=[femur],
        tibia=[tibia],
        femur_axis_offset=[offset],
        limits=[[(-3.0, 3.0), (-math.pi, math.pi), (-math.pi, math.pi)]],
    )


def random_angles(seed: int, count: int = 400, *, coxa: float = 1.2) -> np.ndarray:
    """Angles of a leg with its knee up and its foot well in front of the coxa axis."""
    rng = np.random.default_rng(seed)
    low, high = (-coxa, -0.6, -2.2), (coxa, 1.2, -0.2)
    return rng.uniform(low, high, (count, 1, 3))


def random_feet(robot: Robot, seed: int, **angles: float) -> tuple[np.ndarray, np.ndarray]:
    """Feet in B ``(n, 3)`` of the robot's one leg, and the angles ``(n, 3)`` they were made from."""
    q = random_angles(seed, **angles)
    feet = forward_kinematics(robot, q)[:, 0, 3]
    # The formulas of the sources take the foot to be in front of the coxa axis.
    front = np.hypot(feet[:, 0], feet[:, 1]) > float(robot.coxa[0])
    front &= forward_kinematics(robot, q * (0, 1, 1))[:, 0, 3, 0] > float(robot.coxa[0])
    return feet[front], q[front, 0]


def solve(robot: Robot, feet: np.ndarray, **options: str) -> np.ndarray:
    """Angles ``(n, 3)`` for the robot's one leg."""
    return inverse_kinematics(robot, feet[:, None, :], **options).require().angles[:, 0]


def printed(value: float) -> object:
    """A number as a document prints it: equal to what rounds, or is cut off, to its last digit."""
    digits = len(f"{value!r}".split(".")[1])
    return pytest.approx(value, rel=0, abs=10.0**-digits)


# 000: leg inverse kinematics


def test_000_coxa_angle_is_the_direction_of_the_foot() -> None:
    feet, q = random_feet(one_leg(), 1)
    assert np.arctan2(feet[:, 1], feet[:, 0]) == pytest.approx(solve(one_leg(), feet)[:, 0], abs=TIGHT)
    assert np.arctan2(feet[:, 1], feet[:, 0]) == pytest.approx(q[:, 0], abs=TIGHT)


def femur_000(feet: np.ndarray, reach: np.ndarray, femur: float, tibia: float) -> np.ndarray:
    """theta_F with the horizontal reach from the femur axis given."""
    a2 = feet[:, 2] ** 2 + reach**2
    return np.arccos((tibia**2 - femur**2 - a2) / (-2 * femur * np.sqrt(a2))) - np.arctan(-feet[:, 2] / reach)


def tibia_000(feet: np.ndarray, reach: np.ndarray, femur: float, tibia: float) -> np.ndarray:
    """theta_T with the horizontal reach from the femur axis given."""
    a2 = feet[:, 2] ** 2 + reach**2
    return np.arccos((a2 - femur**2 - tibia**2) / (-2 * femur * tibia)) - math.pi / 2


def test_000_femur_angle_by_the_law_of_cosines() -> None:
    feet, _ = random_feet(one_leg(), 2)
    reach = np.hypot(feet[:, 0], feet[:, 1]) - 0.052
    assert femur_000(feet, reach, 0.066, 0.133) == pytest.approx(solve(one_leg(), feet)[:, 1], abs=1e-9)


def test_000_tibia_angle_from_the_perpendicular_of_the_femur() -> None:
    feet, _ = random_feet(one_leg(), 3)
    reach = np.hypot(feet[:, 0], feet[:, 1]) - 0.052
    assert tibia_000(feet, reach, 0.066, 0.133) == pytest.approx(solve(one_leg(), feet)[:, 2] + math.pi / 2, abs=1e-9)


def test_000_leg_point_to_body_point_by_the_attachment_point() -> None:
    robot = load_robot("phantomx")
    frames = coxa_frames(robot)
    point = np.array([0.12, 0.03, -0.09])
    in_body = frames @ np.broadcast_to(point, (6, 3))
    for leg in range(6):
        (x, y, z), yaw = robot.mount_position[leg], float(robot.mount_yaw[leg])
        by_hand = (
            x + point[0] * math.cos(yaw) - point[1] * math.sin(yaw),
            y + point[0] * math.sin(yaw) + point[1] * math.cos(yaw),
            z + point[2],
        )
        assert in_body[leg] == pytest.approx(by_hand, abs=TIGHT)
    assert frames.inverse() @ in_body == pytest.approx(np.broadcast_to(point, (6, 3)), abs=TIGHT)


def test_000_a_tripod_steps_forward_together() -> None:
    robot, gait = load_robot("strider"), Gait.named("tripod")
    motion = plan_walk(robot, gait, straight_path(0.3), stroke=0.05, body_height=0.11)
    in_air = {tuple(np.flatnonzero(~row)) for row in motion.contacts}
    assert in_air == {(), (0, 2, 4), (1, 3, 5)}
    moved = motion.feet[-1] - motion.feet[0]
    assert moved == pytest.approx(np.broadcast_to([0.3, 0, 0], (6, 3)), abs=1e-9)


def test_000_erratum_reach_is_horizontal_not_along_x() -> None:
    feet, q = random_feet(one_leg(), 4)
    as_printed = feet[:, 0] - 0.052
    usable = (as_printed > 0.01) & (np.hypot(as_printed, feet[:, 2]) > 0.07) & (np.abs(q[:, 0]) > 0.3)
    feet, as_printed = feet[usable], as_printed[usable]
    off = np.abs(femur_000(feet, as_printed, 0.066, 0.133) - solve(one_leg(), feet)[:, 1])
    assert off.min() > math.radians(0.1)
    assert off.max() > math.radians(20)
    ahead = feet * (1, 0, 1)
    ahead[:, 0] = np.hypot(feet[:, 0], feet[:, 1])
    assert femur_000(ahead, ahead[:, 0] - 0.052, 0.066, 0.133) == pytest.approx(solve(one_leg(), ahead)[:, 1], abs=1e-9)


def test_000_erratum_the_derivation_means_l_x_less_l_c() -> None:
    """`P_T` is defined nowhere; a tibia's index suggests the tibia's length, which is off by tens of degrees."""
    feet, q = random_feet(one_leg(), 5)
    a = np.hypot(feet[:, 2], np.hypot(feet[:, 0], feet[:, 1]) - 0.052)
    beta = np.arccos((0.133**2 - 0.066**2 - a**2) / (-2 * 0.066 * a))
    l_x = np.hypot(feet[:, 0], feet[:, 1])
    assert beta - np.arctan(-feet[:, 2] / (l_x - 0.052)) == pytest.approx(solve(one_leg(), feet)[:, 1], abs=1e-9)
    assert np.abs(beta - np.arctan(-feet[:, 2] / (0.133 - 0.052)) - q[:, 1]).max() > math.radians(30)


# 001: leg inverse kinematics with an offset femur axis, straight and curved walks, tilt

DEC = (0.052, 0.015, -0.008)
"""Dec_X2, Dec_Y2, Dec_Z2 [m]."""


def offset_leg() -> Robot:
    return one_leg(DEC[0], offset=DEC[1:])


def px_a2_printed(b: np.ndarray, c: np.ndarray | float) -> np.ndarray:
    t2 = math.pi / 2 + math.atan(DEC[0] / DEC[1])
    return np.sqrt(b**2 - c**2 * math.sin(t2) ** 2) + c * math.cos(t2)


def test_001_reach_from_an_offset_femur_axis() -> None:
    feet, _ = random_feet(offset_leg(), 11)
    b = np.hypot(feet[:, 0], feet[:, 1])
    reduced = np.sqrt(b**2 - DEC[1] ** 2) - DEC[0]
    assert px_a2_printed(b, math.hypot(*DEC[:2])) == pytest.approx(reduced, abs=TIGHT)
    q = solve(offset_leg(), feet)
    assert 0.066 * np.cos(q[:, 1]) + 0.133 * np.cos(q[:, 1] + q[:, 2]) == pytest.approx(reduced, abs=TIGHT)
    height = feet[:, 2] - DEC[2]
    assert 0.066 * np.sin(q[:, 1]) + 0.133 * np.sin(q[:, 1] + q[:, 2]) == pytest.approx(height, abs=TIGHT)


def test_001_yaw_of_an_offset_femur_axis() -> None:
    feet, made_from = random_feet(offset_leg(), 12)
    x, y = feet[:, 0], feet[:, 1]
    b = np.hypot(x, y)
    a = np.sqrt(b**2 - DEC[1] ** 2) - DEC[0]
    reduced = np.arctan2(y, x) - np.arctan2(DEC[1], DEC[0] + a)
    t1 = np.arcsin(a * math.sin(math.pi / 2 + math.atan(DEC[0] / DEC[1])) / b)
    assert np.arctan(y / x) + t1 - math.atan(DEC[1] / DEC[0]) == pytest.approx(reduced, abs=1e-9)
    assert solve(offset_leg(), feet)[:, 0] == pytest.approx(reduced, abs=TIGHT)
    assert made_from[:, 0] == pytest.approx(reduced, abs=TIGHT)


def test_001_knee_and_femur_angles() -> None:
    feet, _ = random_feet(offset_leg(), 13)
    px, pz = np.sqrt(feet[:, 0] ** 2 + feet[:, 1] ** 2 - DEC[1] ** 2) - DEC[0], feet[:, 2] - DEC[2]
    l1, l2, b = 0.133, 0.066, np.hypot(px, pz)
    t1 = np.arccos((l1**2 + l2**2 - b**2) / (2 * l1 * l2))
    t2 = np.arccos((b**2 + l2**2 - l1**2) / (2 * l2 * b)) + np.arctan(pz / px)
    q = solve(offset_leg(), feet)
    assert t1 == pytest.approx(math.pi + q[:, 2], abs=1e-9)
    assert t2 == pytest.approx(q[:, 1], abs=1e-9)


def test_001_body_frame_is_ours_turned_by_a_quarter() -> None:
    """There x is right and y front: `A` from the x axis is our mounting yaw plus 90 degrees."""
    robot, rng = load_robot("phantomx"), np.random.default_rng(14)
    feet = default_stance(robot) + rng.uniform(-0.02, 0.02, (50, 6, 3))
    to_theirs = Pose.from_rpy(yaw=math.pi / 2)
    point, attachment = to_theirs @ feet.reshape(-1, 3), to_theirs @ robot.mount_position
    point = point.reshape(50, 6, 3)
    a = robot.mount_yaw + math.pi / 2
    dx, dy = point[..., 0] - attachment[:, 0], point[..., 1] - attachment[:, 1]
    x, y = dx * np.cos(a) + dy * np.sin(a), dy * np.cos(a) - dx * np.sin(a)
    in_leg = coxa_frames(robot).inverse()
    for leg in range(6):
        ours = in_leg[leg] @ feet[:, leg]
        assert x[:, leg] == pytest.approx(ours[:, 0], abs=TIGHT)
        assert y[:, leg] == pytest.approx(ours[:, 1], abs=TIGHT)


def test_001_rest_foothold_in_the_middle_of_the_reachable_band() -> None:
    robot, body_height = load_robot("strider"), 0.11
    x_min, x_max = reachable_band(robot, -body_height)
    distance = np.linalg.norm(
        (default_stance(robot, body_height, swing_height=0) - robot.mount_position)[:, :2], axis=-1
    )
    assert distance == pytest.approx(x_min + (x_max - x_min) / 2, abs=TIGHT)
    for distance, reached in ((x_min + 1e-6, True), (x_max - 1e-6, True), (x_max + 1e-4, False)):
        feet = coxa_frames(robot) @ (distance[:, None] * [1, 0, 0] + np.array([0, 0, -body_height]))
        assert ((inverse_kinematics(robot, feet).reach == Reach.OK) == reached).all()


def stance_ends(motion: object, leg: int) -> tuple[np.ndarray, np.ndarray]:
    """Where a foot lands and lifts off in the body's heading frame, for the stance in the middle of a walk."""
    contacts = motion.contacts[:, leg]
    middle = len(contacts) // 2
    landings = np.flatnonzero(~contacts[:-1] & contacts[1:]) + 1
    start = int(landings[np.searchsorted(landings, middle)])
    end = start + int(np.argmin(contacts[start:])) - 1
    level = Pose.from_rpy(yaw=motion.body.rpy[:, 2], position=motion.body.position * (1, 1, 0))
    feet = level.inverse() @ motion.feet
    return feet[start, leg], feet[end, leg]


def test_001_straight_walk_is_a_stroke_centred_on_the_rest_foothold() -> None:
    """With a cycle of 2 s sampled at 100 Hz, the stances begin and end on samples."""
    robot, heading, stroke, body_height = point_feet("strider"), 0.7, 0.04, 0.11
    path = straight_path(0.4, heading)
    motion = plan_walk(robot, Gait.named("tripod"), path, stroke=stroke, body_height=body_height, cycle_time=2.0)
    rest = default_stance(robot, body_height, swing_height=motion.swing_height)
    # There `A` is counted from the front axis y, and x is to the right: the walk is along (-sin A, cos A).
    walk = np.array([math.cos(heading), math.sin(heading)])
    for leg in range(6):
        landing, lift_off = stance_ends(motion, leg)
        assert landing[:2] == pytest.approx(rest[leg, :2] + walk * stroke / 2, abs=1e-9)
        assert lift_off[:2] == pytest.approx(rest[leg, :2] - walk * stroke / 2, abs=1e-9)
        assert landing[2] == pytest.approx(0, abs=TIGHT)


def test_001_number_of_cycles_is_distance_over_stroke() -> None:
    """A cycle of a gait with duty factor `d` carries the body `P / d`: cruising, `d L / P` of our cycles."""
    robot, gait, stroke = point_feet("strider"), Gait.named("tripod"), 0.04
    times = [
        plan_walk(robot, gait, straight_path(distance), stroke=stroke, body_height=0.11, cycle_time=2.0).duration
        for distance in (0.8, 1.6)
    ]
    assert (times[1] - times[0]) / 2.0 == pytest.approx(gait.duty_factor * 0.8 / stroke, abs=0.02)


@pytest.mark.parametrize("centre", [(0.0, 0.4), (-0.1, -0.3), (0.0, 0.0)])
def test_001_curved_walk_turns_every_foot_by_the_same_angle(centre: tuple[float, float]) -> None:
    robot, stroke, body_height = point_feet("strider"), 0.04, 0.11
    path = curved_path(1.0, centre)
    motion = plan_walk(robot, Gait.named("tripod"), path, stroke=stroke, body_height=body_height, cycle_time=2.0)
    arm = default_stance(robot, body_height, swing_height=motion.swing_height)[:, :2] - centre
    cp = np.hypot(arm[:, 0], arm[:, 1])
    t = stroke / cp.max()
    at_rest = np.arctan2(arm[:, 1], arm[:, 0])
    for leg in range(6):
        for end, sign in zip(stance_ends(motion, leg), (1, -1), strict=True):
            angle = at_rest[leg] + sign * t / 2
            circle = cp[leg] * np.array([math.cos(angle), math.sin(angle)]) + centre
            assert end[:2] == pytest.approx(circle, abs=1e-9)


@pytest.mark.parametrize(("roll", "pitch"), [(0.15, 0.0), (0.0, -0.12), (0.1, 0.14)])
def test_001_tilt_puts_the_feet_on_one_tilted_plane(roll: float, pitch: float) -> None:
    """In B the ground rises with `tan(pitch)` to the front and falls with `tan(roll)` to the left."""
    robot, body_height = load_robot("strider"), 0.11
    motion = plan_walk(
        robot,
        Gait.named("tripod"),
        straight_path(0.2),
        stroke=0.02,
        body_height=body_height,
        body_tilt=(roll, pitch),
    )
    feet = (motion.body.inverse() @ motion.feet)[0]
    # `G` is measured along the body's own z axis; the plane of two turns one after the other has a cosine more.
    g = body_height / (math.cos(roll) * math.cos(pitch))
    plane = -g + feet[:, 0] * math.tan(pitch) / math.cos(roll) - feet[:, 1] * math.tan(roll)
    assert feet[:, 2] == pytest.approx(plane, abs=TIGHT)


def test_001_erratum_the_summary_swaps_b_and_c() -> None:
    feet, _ = random_feet(offset_leg(), 15)
    b, c = np.hypot(feet[:, 0], feet[:, 1]), math.hypot(*DEC[:2])
    right = np.sqrt(b**2 - DEC[1] ** 2) - DEC[0]
    with np.errstate(invalid="ignore"):
        swapped = px_a2_printed(np.asarray(c), b)
    assert right.min() > 0
    # Swapped, it is a negative reach, where it is a number at all.
    assert (np.isnan(swapped) | (swapped < 0)).all()
    assert np.nanmax(right - swapped) > 0.1


def test_001_erratum_the_leg_frame_is_mirrored() -> None:
    a = 0.6
    as_printed = np.array([[math.cos(a), math.sin(a)], [math.sin(a), -math.cos(a)]])
    assert np.linalg.det(as_printed) == pytest.approx(-1)
    frame = coxa_frames(one_leg(yaw=a)).inverse()
    assert np.linalg.det(frame.rotation) == pytest.approx(np.ones(1))
    assert frame.rotation[0, :2, :2] == pytest.approx(as_printed * [[1], [-1]], abs=TIGHT)
    foot = np.array([0.15, 0.12, -0.08])
    x, y = as_printed @ foot[:2]
    assert math.atan2(y, x) == pytest.approx(-solve(one_leg(yaw=a), foot[None])[0, 0])


def test_001_erratum_both_components_of_the_attachment_are_subtracted() -> None:
    """The printed distance is right on a circle, and 43 mm off at the corners of a body longer than wide."""
    point = np.array([0.2, 0.1, -0.1])
    off = {}
    for name in ("strider", "phantomx"):
        robot = load_robot(name)
        yaw, (x, y, _) = robot.mount_yaw, robot.mount_position.T
        printed_x = point[0] * np.cos(yaw) + point[1] * np.sin(yaw) - np.hypot(x, y)
        printed_y = point[1] * np.cos(yaw) - point[0] * np.sin(yaw)
        ours = coxa_frames(robot).inverse() @ np.broadcast_to(point, (6, 3))
        off[name] = np.hypot(printed_x - ours[:, 0], printed_y - ours[:, 1])
    assert off["strider"].max() < 1e-5
    corners = off["phantomx"][[0, 2, 3, 5]]
    assert corners.min() > 0.04
    assert off["phantomx"][[1, 4]].max() < 1e-9


def test_001_erratum_arctan_of_a_quotient_loses_the_quadrant() -> None:
    robot = one_leg(yaw=math.radians(150))
    foot = coxa_frames(robot) @ np.array([[0.15, 0.02, -0.08]])
    x, y = foot[0, :2]
    assert math.atan2(y, x) - math.atan(y / x) == pytest.approx(math.pi)
    behind = forward_kinematics(one_leg(), np.array([[2.5, 0.3, -1.2]]))[:, 3]
    assert solve(one_leg(), behind)[0] == pytest.approx([2.5, 0.3, -1.2])
    assert math.atan(behind[0, 1] / behind[0, 0]) == pytest.approx(2.5 - math.pi)


def test_001_erratum_a_step_is_the_stroke_not_the_distance() -> None:
    robot, distance, stroke = point_feet("strider"), 0.8, 0.04
    motion = plan_walk(
        robot, Gait.named("tripod"), straight_path(distance), stroke=stroke, body_height=0.11, cycle_time=2.0
    )
    landing, lift_off = stance_ends(motion, 0)
    assert np.linalg.norm(landing - lift_off) == pytest.approx(stroke, abs=1e-9)
    x_min, x_max = reachable_band(robot, -0.11)
    assert distance > 2 * (x_max - x_min).max()


def test_001_erratum_the_tilted_plane_has_the_tangent_as_its_slope() -> None:
    """Printed, a level body divides by zero, and at 5 degrees the plane is a metre off: it stands nearly upright."""
    robot, body_height, pitch = load_robot("strider"), 0.11, math.radians(5)
    rest = default_stance(robot, body_height)
    body = Pose.from_rpy(pitch=pitch, position=(0, 0, body_height))
    on_ground = rest * (1, 1, 0)
    feet = body.inverse() @ on_ground
    right = -body_height / math.cos(pitch) + feet[:, 0] * math.tan(pitch)
    assert feet[:, 2] == pytest.approx(right, abs=TIGHT)
    front = np.abs(feet[:, 0]) > 0.1
    assert np.abs(feet[front, 0] / math.tan(pitch) - feet[front, 0] * math.tan(pitch)).min() > 1
    assert inverse_kinematics(robot, rest).ok
    assert inverse_kinematics(robot, on_ground, body).ok


def test_001_erratum_the_two_slopes_have_their_own_signs() -> None:
    """The plane's equation with the printed normal and `E_z` contradict each other; the right-hand rule decides."""
    body_height, tilt = 0.11, 0.1
    ahead, left = np.array([0.2, 0.0, 0.0]), np.array([0.0, 0.2, 0.0])
    rolled = Pose.from_rpy(roll=tilt, position=(0, 0, body_height)).inverse()
    pitched = Pose.from_rpy(pitch=tilt, position=(0, 0, body_height)).inverse()
    # Rolled to the right the left side rises, so the ground is lower there; pitched nose down, the front sinks.
    assert (rolled @ left)[2] + body_height / math.cos(tilt) == pytest.approx(-(rolled @ left)[1] * math.tan(tilt))
    assert (pitched @ ahead)[2] + body_height / math.cos(tilt) == pytest.approx((pitched @ ahead)[0] * math.tan(tilt))


def test_001_erratum_the_depth_of_the_feet_is_not_the_clearance() -> None:
    robot, body_height = load_robot("strider"), 0.11
    feet = default_stance(robot, body_height)
    assert feet[:, 2] == pytest.approx(-body_height, abs=TIGHT)
    body = Pose(position=np.array([0.0, 0.0, body_height]))
    underside = (body @ np.array([0.0, 0.0, -robot.body_size[2] / 2]))[2]
    assert underside == pytest.approx(0.085, abs=TIGHT)


def test_001_erratum_only_the_last_line_of_the_knee_derivation_is_right() -> None:
    l1, l2, interior = 0.133, 0.066, 1.9
    big = math.sqrt(l1**2 + l2**2 - 2 * l1 * l2 * math.cos(interior))
    a = (big**2 + l2**2 - l1**2) / (2 * big)
    b = big - a
    c2 = l2**2 - a**2
    wrong = [
        math.cos(math.asin(a / l2) - math.asin(b / l1)),
        math.cos(math.asin(a / l2) * math.asin(b / l1)) + a * b / (l1 * l2),
        math.sqrt(c2 / l2**2) * math.sqrt(c2 / l1**2) + a * b / (l1 * l2),
        math.sqrt(c2) / l2**2 * a * b / (l1 * l2) + a * b / (l1 * l2),
        (c2 + a * b) / (l1 * l2),
        (l2**2 - (a**2 - a * b)) / l2**2,
        -(l2**2 + a * big) / (l1 * l2),
        (big**2 + l2**2 - l1**2) / (2 * l1 * l2),
    ]
    assert min(abs(value - math.cos(interior)) for value in wrong) > 0.05
    last = (l2**2 + l1**2 - big**2) / (2 * l1 * l2)
    assert last == pytest.approx(math.cos(interior), abs=TIGHT)
    # The sum of the two arcs, with its sine product subtracted, leads there.
    assert math.asin(a / l2) + math.asin(b / l1) == pytest.approx(interior, abs=TIGHT)
    assert (c2 - a * b) / (l1 * l2) == pytest.approx(math.cos(interior), abs=TIGHT)


# 002: forward and inverse kinematics of Hexy's leg


def test_002_forward_equations() -> None:
    """There y is up and, for a right-handed frame, z to the right: `Oc = -coxa`, `Ot = -tibia`."""
    c, f, t = 0.026, 0.049, 0.052
    q = random_angles(21)
    oc, of, ot = -q[:, 0, 0], q[:, 0, 1], -q[:, 0, 2]
    r = c + f * np.cos(of) + t * np.cos(of - ot)
    y = f * np.sin(of) + t * np.sin(of - ot)
    foot = forward_kinematics(one_leg(c, f, t), q)[:, 0, 3]
    assert np.stack([r * np.cos(oc), -r * np.sin(oc), y], axis=-1) == pytest.approx(foot, abs=TIGHT)


def test_002_both_knee_solutions_put_the_foot_there() -> None:
    robot = one_leg(0.026, 0.049, 0.052)
    feet, made_from = random_feet(robot, 22)
    up, down = solve(robot, feet, knee="up"), solve(robot, feet, knee="down")
    assert up == pytest.approx(made_from, abs=1e-9)
    assert (up[:, 2] < 0).all()
    assert (down[:, 2] > 0).all()
    for q in (up, down):
        assert forward_kinematics(robot, q[:, None])[:, 0, 3] == pytest.approx(feet, abs=TIGHT)
    knee_up, knee_down = (forward_kinematics(robot, q[:, None])[:, 0, 2, 2] for q in (up, down))
    assert (knee_up > knee_down).all()


def inverse_002(feet: np.ndarray, l2: np.ndarray, c: float, f: float, t: float) -> tuple[np.ndarray, np.ndarray]:
    """`Of` and `Ot` as derived there, with L squared given; y is the depth of the foot below the femur axis."""
    d, y = np.hypot(feet[:, 0], feet[:, 1]) - c, -feet[:, 2]
    beta = np.arctan2(d, y)
    alpha = np.arccos(np.clip((f * f + l2 - t * t) / (2 * f * np.sqrt(l2)), -1, 1))
    gamma = np.arccos(np.clip((f * f + t * t - l2) / (2 * f * t), -1, 1))
    return math.pi / 2 - alpha - beta, math.pi - gamma


def test_002_tibia_angle_is_the_supplement_of_the_knee() -> None:
    c, f, t = 0.026, 0.049, 0.052
    feet, _ = random_feet(one_leg(c, f, t), 23)
    l2 = (np.hypot(feet[:, 0], feet[:, 1]) - c) ** 2 + feet[:, 2] ** 2
    assert inverse_002(feet, l2, c, f, t)[1] == pytest.approx(-solve(one_leg(c, f, t), feet)[:, 2], abs=1e-9)


def test_002_erratum_the_hypotenuse_is_of_d_and_y() -> None:
    c, f, t = 0.026, 0.049, 0.052
    feet, _ = random_feet(one_leg(c, f, t), 24)
    r = np.hypot(feet[:, 0], feet[:, 1])
    as_printed, right = r**2 + (r - c) ** 2, (r - c) ** 2 + feet[:, 2] ** 2
    q = solve(one_leg(c, f, t), feet)
    assert right == pytest.approx(f * f + t * t + 2 * f * t * np.cos(q[:, 2]), abs=TIGHT)
    assert np.abs(inverse_002(feet, as_printed, c, f, t)[1] + q[:, 2]).max() > math.radians(60)


def test_002_erratum_the_law_of_cosines_subtracts() -> None:
    """With `=` for `-` the line asks for `f^2 + L^2 = 2 f L cos(alpha)`: a cosine of at least 1, whatever the foot."""
    c, f, t = 0.026, 0.049, 0.052
    feet, _ = random_feet(one_leg(c, f, t), 25)
    d = np.hypot(feet[:, 0], feet[:, 1]) - c
    length = np.hypot(d, feet[:, 2])
    assert ((f * f + length**2) / (2 * f * length)).min() >= 1
    alpha = np.arccos((f * f + length**2 - t * t) / (2 * f * length))
    assert alpha + np.arctan2(feet[:, 2], d) == pytest.approx(solve(one_leg(c, f, t), feet)[:, 1], abs=1e-9)


def test_002_erratum_the_femur_angle_has_the_opposite_sign() -> None:
    c, f, t = 0.026, 0.049, 0.052
    feet, made_from = random_feet(one_leg(c, f, t), 26)
    l2 = (np.hypot(feet[:, 0], feet[:, 1]) - c) ** 2 + feet[:, 2] ** 2
    as_printed, _ = inverse_002(feet, l2, c, f, t)
    q = solve(one_leg(c, f, t), feet)
    assert -as_printed == pytest.approx(q[:, 1], abs=1e-9)
    raised = np.abs(made_from[:, 1]) > 0.2
    assert np.abs(as_printed - q[:, 1])[raised].min() > 0.4


# 003: leg and body inverse kinematics


def inverse_003(feet: np.ndarray, coxa: float, femur: float, tibia: float, y: np.ndarray) -> np.ndarray:
    """C.Angle, F.Angle and T.Angle ``(n, 3)`` [rad] for the depth Y given."""
    length = np.hypot(feet[:, 0], feet[:, 1])
    hf = np.hypot(length - coxa, y)
    a1 = np.arctan((length - coxa) / y)
    a2 = np.arccos((tibia**2 - femur**2 - hf**2) / (-2 * femur * hf))
    b1 = np.arccos((hf**2 - tibia**2 - femur**2) / (-2 * femur * tibia))
    right_angle = math.pi / 2
    return np.stack([np.arctan2(feet[:, 1], feet[:, 0]), right_angle - (a1 + a2), right_angle - b1], axis=-1)


def below_the_axis(seed: int) -> np.ndarray:
    feet, _ = random_feet(one_leg(), seed)
    return feet[feet[:, 2] < -0.02]


def test_003_leg_angles() -> None:
    """F.Angle is ours with the other sign, T.Angle `-90 deg - tibia`, where Y is measured downwards."""
    feet = below_the_axis(31)
    theirs = inverse_003(feet, 0.052, 0.066, 0.133, -feet[:, 2])
    ours = solve(one_leg(), feet)
    assert theirs[:, 0] == pytest.approx(ours[:, 0], abs=TIGHT)
    assert theirs[:, 1] == pytest.approx(-ours[:, 1], abs=1e-9)
    assert theirs[:, 2] == pytest.approx(-math.pi / 2 - ours[:, 2], abs=1e-9)


def test_003_turning_about_the_vertical() -> None:
    """`x1 = R cos(alpha + beta), y1 = R sin(alpha + beta)` is our yaw."""
    point, beta = np.array([0.17, -0.08, -0.1]), 0.35
    alpha, r = math.atan2(point[1], point[0]), math.hypot(point[0], point[1])
    turned = Pose.from_rpy(yaw=beta) @ point
    assert turned == pytest.approx([r * math.cos(alpha + beta), r * math.sin(alpha + beta), point[2]])


def test_003_body_inverse_kinematics_keeps_the_feet_still() -> None:
    robot, rng = load_robot("strider"), np.random.default_rng(32)
    on_ground = default_stance(robot, 0.11) * (1, 1, 0)
    roll, pitch, yaw = rng.uniform(-0.1, 0.1, (3, 200))
    body = Pose.from_rpy(roll, pitch, yaw, rng.uniform((-0.02, -0.02, 0.09), (0.02, 0.02, 0.13), (200, 3)))
    solution = inverse_kinematics(robot, on_ground, body).require()
    feet = body @ forward_kinematics(robot, solution.angles)[..., 3, :]
    assert feet == pytest.approx(np.broadcast_to(on_ground, feet.shape), abs=TIGHT)
    assert np.ptp(solution.angles, axis=0).min() > 0.01


def test_003_moving_the_body_moves_the_feet_against_it() -> None:
    robot, shift = load_robot("strider"), np.array([0.01, -0.02, 0.005])
    feet = default_stance(robot, 0.11)
    up = np.array([0, 0, 0.2])
    moved = inverse_kinematics(robot, feet + up, Pose(position=shift + up))
    level = inverse_kinematics(robot, feet - shift)
    assert moved.angles == pytest.approx(level.angles, abs=TIGHT)


def rotation_003(theta: float, alpha: float, beta: float) -> np.ndarray:
    """The printed product, entry by entry, for vectors (x, z, y)."""
    (ct, ca, cb), (st, sa, sb) = ([f(v) for v in (theta, alpha, beta)] for f in (math.cos, math.sin))
    return np.array(
        [
            [ca * cb, -ca * sb, sa],
            [st * sa * cb + ct * sb, st * sa * sb + ct * cb, -st * ca],
            [-ct * sa * cb + st * sb, ct * sa * sb + st * cb, ct * ca],
        ]
    )


def test_003_rotation_is_the_product_about_its_three_axes() -> None:
    """Its axes (x, z, y), y up, are our (x, y, z): `R_x R_z R_y` is roll times pitch times yaw, the yaw first."""
    theta, alpha, beta = 0.3, -0.2, 0.5
    ours = Pose.from_rpy(roll=theta) @ Pose.from_rpy(pitch=alpha) @ Pose.from_rpy(yaw=beta)
    as_printed = rotation_003(theta, alpha, beta)
    same = np.ones((3, 3), dtype=bool)
    same[1, 1] = False
    assert as_printed[same] == pytest.approx(ours.rotation[same], abs=TIGHT)


def test_003_erratum_a_sign_in_the_rotation() -> None:
    """The middle entry has `+ sin sin sin` for `-`: the printed matrix is no rotation."""
    theta, alpha, beta = 0.3, -0.2, 0.5
    as_printed = rotation_003(theta, alpha, beta)
    excess = 2 * math.sin(theta) * math.sin(alpha) * math.sin(beta)
    ours = Pose.from_rpy(roll=theta) @ Pose.from_rpy(pitch=alpha) @ Pose.from_rpy(yaw=beta)
    assert as_printed[1, 1] - ours.rotation[1, 1] == pytest.approx(excess, abs=TIGHT)
    assert abs(np.linalg.det(as_printed) - 1) > 0.02
    assert np.linalg.det(ours.rotation) == pytest.approx(1)


def test_003_a_mounting_angle_turns_the_target_into_the_legs_frame() -> None:
    theta = math.radians(-30)
    robot = one_leg(yaw=theta)
    foot = np.array([0.16, 0.05, -0.09])
    turned = (
        math.cos(theta) * foot[0] + math.sin(theta) * foot[1],
        -math.sin(theta) * foot[0] + math.cos(theta) * foot[1],
        foot[2],
    )
    assert (coxa_frames(robot).inverse() @ foot[None])[0] == pytest.approx(turned, abs=TIGHT)
    q = solve(robot, foot[None])
    assert q == pytest.approx(solve(one_leg(), np.array([turned])), abs=TIGHT)


def test_003_erratum_the_frame_change_labels_its_rows_in_another_order() -> None:
    """The matrix times (x, z, y) would mix the height into x: 45 mm here; it is meant for (x, y, z), y up."""
    theta, x, y_up, z = math.radians(-30), 0.16, -0.09, 0.05
    matrix = np.array(
        [[math.cos(theta), 0, math.sin(theta)], [0, 1, 0], [-math.sin(theta), 0, math.cos(theta)]],
    )
    result = [math.cos(theta) * x + math.sin(theta) * z, y_up, -math.sin(theta) * x + math.cos(theta) * z]
    assert matrix @ [x, y_up, z] == pytest.approx(result)
    as_printed = matrix @ [x, z, y_up]
    assert as_printed[0] - result[0] == pytest.approx(math.sin(theta) * (y_up - z))
    assert abs(as_printed[0] - result[0]) > 0.06
    ours = (coxa_frames(one_leg(yaw=theta)).inverse() @ np.array([[x, z, y_up]]))[0]
    assert ours == pytest.approx([result[0], result[2], result[1]], abs=TIGHT)


def test_003_no_solution_where_an_attachment_is_below_the_ground() -> None:
    robot = load_robot("strider")
    on_ground = default_stance(robot, 0.11) * (1, 1, 0)
    sunk = inverse_kinematics(robot, on_ground, Pose.from_rpy(roll=0.3, position=(0, 0, 0.01)))
    below = np.flatnonzero(sunk.reach == Reach.BELOW_GROUND)
    assert [robot.leg_names[leg] for leg in below] == ["rear right", "middle right", "front right"]
    assert "below the ground" in sunk.explain()


def test_003_no_solution_where_a_joint_is_out_of_its_range() -> None:
    robot = load_robot("strider")
    over = forward_kinematics(
        robot.replace(limits=np.clip(robot.limits * 4, -math.pi, math.pi)), np.tile([1.2, 0.5, -1.5], (6, 1))
    )[:, 3]
    solution = inverse_kinematics(robot, over)
    assert (solution.reach == Reach.COXA_LIMIT).all()
    assert "upper limit of 60.0 deg" in solution.explain()


def test_003_no_solution_where_too_few_legs_reach_the_ground() -> None:
    """The document's rule: four legs or more in the air, or all the legs of one side."""
    robot = load_robot("strider")
    angles = inverse_kinematics(robot, default_stance(robot, 0.11)).require().angles
    for down in ([2, 5], [0, 1, 2], [3, 4, 5]):
        contacts = np.isin(np.arange(6), down)
        # The centre of mass is on the line between two opposite feet, up to the rounding of the machine.
        assert stability_margin(robot, angles, Pose(), contacts) < 1e-9


def test_003_erratum_the_support_polygon_decides_whether_it_stands() -> None:
    """Three feet at the front satisfy the printed rule, and the robot falls backwards."""
    robot = load_robot("strider")
    angles = inverse_kinematics(robot, default_stance(robot, 0.11)).require().angles
    front = np.isin(np.arange(6), [0, 5, 4])
    in_air = np.flatnonzero(~front)
    assert len(in_air) < 4
    assert not {0, 1, 2} <= set(in_air)
    assert not {3, 4, 5} <= set(in_air)
    assert stability_margin(robot, angles, Pose(), front) < -0.01
    tripod = np.isin(np.arange(6), [0, 2, 4])
    assert stability_margin(robot, angles, Pose(), tripod) > 0.05


def test_003_erratum_the_femur_angle_wants_a_depth() -> None:
    feet = below_the_axis(33)
    ours = -solve(one_leg(), feet)[:, 1]
    as_depth = inverse_003(feet, 0.052, 0.066, 0.133, -feet[:, 2])[:, 1]
    as_height = inverse_003(feet, 0.052, 0.066, 0.133, feet[:, 2])[:, 1]
    assert as_depth == pytest.approx(ours, abs=1e-9)
    assert np.abs(as_height - ours).max() > math.radians(90)


# 004: torques


def weight(part: str) -> float:
    return S004[part] * S004["g"]


def test_004_weights() -> None:
    assert weight("body") == printed(13.5828)
    assert weight("coxa") == printed(0.392)
    assert weight("femur") == printed(1.568)
    assert weight("tibia") == printed(0.784)


def test_004_tibia_swing_torque() -> None:
    assert weight("tibia") * S004["com_tibia"] == printed(0.06115)


def femur_swing(arm: float) -> float:
    return weight("femur") * arm + weight("tibia") * (S004["L_femur"] + S004["com_tibia"])


def test_004_erratum_femur_swing_torque_takes_the_coxas_arm() -> None:
    assert femur_swing(S004["com_femur"]) == printed(0.2148)
    assert femur_swing(S004["com_coxa"]) == printed(0.1913)


def inertia(part: str, mass: float, distance: float) -> float:
    """A rod's moment of inertia about a vertical axis at a distance from its middle."""
    return S004["rod about its middle"] * S004[part] * S004[f"L_{part}"] ** 2 + mass * distance**2


def coxa_inertia() -> float:
    return S004["rod about its end"] * S004["coxa"] * S004["L_coxa"] ** 2


def leg_inertia() -> float:
    femur_at = S004["L_coxa"] + S004["com_femur"]
    tibia_at = S004["L_coxa"] + S004["L_femur"] + S004["com_tibia"]
    return coxa_inertia() + inertia("femur", S004["femur"], femur_at) + inertia("tibia", S004["tibia"], tibia_at)


def test_004_peak_acceleration() -> None:
    assert 4 * S004["swing"] / S004["time"] ** 2 == printed(1.0472)
    assert math.radians(60) == printed(1.0472)


def test_004_tibia_inertia_about_the_coxa() -> None:
    assert inertia("tibia", S004["tibia"], 0.0) == printed(0.000218)
    assert inertia("tibia", S004["tibia"], 0.244) == printed(0.00498)


def test_004_erratum_coxa_inertia() -> None:
    assert coxa_inertia() == printed(0.000061)
    assert coxa_inertia() != printed(0.0001233)
    assert 0.0001233 / coxa_inertia() == pytest.approx(2.02, abs=0.01)


def test_004_erratum_femur_inertia_takes_a_tenth_of_the_mass() -> None:
    distance = S004["L_coxa"] + S004["com_femur"]
    assert inertia("femur", S004["femur"], 0.0) == printed(0.000128)
    assert inertia("femur", S004["femur"], distance) == printed(0.002318)
    assert inertia("femur", 0.016, distance) == printed(0.000347)


def test_004_erratum_total_inertia_follows() -> None:
    as_printed = 0.0001233 + 0.000347 + 0.00498
    assert as_printed == printed(0.0054503)
    assert leg_inertia() == printed(0.00736)
    assert leg_inertia() * S004["swing"] == pytest.approx(0.00771, abs=1e-5)
    assert 0.0054503 * S004["swing"] == printed(0.0057)


def test_004_erratum_gravity_has_no_moment_about_a_vertical_axis() -> None:
    """0.388 N m is what the joint's bearings bear, or the torque of a robot on its side."""
    bending = (
        weight("coxa") * S004["com_coxa"]
        + weight("femur") * (S004["L_coxa"] + S004["com_femur"])
        + weight("tibia") * (S004["L_coxa"] + S004["L_femur"] + S004["com_tibia"])
    )
    assert bending == printed(0.38808)
    robot = load_robot("strider")
    straight, all_feet = np.zeros((6, 3)), np.ones(6, dtype=bool)
    gravity, no_forces = (0.0, 0.0, -S004["g"]), np.zeros((6, 3))
    for roll, middle_leg in ((0.0, 0.0), (math.pi / 2, bending)):
        # Rolled onto its side by a quarter, a middle leg points up or down; yawed as well, it points across.
        body = Pose.from_rpy(roll=roll) @ Pose.from_rpy(yaw=math.pi / 2)
        torques, _ = joint_torques(robot, straight, body, all_feet, gravity=gravity, forces=no_forces)
        assert np.abs(torques[1, 0]) == pytest.approx(middle_leg, abs=TIGHT)


def test_004_erratum_coxa_mass_in_the_sums() -> None:
    """0.05 kg is written, and 0.04 kg gives the printed sums."""
    body, femur, tibia = S004["body"], S004["femur"], S004["tibia"]
    assert body + 3 * (S004["coxa"] + femur + tibia) == printed(2.226)
    assert body + S004["coxa"] + femur + tibia == printed(1.666)
    assert body + 3 * (S004["coxa as written in the sums"] + femur + tibia) == pytest.approx(2.256)
    assert body + S004["coxa as written in the sums"] + femur + tibia == pytest.approx(1.676)


CARRIED = {"tripod": (2.226, 3, 7.2716), "ripple": (1.666, 5, 3.26536)}
"""Mass [kg] that so many feet carry, and each one's load [N]; "ripple" is the document's word for the wave gait."""


def stance_004(load: float) -> tuple[float, float]:
    """Femur and tibia torque of the hand method: the body's weight on a cantilever."""
    femur_length, coxa_length, r_b = S004["stance L_femur"], S004["L_coxa"], S004["R_b"]
    femur = weight("coxa") * S004["com_coxa"] + load * (coxa_length + r_b)
    tibia = (
        weight("femur") * S004["stance com_femur"]
        + weight("coxa") * (femur_length + S004["com_coxa"])
        + load * (femur_length + coxa_length + r_b)
    )
    return femur, tibia


@pytest.mark.parametrize("gait", CARRIED)
def test_004_load_of_each_foot(gait: str) -> None:
    mass, feet, load = CARRIED[gait]
    assert mass * S004["g"] / feet == printed(load)


@pytest.mark.parametrize(("gait", "femur", "tibia"), [("tripod", 1.13315, 1.716), ("ripple", 0.5162, 0.8226)])
def test_004_stance_torques(gait: str, femur: float, tibia: float) -> None:
    assert stance_004(CARRIED[gait][2]) == (printed(femur), printed(tibia))


def cube(mass: float, size: float) -> float:
    """Moment of inertia of the robot as a cube, `size` for the square that the formula has."""
    return S004["cube"] * mass * size + mass * S004["R_b"] ** 2


@pytest.mark.parametrize(("gait", "as_printed", "right"), [("ripple", 0.0362, 0.01437), ("tripod", 0.04835, 0.01921)])
def test_004_erratum_the_cubes_inertia_takes_a_length_unsquared(gait: str, as_printed: float, right: float) -> None:
    mass = CARRIED[gait][0]
    assert cube(mass, S004["R_b"] ** 2) == printed(right)
    assert cube(mass, S004["R_b"]) == printed(as_printed)


def test_004_tripod_walking_torque() -> None:
    """Given its inertia."""
    mass = CARRIED["tripod"][0]
    from_inertia, from_acceleration = 0.04835 * S004["swing"], mass * S004["a"] * S004["R_b"]
    assert from_inertia == printed(0.0506)
    assert from_acceleration == printed(0.191436)
    assert from_acceleration + from_inertia == printed(0.2420)
    assert S004["safety"] * 0.2420 == printed(0.7260)
    corrected = from_acceleration + cube(mass, S004["R_b"] ** 2) * S004["swing"]
    assert S004["safety"] * corrected == pytest.approx(0.6347, abs=1e-4)


def test_004_erratum_ripple_walking_adds_an_inertia_to_a_torque() -> None:
    mass = CARRIED["ripple"][0]
    from_acceleration = mass * S004["a"] * S004["R_b"]
    assert from_acceleration == printed(0.143276)
    assert 0.0362 * S004["swing"] == printed(0.0379)
    assert from_acceleration + 0.0362 == printed(0.1794)
    assert S004["safety"] * 0.1794 == printed(0.5382)
    assert from_acceleration + 0.0379 == pytest.approx(0.1812, abs=1e-4)
    corrected = from_acceleration + cube(mass, S004["R_b"] ** 2) * S004["swing"]
    assert S004["safety"] * corrected == pytest.approx(0.4750, abs=1e-4)


@pytest.mark.parametrize(("gait", "walking"), [("tripod", 0.7260), ("ripple", 0.5382)])
def test_004_the_hand_method_as_printed_and_corrected(gait: str, walking: float) -> None:
    """`handbook` on strider: the sums of this file where the rows are corrected, the document's numbers where not."""
    mass, feet_down, load = CARRIED[gait]
    r_b, swing = S004["R_b"], S004["swing"]
    from_acceleration, torque = mass * S004["a"] * r_b, cube(mass, r_b**2) * swing
    right, as_printed = (
        {line.key: line.value for line in handbook(load_robot("strider"), feet_down=feet_down, corrected=c).lines}
        for c in (True, False)
    )
    femur, tibia = stance_004(load)
    for key, corrected, document in (
        ("swing.femur", femur_swing(S004["com_femur"]), 0.1913),
        ("swing.tibia", weight("tibia") * S004["com_tibia"], 0.06115),
        ("inertia.coxa", coxa_inertia(), 0.0001233),
        ("inertia.femur_at_coxa", inertia("femur", S004["femur"], 0.117), 0.000347),
        ("inertia.leg", leg_inertia(), 0.0054503),
        ("swing.gravity", 0.0, 0.38808),
        ("stance.mass", mass, mass),
        ("stance.load", load, load),
        ("stance.femur", femur, {"tripod": 1.13315, "ripple": 0.5162}[gait]),
        ("stance.tibia", tibia, {"tripod": 1.716, "ripple": 0.8226}[gait]),
        ("walk.inertia", cube(mass, r_b**2), {"tripod": 0.04835, "ripple": 0.0362}[gait]),
        ("walk.coxa_with_factor", S004["safety"] * (from_acceleration + torque), walking),
    ):
        assert right[key] == pytest.approx(corrected, rel=1e-5), key
        assert as_printed[key] == printed(document), key


def test_004_loose_stance_model_is_not_the_static_torque() -> None:
    """By contact force, weights and Jacobian, the foot 185 mm out: 1.04 and 0.43 N m for the printed 1.13 and 1.72."""
    robot, gravity = load_robot("strider"), 9.80665
    foot = np.array([0.185, 0.0, -0.11])
    solution = inverse_kinematics(robot, coxa_frames(robot) @ np.tile(foot, (6, 1))).require()
    jacobian, points = leg_jacobian(robot, solution.angles)[1], forward_kinematics(robot, solution.angles)[1]
    load = gravity * (S004["body"] + 6 * (S004["coxa"] + S004["femur"] + S004["tibia"])) / 3
    torque = -jacobian.T @ [0, 0, load]
    axis, knee, tip = points[1:]
    femur_com = axis + (knee - axis) * S004["com_femur"] / S004["L_femur"]
    tibia_com = knee + (tip - knee) * S004["com_tibia"] / S004["L_tibia"]
    # About the horizontal femur and tibia axes a weight's arm is how far out it is.
    outward = np.array([0.0, 1.0, 0.0])
    torque[2] += gravity * S004["tibia"] * outward @ (tibia_com - knee)
    torque[1] += gravity * S004["tibia"] * outward @ (tibia_com - axis)
    torque[1] += gravity * S004["femur"] * outward @ (femur_com - axis)
    assert torque == pytest.approx([0.0, -1.0434, -0.4274], abs=1e-4)
    tripod = np.isin(np.arange(6), [0, 2, 4])
    held, forces = joint_torques(robot, solution.angles, Pose(position=(0, 0, 0.11)), tripod)
    assert forces[tripod, 2] == pytest.approx(np.full(3, load))
    assert held[0] == pytest.approx(torque, abs=TIGHT)
    femur, tibia = stance_004(CARRIED["tripod"][2])
    assert femur / abs(torque[1]) == pytest.approx(1.086, abs=0.001)
    assert tibia / abs(torque[2]) == pytest.approx(4.015, abs=0.005)


# 004: inverse kinematics


def leg_ik_004(feet: np.ndarray, mounting: float) -> np.ndarray:
    """The reference implementation, as printed ``(n, 3)``: millimetres in, radians out."""
    r_b, l1, l2, l3 = 86, 68, 98, 181
    v = feet - [r_b * math.cos(mounting), r_b * math.sin(mounting), 0]
    reach = np.hypot(v[:, 0], v[:, 1]) - l1
    d = np.hypot(reach, v[:, 2])
    beta = np.arccos(np.clip((l2**2 + l3**2 - d**2) / (2 * l2 * l3), -1, 1))
    alpha = np.arccos(np.clip((l2**2 + d**2 - l3**2) / (2 * l2 * d), -1, 1))
    return np.stack(
        [np.arctan2(v[:, 1], v[:, 0]), np.arctan2(v[:, 2], reach) + alpha, math.pi - beta],
        axis=-1,
    )


def strider_feet(seed: int) -> tuple[Robot, np.ndarray, np.ndarray]:
    """Strider with its mounts where the document's formula puts them, random feet in B and our angles."""
    robot = load_robot("strider")
    yaw, zero = robot.mount_yaw, np.zeros(6)
    robot = robot.replace(mount_position=np.stack([0.086 * np.cos(yaw), 0.086 * np.sin(yaw), zero], axis=-1))
    rng = np.random.default_rng(seed)
    feet = default_stance(robot, 0.11) + rng.uniform(-0.03, 0.03, (100, 6, 3))
    return robot, feet, inverse_kinematics(robot, feet).require().angles


def test_004_coxa_axes_on_a_circle() -> None:
    robot = load_robot("strider")
    frames, yaw = coxa_frames(robot), robot.mount_yaw
    on_circle = np.stack([S004["R_b"] * np.cos(yaw), S004["R_b"] * np.sin(yaw), np.zeros(6)], axis=-1)
    assert frames.position == pytest.approx(on_circle, abs=1e-6)


def test_004_femur_and_tibia_angles() -> None:
    """Their knee is positive when bent; ours lifts the foot: `q3 = -tibia`."""
    robot, feet, angles = strider_feet(41)
    for leg in range(6):
        theirs = leg_ik_004(feet[:, leg] * 1000, float(robot.mount_yaw[leg]))
        assert theirs[:, 1] == pytest.approx(angles[:, leg, 1], abs=1e-9)
        assert theirs[:, 2] == pytest.approx(-angles[:, leg, 2], abs=1e-9)


def test_004_erratum_q1_is_less_the_mounting_angle() -> None:
    robot, feet, angles = strider_feet(42)
    for leg in range(6):
        mounting = float(robot.mount_yaw[leg])
        q1 = leg_ik_004(feet[:, leg] * 1000, mounting)[:, 0]
        off = np.angle(np.exp(1j * (q1 - angles[:, leg, 0])))
        assert np.cos(off - mounting) == pytest.approx(np.ones(len(off)), abs=TIGHT)
        assert np.abs(off).min() > math.radians(29)


def test_004_erratum_the_straight_leg_has_q3_zero() -> None:
    leg = one_leg(0.068, 0.098, 0.181)
    feet = np.stack([np.linspace(0.3, 0.347 - 1e-9, 50), np.zeros(50), np.zeros(50)], axis=-1)
    ours, theirs = solve(leg, feet), leg_ik_004((feet + R_B) * 1000, 0.0)
    assert theirs[:, 2] == pytest.approx(-ours[:, 2], abs=1e-6)
    assert abs(theirs[-1, 2]) < 1e-3
    assert (np.diff(theirs[:, 2]) < 0).all()
    assert (np.diff(theirs[:, 1]) < 0).all()


def test_004_erratum_the_femur_of_a_standing_leg_points_up() -> None:
    robot, depth = load_robot("strider"), 0.11
    middle = sum(reachable_band(robot, -depth)) / 2
    stance = coxa_frames(robot) @ np.stack([middle, 0 * middle, 0 * middle - depth], axis=-1)
    standing = np.degrees(inverse_kinematics(robot, stance).require().angles)
    assert standing[:, 1] == pytest.approx(45, abs=1)
    assert (-standing[:, 2] > 90).all()  # flexed, as the document says
    reach = np.arange(0.0, 0.256, 0.001)
    feet = coxa_frames(robot)[0] @ np.stack([reach + 0.068, 0 * reach, 0 * reach - depth], axis=-1)
    alone = feet[:, None] + np.zeros((6, 1))
    femur = inverse_kinematics(robot, alone).angles[:, 0, 1]
    stretched = np.hypot(reach, depth) / (0.098 + 0.181)
    assert (femur[stretched < 0.95] > 0).all()
    assert (femur[stretched > 0.96] < 0).all()


def test_004_erratum_a_foot_under_the_femur_axis_is_reachable() -> None:
    """Nearer to the coxa axis than the coxa is long, and reached within strider's limits."""
    robot = load_robot("strider")
    feet = coxa_frames(robot) @ np.tile([0.05, 0.0, -0.13], (6, 1))
    solution = inverse_kinematics(robot, feet).require()
    assert forward_kinematics(robot, solution.angles)[:, 3] == pytest.approx(feet, abs=TIGHT)


@pytest.mark.parametrize(
    ("distance", "reach"),
    [(0.0831, Reach.OK), (0.0829, Reach.TOO_NEAR), (0.2789, Reach.OK), (0.2791, Reach.TOO_FAR)],
)
def test_004_the_triangle_decides_what_is_in_reach(distance: float, reach: Reach) -> None:
    """`|L2 - L3| <= D <= L2 + L3`: 83 to 279 mm from the femur axis."""
    foot = np.array([[0.068 + distance * math.cos(0.4), 0.0, -distance * math.sin(0.4)]])
    assert inverse_kinematics(one_leg(0.068, 0.098, 0.181), foot).reach[0] == reach


def test_004_greatest_horizontal_reach() -> None:
    straight = forward_kinematics(one_leg(0.068, 0.098, 0.181), np.zeros((1, 3)))[0, 3]
    assert straight * 1000 == pytest.approx([347, 0, 0])


def test_004_joint_limits_are_checked() -> None:
    robot = load_robot("strider")
    wide = robot.replace(limits=np.tile([-math.pi, math.pi], (6, 3, 1)))
    feet = forward_kinematics(wide, np.tile([0.0, 1.9, -1.0], (6, 1)))[:, 3]
    assert inverse_kinematics(wide, feet).ok
    assert (inverse_kinematics(robot, feet).reach == Reach.FEMUR_LIMIT).all()


def test_004_body_attitude_is_taken_out_first() -> None:
    """`p_B = R^T (p_G - o)` with the rotation `Rz(yaw) Ry(pitch) Rx(roll)`."""
    robot, (roll, pitch, yaw), position = load_robot("strider"), (0.08, -0.05, 0.2), np.array([0.01, 0.02, 0.12])
    cos, sin = math.cos, math.sin
    rz = np.array([[cos(yaw), -sin(yaw), 0], [sin(yaw), cos(yaw), 0], [0, 0, 1]])
    ry = np.array([[cos(pitch), 0, sin(pitch)], [0, 1, 0], [-sin(pitch), 0, cos(pitch)]])
    rx = np.array([[1, 0, 0], [0, cos(roll), -sin(roll)], [0, sin(roll), cos(roll)]])
    body = Pose.from_rpy(roll, pitch, yaw, position)
    assert body.rotation == pytest.approx(rz @ ry @ rx, abs=TIGHT)
    feet = default_stance(robot, 0.11) * (1, 1, 0)
    in_body = (feet - position) @ (rz @ ry @ rx)
    with_body, without = inverse_kinematics(robot, feet, body).require(), inverse_kinematics(robot, in_body)
    assert with_body.angles == pytest.approx(without.angles, abs=TIGHT)


def test_004_erratum_the_other_convention_does_not_close() -> None:
    """`q2 = gamma - alpha` is the knee-down solution and goes with `+(pi - beta)`; `-beta` is another foot."""
    leg = one_leg(0.068, 0.098, 0.181)
    foot = np.array([[0.2, 0.0, -0.11]])
    down = solve(leg, foot, knee="down")
    _, q2, q3 = leg_ik_004((foot + R_B) * 1000, 0.0)[0]
    gamma = math.atan2(-0.11, 0.2 - 0.068)
    alpha, beta = q2 - gamma, math.pi - q3
    assert down[0, 1:] == pytest.approx([gamma - alpha, math.pi - beta])
    as_printed = forward_kinematics(leg, np.array([[0.0, gamma - alpha, -beta]]))[0, 3]
    assert np.linalg.norm(as_printed - foot[0]) > 0.1


def test_004_loose_ripple_there_is_the_wave_gait() -> None:
    """Five feet down is the literature's wave; its ripple has four."""
    wave, ripple, tripod = (Gait.named(name) for name in ("wave", "ripple", "tripod"))
    assert (tripod.fewest_feet_down, wave.fewest_feet_down, ripple.fewest_feet_down) == (3, 5, 4)
    assert (tripod.duty_factor, wave.duty_factor, ripple.duty_factor) == pytest.approx((1 / 2, 5 / 6, 2 / 3))


# The page and the tests


def test_the_page_names_every_test_here() -> None:
    tests = {name for name, _ in inspect.getmembers(sys.modules[__name__], inspect.isfunction) if name[:5] == "test_"}
    by_source = {name for name in tests if re.match(r"test_00\d_", name)}
    named = set(re.findall(r"`(test_00\d_\w+)`", PAGE.read_text(encoding="utf-8")))
    assert by_source - named == set()
    assert named - by_source == set()
