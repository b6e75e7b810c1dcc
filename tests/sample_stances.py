"""Robots in stances, with their workspaces, velocity limits and cycle times."""

import functools

import numpy as np

from gait_robots import preset
from tarsus.control.workspace.cycle_time import cycle_timing
from tarsus.control.workspace.foot_workspace import foot_workspace
from tarsus.control.workspace.stance_limits import velocity_limits
from tarsus.gait.foot_polygons import NORMALS, polygon_margin
from tarsus.gait.gait import Gait
from tarsus.gait.stance.stance_geometry import stance_geometry_of
from tarsus.gait.walk_setup import WalkSetup
from tarsus.incremental import complete
from tarsus.kinematics.pose import Pose
from tarsus.robot.joint_limits import joint_limits

# Level, and two with translations and rotations.
POSTURES = (
    (0.0,) * 6,
    (0.01, 0.01, 0.01, 0.05, -0.05, 0.1),
    (-0.02, 0.02, -0.01, 0.1, 0.0, -0.1),
)


@functools.cache
def setup_of(robot, gait="tripod"):
    robot = preset(robot) if isinstance(robot, str) else robot
    gait = Gait.named(gait, legs=robot.legs) if isinstance(gait, str) else gait
    return WalkSetup.of(robot, gait, body_height=None, swing_height=None, body_tilt=(0.0, 0.0), foot_distance=None)


def posture_of(setup, body=POSTURES[0]):
    return np.array([*body[:2], body[2] + setup.body_height, *body[3:], setup.swing_height])


def standing(setup, body=POSTURES[0]):
    return stance_geometry_of(posture_of(setup, body), setup.rest[:, 0] + 1j * setup.rest[:, 1])


def pose_of(stand):
    return Pose(stand.rotation, stand.position)


def feet_at(points, height=0.0):
    return np.stack([points.real, points.imag, np.zeros(points.shape) + height], axis=-1)


@functools.cache
def polygons(name, body=POSTURES[0]):
    setup = setup_of(name)
    return complete(foot_workspace(setup.robot, standing(setup, body), foot_distance=setup.foot_distance))


@functools.cache
def velocity_limits_of(name, gait="tripod", body=POSTURES[0]):
    setup = setup_of(name, gait)
    return complete(
        velocity_limits(setup.robot, setup.gait, [standing(setup, body)], foot_distance=setup.foot_distance)
    )


@functools.cache
def cycle_timing_of(name, gait="tripod", cycle_time=None):
    setup = setup_of(name, gait)
    return complete(
        cycle_timing(
            setup.robot,
            setup.gait,
            standing(setup),
            velocity_limits_of(name, gait),
            joint_limits(setup.robot),
            cycle_time=cycle_time,
        )
    )


def polygon_radii(bounds, inside, directions):
    """Return the distance from points inside polygons, given by their 16 sides, to the boundary along directions."""
    margins = np.maximum(polygon_margin(bounds, inside), 0.0)
    along = (NORMALS.conj()[:, None] * directions).real
    return np.asarray(np.where(along > 1e-9, margins[:, :, None] / np.maximum(along, 1e-9), np.inf).min(axis=1))
