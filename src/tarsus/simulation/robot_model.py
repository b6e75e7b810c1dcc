"""A robot as a model of rigid bodies for MuJoCo.

The world, with the terrain, carries the body on a free joint, and the body each leg's coxa, femur and tibia on hinges.
The frames of the links have their origins at the joints and x along the link; angles are those of
`docs/conventions.md`: the coxa turns about z, femur and tibia about -y, so that positive angles lift the foot.
"""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.walk_setup import require_number
from tarsus.load.compliant.foot_contact import POINT_FOOT
from tarsus.robot.robot import JOINTS, Robot, require_robot
from tarsus.simulation.engine import mujoco_module
from tarsus.simulation.inertia import BODY_HEIGHT, SECTION, body_inertia, link_inertia, link_step
from tarsus.simulation.servos.actuators import add_servo
from tarsus.simulation.servos.servo_table import ServoTable
from tarsus.simulation.settings import apply_settings
from tarsus.simulation.terrain.flat import Flat
from tarsus.simulation.terrain.protocol import Terrain

if TYPE_CHECKING:
    from jaxtyping import Shaped

__all__ = [
    "FLOOR_OF_MASS",
    "body_geom_name",
    "foot_geom_name",
    "link_name",
    "model",
    "model_assumptions",
    "passive_model",
]

FLOOR_OF_MASS = 1e-4
"""Least mass of a body or link that can be simulated [kg]."""

# Radius of point feet on ground that is not flat [m]: a larger ball would roll, which plans for point feet do not
# compensate for; a smaller one could be pressed into uneven ground by more than its radius, and would be stuck there.
_POINT_FOOT_UNEVEN = 0.003
# Radius of the links' contact capsules: at most this [m], and at most this fraction of the foot radius.
_LINK_RADIUS, _LINK_RATIO = 0.006, 0.75
# Half the thickness of a body that is the polygon of its coxa axes [m].
_HALF_PLATE = 0.001
# Links shorter than this have no contact geometry [m]; a joint with equal limits gets this range [rad].
_SHORT, _FIXED = 1e-4, 1e-6
# The engine's codes for contact sensors: the bits that select `found` and `force`, and reduction to the net force.
_FOUND, _FORCE, _NET_FORCE = 1, 2, 3
_ROBOT_COLOUR, _FOOT_COLOUR = (0.30, 0.45, 0.65, 1.0), (0.15, 0.15, 0.15, 1.0)


def link_name(robot: Robot, leg: int, joint: int) -> str:
    """Return the name of a link's body and joint in the model."""
    return f"{robot.leg_names[leg]} {JOINTS[joint]}"


def foot_geom_name(robot: Robot, leg: int) -> str:
    """Return the name of a foot's ball in the model."""
    return f"{robot.leg_names[leg]} foot"


def body_geom_name() -> str:
    """Return the name of the body and its geom in the model."""
    return "body"


def model(robot: Robot, *, terrain: Terrain | None = None, servos: Any = "catalogue") -> Any:
    """Return a robot on a terrain as a model for MuJoCo.

    Bodies are named ``"body"`` and by leg and link (``"front left femur"``), joints like the link that they move, the
    balls of the feet and the sensors of the ground's forces on them ``"front left foot"``. Each joint has the three
    actuators of a servo, ``"front left femur forward"``, ``"... backward"`` and ``"... back-EMF"``, whose control is
    the target angle [rad]. Links collide with the terrain, not with each other.

    Parameters
    ----------
    robot : Robot
        A single robot with masses.
    terrain : Terrain, optional
        What it stands on; flat ground where left out.
    servos : "catalogue", "ideal", ServoModel or nested sequence of ServoModel
        See `SimulatedPlant`.

    Returns
    -------
    mujoco.MjSpec
        The model, which ``compile()`` turns into a ``mujoco.MjModel``. It can be changed before that.

    Raises
    ------
    MissingDataError
        If the mass of the body or of a link is unknown; with ``"catalogue"``, also if a servo is.
    InputError
        If the robot is a batch, or a mass is too small to be simulated.
    TarsusError
        If MuJoCo is not installed.
    """
    _check(robot)
    table = ServoTable.of(robot, servos)
    spec = _bodies(robot, terrain, table, damping=[[servo.damping for servo in row] for row in table.servos])
    for leg in range(robot.legs):
        for joint, servo in enumerate(table.servos[leg]):
            add_servo(spec, spec.joint(link_name(robot, leg, joint)), servo)
    _add_sensors(spec, robot)
    return spec


