"""Robots for tests: made by hand, or at random within what a builder might choose."""

from dataclasses import replace

import numpy as np

from tarsus.robot.robot import Robot

NAMES = ("front left", "middle left", "rear left", "rear right", "middle right", "front right")
YAWS = np.deg2rad([30.0, 90.0, 150.0, -150.0, -90.0, -30.0])


def hexapod(**changes):
    """The strider's lengths and masses on a circle of 86 mm, without a box."""
    around = 0.086 * np.stack([np.cos(YAWS), np.sin(YAWS), 0 * YAWS], axis=-1)
    values = {
        "name": "sample",
        "leg_names": NAMES,
        "mount_position": around,
        "mount_yaw": YAWS,
        "coxa": np.full(6, 0.068),
        "femur": np.full(6, 0.098),
        "tibia": np.full(6, 0.181),
        "limits": np.broadcast_to(np.array([-np.pi, np.pi]), (6, 3, 2)),
        "link_com": np.broadcast_to([0.034, 0.049, 0.078], (6, 3)),
        "link_mass": np.broadcast_to([0.04, 0.16, 0.08], (6, 3)),
        "body_mass": 1.386,
    }
    return Robot(**{**values, **changes})


def random_hexapod(rng, *, box=True):
    """Every leg different, femur axes offset, a body whose centre of mass is inside its box."""
    size = rng.uniform([0.12, 0.08, 0.03], [0.3, 0.2, 0.1])
    lengths = rng.uniform([0.0, 0.05, 0.06], [0.08, 0.12, 0.2], (6, 3))
    return hexapod(
        name="random",
        mount_position=size / 2 * np.stack([np.cos(YAWS), np.sin(YAWS), 0 * YAWS], axis=-1),
        mount_yaw=YAWS + rng.uniform(-0.2, 0.2, 6),
        coxa=lengths[:, 0],
        femur=lengths[:, 1],
        tibia=lengths[:, 2],
        femur_axis_offset=rng.uniform(-0.02, 0.02, (6, 2)),
        link_com=lengths * rng.uniform(0, 1, (6, 3)),
        link_mass=rng.uniform(0.01, 0.2, (6, 3)),
        body_mass=rng.uniform(0.3, 2),
        body_com=rng.uniform(-0.3, 0.3, 3) * size if box else 0.3 * size * [*rng.uniform(-1, 1, 2), 0],
        body_size=size if box else None,
    )


def standing(count=6):
    """Angles of a stance with the knees up, as degrees (0, 35, -95) for each leg."""
    return np.deg2rad(np.tile([0.0, 35.0, -95.0], (count, 1)))


def halved(robot):
    """A robot of half the size: dynamically similar, but for dead bands and delays of its servos."""
    return scaled(robot, 0.5)


def scaled(robot, by):
    """A robot of another size: dynamically similar, but for dead bands and delays of its servos."""
    lengths = ("mount_position", "coxa", "femur", "tibia", "foot_radius", "link_com", "body_com", "body_size")
    gait = replace(robot.gait, body_height=by * robot.gait.body_height, swing_height=by * robot.gait.swing_height)
    masses = {name: by**3 * getattr(robot, name) for name in ("link_mass", "body_mass")}
    servos = tuple(
        tuple(
            replace(
                servo,
                name=f"{by} {servo.name}",
                stall_torque=by**4 * servo.stall_torque,
                no_load_speed=servo.no_load_speed / np.sqrt(by),
            )
            for servo in row
        )
        for row in robot.servos
    )
    sizes = {name: by * value for name in lengths if (value := getattr(robot, name)) is not None}
    return replace(robot, gait=gait, servos=servos, **masses, **sizes)
