"""Robots standing in postures, as the live walker's parts see them."""

import functools

import numpy as np

from gait_robots import preset
from tarsus.gait.gait import Gait
from tarsus.gait.live.envelope import envelope
from tarsus.gait.live.parts import all_parts
from tarsus.gait.live.posture import stand_of
from tarsus.gait.live.support import support_sets
from tarsus.gait.live.tempo import joint_limits, tempo
from tarsus.gait.live.workspace import workspace
from tarsus.gait.setup import Setup
from tarsus.kinematics.pose import Pose

# Level; moved and turned in every way; leaning forwards and back.
POSTURES = (
    (0.0,) * 6,
    (0.01, 0.01, 0.01, 0.05, -0.05, 0.1),
    (-0.02, 0.02, -0.01, 0.1, 0.0, -0.1),
)


@functools.cache
def setup_of(robot, gait="tripod"):
    robot = preset(robot) if isinstance(robot, str) else robot
    gait = Gait.named(gait, legs=robot.legs) if isinstance(gait, str) else gait
    return Setup.of(robot, gait, clearance=None, lift=None, body_tilt=(0.0, 0.0), foot_distance=None)


def posture_of(setup, body=POSTURES[0]):
    return np.array([*body[:2], body[2] + setup.clearance, *body[3:], setup.lift])


def standing(setup, body=POSTURES[0]):
    return stand_of(posture_of(setup, body), setup.rest[:, 0] + 1j * setup.rest[:, 1])


def pose_of(stand):
    return Pose(stand.rotation, stand.position)


def feet_at(points, height=0.0):
    return np.stack([points.real, points.imag, np.zeros(points.shape) + height], axis=-1)


@functools.cache
def polygons(name, body=POSTURES[0]):
    setup = setup_of(name)
    return all_parts(workspace(setup.robot, standing(setup, body), foot_distance=setup.foot_distance))


@functools.cache
def envelope_of(name, gait="tripod", body=POSTURES[0]):
    setup = setup_of(name, gait)
    sets = support_sets(setup.gait)
    return all_parts(envelope(setup.robot, [standing(setup, body)], sets, foot_distance=setup.foot_distance))


@functools.cache
def tempo_of(name, gait="tripod", cycle_time=None):
    setup = setup_of(name, gait)
    speed, acceleration = joint_limits(setup.robot, None, None)
    return all_parts(
        tempo(
            setup.robot,
            setup.gait,
            standing(setup),
            envelope_of(name, gait),
            speed=speed,
            acceleration=acceleration,
            cycle_time=cycle_time,
        )
    )