def passive_model(robot: Robot, *, terrain: Terrain | None = None, servos: Any = "catalogue") -> Any:
    """Return the model of a robot on a terrain without actuators and sensors; all damping is in its joints.

    Parameters, returned value and errors are those of `model`.
    """
    _check(robot)
    table = ServoTable.of(robot, servos)
    return _bodies(robot, terrain, table, damping=[[servo.joint_damping for servo in row] for row in table.servos])


def _bodies(robot: Robot, terrain: Terrain | None, table: ServoTable, *, damping: list[list[float]]) -> Any:
    """Return a model of terrain, body and legs, whose joints have the given damping [N m s/rad]."""
    spec = mujoco_module().MjSpec()
    spec.modelname = robot.name
    spec.compiler.degree = False
    spec.compiler.autolimits = True
    apply_settings(spec)
    ground = Flat() if terrain is None else terrain
    if not isinstance(ground, Terrain):
        raise InputError(f"terrain must be a terrain such as Flat() or Blocks(), got {ground!r}")
    ground.add_to(spec)
    spec.worldbody.add_light(pos=(0, 0, 3), dir=(0, 0, -1))
    robot = _with_feet(robot, ground)
    body = _add_body(spec, robot)
    for leg in range(robot.legs):
        _add_leg(body, robot, leg, table, damping[leg])
    return spec


def model_assumptions(robot: Robot) -> tuple[str, ...]:
    """Return what the model of a robot assumes beyond its file, a line each.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """
    require_robot(robot)
    lines = [
        f"inertia of a link: that of a uniform box as long as the link, {1000 * SECTION:g} mm wide and high",
        "inertia of the body: that of a uniform box",
        "legs collide with the ground, not with each other or the body",
    ]
    if robot.body_size is None:
        lines.append(
            f"body: the polygon of the coxa axes, {2000 * _HALF_PLATE:g} mm thick; for its inertia, the box around it, "
            f"{1000 * BODY_HEIGHT:g} mm high"
        )
    if not np.all(robot.foot_radius):
        lines.append(
            f"foot radius where it is 0: {1000 * POINT_FOOT:g} mm, {1000 * _POINT_FOOT_UNEVEN:g} mm on uneven ground"
        )
    return tuple(lines)


def _check(robot: Robot) -> None:
    require_robot(robot)
    if robot.batch_shape:
        raise InputError(f"robot {robot.name!r} is a batch of designs {robot.batch_shape}; expected one robot")
    robot.require_masses()
    masses = {"the body": float(np.asarray(robot.body_mass))}
    for leg, joint in itertools.product(range(robot.legs), range(3)):
        masses[link_name(robot, leg, joint)] = link_inertia(robot, leg, joint).mass
    for name, mass in masses.items():
        if mass < FLOOR_OF_MASS:
            raise InputError(
                f"robot {robot.name!r}: the mass of {name} is {mass:g} kg; physics needs at least {FLOOR_OF_MASS:g} kg"
            )


def _add_body(spec: Any, robot: Robot) -> Any:
    mujoco = mujoco_module()
    mounts = np.asarray(robot.mount_position)
    name, attributes = body_geom_name(), _robot_geom()
    if robot.body_size is None:
        corners = [(x, y, z + sign * _HALF_PLATE) for x, y, z in mounts.tolist() for sign in (-1, 1)]
        spec.add_mesh(name=name, uservert=np.array(corners).ravel())
        shape = {"type": mujoco.mjtGeom.mjGEOM_MESH, "meshname": name}
    else:
        shape = {"type": mujoco.mjtGeom.mjGEOM_BOX, "size": (np.asarray(robot.body_size) / 2).tolist()}
    solid = body_inertia(robot)
    body = spec.worldbody.add_body(
        name=name,
        mass=solid.mass,
        ipos=solid.centre,
        inertia=solid.moments,
        explicitinertial=True,
    )
    body.add_freejoint(name="free")
    body.add_geom(name=name, **shape, **attributes)
    return body


def _robot_geom() -> dict[str, Any]:
    """Return the attributes of the robot's geoms: no mass, contact with the terrain only."""
    return {"mass": 0.0, "contype": 0, "conaffinity": 1, "rgba": _ROBOT_COLOUR}


