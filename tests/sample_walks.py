"""Short walks to draw and to print, planned once."""

import math
from functools import cache

from tarsus.gait.gait import Gait
from tarsus.gait.path import curved_path, straight_path
from tarsus.gait.plan import plan_walk
from tarsus.robot.file import load_robot, robot_from_dict

WAVE_OF_FOUR = Gait(3 / 4, (0.25, 0.0, 0.5, 0.75), name="wave of four")
"""Always one of four legs in the air: without a body shift, the robot tips over."""


def ring_robot(legs):
    """A robot with any number of legs, without masses, servos or a box."""
    entries = []
    for leg in range(legs):
        yaw = 360 / legs * (leg + 0.5)
        x, y = 90 * math.cos(math.radians(yaw)), 60 * math.sin(math.radians(yaw))
        entries.append({"name": f"leg {leg}", "position_mm": [x, y, 0], "yaw_deg": yaw})
    limits = {"coxa": [-25, 25], "femur": [-80, 85], "tibia": [-150, 0]}
    leg = {"coxa_mm": 30, "femur_mm": 60, "tibia_mm": 100, "limits_deg": limits}
    return robot_from_dict({"name": f"ring {legs}", "leg": leg, "legs": entries})


@cache
def sample_walk(kind):
    """Return one of a few walks by its name."""
    strider = load_robot("strider")
    if kind == "straight":
        return plan_walk(strider, Gait.named("tripod"), straight_path(0.2), rate=50)
    if kind == "sideways":
        return plan_walk(load_robot("phoenix"), Gait.named("ripple"), straight_path(0.1, math.radians(-60)), rate=50)
    if kind == "round":
        return plan_walk(load_robot("mithi"), Gait.named("wave"), curved_path(1.0, (0.0, 0.3)), rate=50)
    if kind == "turning":
        return plan_walk(strider, Gait.named("tetrapod"), curved_path(-0.4), rate=50, body_tilt=(0.05, -0.1))
    if kind == "tips over":
        return plan_walk(ring_robot(4), WAVE_OF_FOUR, straight_path(0.1), rate=50)
    if kind == "eight legs":
        return plan_walk(ring_robot(8), Gait.named("wave", legs=8), straight_path(0.1), rate=50)
    if kind == "too fast":
        return plan_walk(strider, Gait.named("tripod"), straight_path(0.2), rate=200, speed=0.9)
    raise ValueError(kind)


WALKS = ("straight", "sideways", "round", "turning", "tips over", "eight legs", "too fast")
