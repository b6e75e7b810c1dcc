"""Write the table of statics in how-true.md: joint torques by three ways of statics, over those of physics.

All 128 walks take about an hour; ``--walks 64`` takes half of them, spread over robots, gaits, paths and speeds.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from page_tables import write_tables
from tarsus.control.walk_controller import WalkController
from tarsus.gait.gait import Gait
from tarsus.gait.motion import Motion
from tarsus.gait.path import BodyPath, curved_path, straight_path
from tarsus.gait.plan import plan_walk
from tarsus.load.compliant.compliant_loads import compliant_loads
from tarsus.load.compliant.foot_contact import FootContact
from tarsus.load.compliant.joint_springs import JointSprings
from tarsus.load.friction import contact_forces_with_friction
from tarsus.load.loads import joint_loads
from tarsus.load.torque import joint_torques
from tarsus.robot.file import load_robot
from tarsus.robot.robot import Robot
from tarsus.simulation.simulated_plant import SimulatedPlant
from tarsus.simulation.terrain.flat import Flat
from tarsus.simulation.truth.traced_plant import play

PAGE = Path(__file__).parent / "how-true.md"
# Of the presets with masses those whose masses are not estimated from each other's.
ROBOTS = ("ch3r", "makeyourpet", "phantomx", "strider")
# Path, and the direction of its twist.
PATHS: dict[str, tuple[BodyPath, tuple[float, float, float]]] = {
    "straight": (straight_path(0.3), (1.0, 0.0, 0.0)),
    "sideways": (straight_path(0.3, math.pi / 2), (0.0, 1.0, 0.0)),
    "curve": (curved_path(math.radians(40), (0.0, 0.4)), (1.0, 0.0, 2.5)),
    "turn": (curved_path(math.radians(60)), (0.0, 0.0, 1.0)),
}
GAITS = ("tripod", "tetrapod", "ripple", "wave")
FRACTION_OF_TOP_SPEED = 0.95
# From one walk to the next in the list of all, whose length it shares no factor with.
STRIDE = 37
# Samples for friction cones, whose program is large.
CONE_STRIDE = 10


@dataclass(frozen=True)
class Physics:
    """Settings of the engine, and what compliant statics is told of them."""

    name: str
    servos: str = "ideal"
    friction: float = 0.8
    impratio: float | None = None

    def contact(self) -> FootContact:
        creep = {} if self.impratio is None else {"creep_time": math.inf}
        return FootContact(friction=self.friction, **creep)

    def springs(self, robot: Robot) -> JointSprings | None:
        return JointSprings.uniform(robot, 100.0, damping=1.0) if self.servos == "ideal" else None


SETTINGS = (
    Physics("ideal servos"),
    Physics("ideal servos, without creep", impratio=2000.0),
    Physics("ideal servos, friction 0.3", friction=0.3),
    Physics("servos of the catalogue", servos="catalogue"),
)


def walk(robot: Robot, gait: str, path: str, speed: str) -> Motion:
    """Plan a walk at the default speed, or near the top speed of live walking."""
    body_path, direction = PATHS[path]
    found = plan_walk(robot, Gait.named(gait), body_path, rate=100.0)
    if speed == "default":
        return found
    controller = WalkController(robot, Gait.named(gait))
    vx, vy, turn = FRACTION_OF_TOP_SPEED * controller.top_speed(direction) * np.array(direction)
    feet = found.feet[0] - found.body.position[0]
    fastest = float(np.hypot(vx - turn * feet[:, 1], vy + turn * feet[:, 0]).max())
    return plan_walk(robot, Gait.named(gait), body_path, rate=100.0, speed=fastest, cycle_time=controller.cycle_time)


def walks(count: int) -> Iterator[Motion]:
    """Yield so many of all walks, spread over robots, gaits, paths and speeds."""
    robots = [load_robot(name) for name in ROBOTS]
    each = list(itertools.product(robots, GAITS, PATHS, ("default", "top")))
    for number in range(min(count, len(each))):
        yield walk(*each[number * STRIDE % len(each)])


def physics_torques(motion: Motion, physics: Physics) -> Any:
    """Return the joint torques of a walk in physics."""
    plant = SimulatedPlant(
        motion.robot, terrain=Flat(friction=physics.friction), servos=physics.servos, sensors="blind"
    )
    if physics.impratio is not None:
        plant.mj_model.opt.impratio = physics.impratio
    return play(motion, plant).torques


def cone_torques(motion: Motion, friction: float) -> Any:
    """Return the joint torques with the least squares of torques in friction cones, at every tenth sample."""
    chosen = slice(None, None, CONE_STRIDE)
    angles, body, contacts = motion.angles[chosen], motion.body[chosen], motion.contacts[chosen]
    found = contact_forces_with_friction(motion.robot, angles, body, contacts, friction=friction, minimise="torque")
    return joint_torques(motion.robot, angles, body, contacts, forces=found.forces)[0]


def ratios(ours: Any, theirs: Any) -> Any:
    """Return by joint: peak over peak, RMS over RMS (of the leg where they are greatest), and the correlation."""
    peak = np.abs(ours).max((0, 1)) / np.abs(theirs).max((0, 1))
    rms = np.sqrt((ours**2).mean(0)).max(0) / np.sqrt((theirs**2).mean(0)).max(0)
    correlation = [np.corrcoef(ours[..., j].ravel(), theirs[..., j].ravel())[0, 1] for j in range(3)]
    return np.array([peak, rms, correlation])


def rows(physics: Physics, count: int) -> str:
    """Return the rows of the table for settings of the engine, over so many walks."""
    found: dict[str, list[Any]] = {"vertical forces": [], "friction cones": [], "compliant statics": []}
    for motion in walks(count):
        theirs = physics_torques(motion, physics)[: len(motion.time)]
        robot = motion.robot
        found["vertical forces"].append(ratios(joint_loads(robot, motion).torques, theirs))
        cones = cone_torques(motion, physics.friction)
        found["friction cones"].append(ratios(cones, theirs[::CONE_STRIDE]))
        pressed = compliant_loads(robot, motion, springs=physics.springs(robot), contact=physics.contact())
        found["compliant statics"].append(ratios(pressed.torques, theirs))
    return "".join(_row(physics, way, np.array(values)) for way, values in found.items())


def _row(physics: Physics, way: str, values: Any) -> str:
    cells = []
    for joint in range(3):
        for what in (0, 1):
            each = values[:, what, joint]
            cells.append(f"{np.median(each):.2f} ({each.min():.2f}-{each.max():.2f})")
        each = values[:, 2, joint]
        cells.append(f"{np.median(each):.2f} ({each.min():.2f})")
    return f"| {physics.name}, {len(values)} walks | {way} | {' | '.join(cells)} |\n"


def table(count: int) -> str:
    """Return the table over so many walks."""
    joints = [f"{joint} {what}" for joint in ("coxa", "femur", "tibia") for what in ("peak", "RMS", "correlation")]
    head = f"| physics | statics | {' | '.join(joints)} |\n|{'---|' * (len(joints) + 2)}\n"
    return head + "".join(rows(physics, count) for physics in SETTINGS)


if __name__ == "__main__":
    count = len(GAITS) * len(PATHS) * 8
    write_tables(__doc__, PAGE, lambda asked: {"statics": table(asked.walks)}, walks=count)
