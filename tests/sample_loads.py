"""Sample walks and their joint loads, cached."""

from functools import cache
from pathlib import Path

from tarsus.gait.gait import Gait
from tarsus.gait.path import straight_path
from tarsus.gait.plan import plan_walk
from tarsus.load.loads import joint_loads
from tarsus.robot.file import load_robot

EXAMPLES = Path(__file__).parents[1] / "examples"
BURNT = ("burnt-mg996r", "burnt-5kg")


def robot_of(name):
    """A preset, or one of the example files."""
    path = EXAMPLES / f"{name}.toml"
    return load_robot(path if path.exists() else name)


@cache
def sample_motion(name="strider", gait="tripod", **more):
    robot = robot_of(name)
    return plan_walk(robot, Gait.named(gait), straight_path(0.3), rate=50, **more)


@cache
def sample_loads(name="strider", gait="tripod", **conditions):
    motion = sample_motion(name, gait)
    return joint_loads(motion.robot, motion, **conditions)