def _add_leg(body: Any, robot: Robot, leg: int, table: ServoTable, damping: list[float]) -> None:
    yaw = float(robot.mount_yaw[leg])
    steps = [link_step(robot, leg, joint) for joint in range(3)]
    positions = [np.asarray(robot.mount_position[leg]), steps[0], steps[1]]
    parent = body
    for joint, step in enumerate(steps):
        turn = (math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)) if joint == 0 else (1.0, 0.0, 0.0, 0.0)
        parent = parent.add_body(
            name=link_name(robot, leg, joint),
            pos=positions[joint],
            quat=turn,
            explicitinertial=True,
            **_inertia(robot, leg, joint),
        )
        _add_joint(parent, robot, (leg, joint), damping[joint], table.servos[leg][joint].rotor_inertia)
        _add_link_geom(parent, robot, (leg, joint), step)
    geom = mujoco_module().mjtGeom.mjGEOM_SPHERE
    parent.add_geom(
        name=foot_geom_name(robot, leg),
        type=geom,
        size=(float(robot.foot_radius[leg]), 0, 0),
        pos=steps[2],
        **(_robot_geom() | {"rgba": _FOOT_COLOUR}),
    )


def _add_sensors(spec: Any, robot: Robot) -> None:
    """Add a sensor of each foot's force on the ground, in G, and one that tells whether the body is in contact."""
    kinds = mujoco_module().mjtSensor
    names = [foot_geom_name(robot, leg) for leg in range(robot.legs)]
    for name, content in [*((name, _FORCE) for name in names), (body_geom_name(), _FOUND)]:
        sensor = spec.add_sensor(
            name=name, type=kinds.mjSENS_CONTACT, objtype=mujoco_module().mjtObj.mjOBJ_GEOM, objname=name
        )
        # Quantity, reduction over all contacts, and number of results.
        sensor.intprm[:3] = content, _NET_FORCE, 1


def _inertia(robot: Robot, leg: int, joint: int) -> dict[str, Any]:
    """Return mass, centre of mass and inertia of a link, in its frame."""
    solid = link_inertia(robot, leg, joint)
    return {
        "mass": solid.mass,
        "ipos": solid.centre,
        "iquat": _quaternion_from_x(solid.axis),
        "inertia": solid.moments,
    }


def _quaternion_from_x(direction: Shaped[np.ndarray, "..."]) -> Shaped[np.ndarray, "..."]:
    """Return the quaternion of the shortest rotation from x to a unit vector; no rotation for the zero vector."""
    if not direction.any():
        return np.array([1.0, 0.0, 0.0, 0.0])
    x, y, z = direction
    quaternion = np.array([1.0 + x, 0.0, -z, y])
    length = float(np.linalg.norm(quaternion))
    return quaternion / length if length > _FIXED else np.array([0.0, 0.0, 0.0, 1.0])


def _add_joint(body: Any, robot: Robot, place: tuple[int, int], damping: float, inertia: float) -> None:
    leg, joint = place
    name = link_name(robot, leg, joint)
    low, high = np.asarray(robot.limits[leg, joint]).tolist()
    body.add_joint(
        name=name,
        type=mujoco_module().mjtJoint.mjJNT_HINGE,
        axis=(0, 0, 1) if joint == 0 else (0, -1, 0),
        range=(low, max(high, low + _FIXED)),
        damping=damping,
        armature=inertia,
    )


def _add_link_geom(body: Any, robot: Robot, place: tuple[int, int], step: Shaped[np.ndarray, "..."]) -> None:
    """Add the capsule of a link; that of the tibia ends inside the ball of the foot."""
    leg, joint = place
    foot = float(robot.foot_radius[leg])
    length = float(np.linalg.norm(step))
    end = step * max(1.0 - foot / length, 0.5) if joint == 2 else step
    if length < _SHORT:
        return
    radius = min(_LINK_RADIUS, _LINK_RATIO * foot)
    body.add_geom(
        name=link_name(robot, leg, joint),
        type=mujoco_module().mjtGeom.mjGEOM_CAPSULE,
        size=(radius, 0, 0),
        fromto=(0.0, 0.0, 0.0, *end.tolist()),
        **_robot_geom(),
    )


def _with_feet(robot: Robot, ground: Terrain) -> Robot:
    """Return the robot with the foot radii that are simulated on a terrain."""
    point = POINT_FOOT if isinstance(ground, Flat) else _POINT_FOOT_UNEVEN
    radii = [require_number("foot_radius", radius, zero=True) for radius in np.asarray(robot.foot_radius).tolist()]
    return robot.replace(foot_radius=[radius or point for radius in radii])
