"""Quadrupeds at random, and their stability margin by means of others."""

import numpy as np
from scipy.spatial import ConvexHull

from gait_robots import ring
from tarsus.kinematics.leg import forward_kinematics


def random_quadruped(seed):
    """Four legs that differ in place, direction, size and mass, and a body whose centre of mass is off its middle."""
    rng = np.random.default_rng(seed)
    yaw = np.deg2rad([45, 135, -135, -45]) + rng.uniform(-0.3, 0.3, 4)
    place = rng.uniform(0.05, 0.14, (4, 2)) * np.sign(np.stack([np.cos(yaw), np.sin(yaw)], axis=-1))
    return ring(
        4,
        mount_position=np.concatenate([place, rng.uniform(-0.01, 0.01, (4, 1))], axis=-1),
        mount_yaw=yaw,
        coxa=rng.uniform(0.02, 0.05, 4),
        femur=rng.uniform(0.07, 0.09, 4),
        tibia=rng.uniform(0.11, 0.14, 4),
        link_mass=rng.uniform(0.01, 0.12, (4, 3)),
        body_com=np.array([*rng.uniform(-0.02, 0.02, 2), 0.0]),
        body_mass=rng.uniform(0.5, 2.0),
    )


def hull_margin(robot, angles, body, contacts):
    """Distance of the centre of mass inside the hull of the feet on the ground ``(n,)``.

    The masses are summed link by link, the hull is Qhull's.
    """
    points = body @ forward_kinematics(robot, angles)
    moment = (body @ robot.body_com) * robot.body_mass
    for leg in range(4):
        for link in range(3):
            inner, outer = points[:, leg, link], points[:, leg, link + 1]
            along = (outer - inner) / np.linalg.norm(outer - inner, axis=-1, keepdims=True)
            moment = moment + robot.link_mass[leg, link] * (inner + robot.link_com[leg, link] * along)
    centre = (moment / (robot.body_mass + robot.link_mass.sum()))[:, :2]
    margins = []
    for sample, down in enumerate(contacts):
        hull = ConvexHull(points[sample, down, 3, :2])
        margins.append(-(hull.equations[:, :2] @ centre[sample] + hull.equations[:, 2]).max())
    return np.array(margins)
