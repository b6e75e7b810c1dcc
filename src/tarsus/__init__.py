"""Tarsus: the toolkit for six-legged robots, from a robot file to joint angles, walks, torques and servos.

Everything public is here::

    import tarsus

    robot = tarsus.load_robot("strider")
    walk = tarsus.plan_walk(robot, tarsus.Gait.named("tripod"), tarsus.straight_path(1.0))

Inside, all is SI: metres, radians, seconds, kilograms. Files and the command line speak millimetres and degrees.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tarsus.drive.recording import Recording
    from tarsus.drive.run import run_scenario
    from tarsus.drive.scenario import Scenario
    from tarsus.errors import (
        CollisionError,
        InputError,
        MissingDataError,
        RobotFileError,
        StrokeError,
        TarsusError,
        UnknownNameError,
        UnreachableError,
    )
    from tarsus.gait.cycle import cycle_feet
    from tarsus.gait.gait import GAITS, Gait
    from tarsus.gait.live.admittance import Admittance
    from tarsus.gait.live.fold import folded_pose
    from tarsus.gait.live.fold_power import power_off_order
    from tarsus.gait.live.guard import Guard, GuardBounds, Guarded, Intervention
    from tarsus.gait.live.rise import fold, sit_down, stand_up
    from tarsus.gait.live.senses import Senses
    from tarsus.gait.live.sequence import Sequence
    from tarsus.gait.live.sequence_player import SequencePlayer
    from tarsus.gait.live.walker import Walker
    from tarsus.gait.live.wish import Wish
    from tarsus.gait.motion import Motion
    from tarsus.gait.path import Path, curved_path, straight_path, twist_path
    from tarsus.gait.plan import plan_walk
    from tarsus.gait.stroke import max_stroke
    from tarsus.kinematics.body import coxa_frames, reachable_share
    from tarsus.kinematics.inverse import inverse_kinematics
    from tarsus.kinematics.leg import forward_kinematics, leg_jacobian
    from tarsus.kinematics.mass import centre_of_mass, total_mass
    from tarsus.kinematics.polygon import support_polygon
    from tarsus.kinematics.pose import Pose
    from tarsus.kinematics.reach import IKSolution, Reach
    from tarsus.kinematics.rest import Rest, resting_pose
    from tarsus.kinematics.stability import stability_margin
    from tarsus.kinematics.stance import default_clearance, default_stance, reachable_band
    from tarsus.load.contact import ContactForces, contact_forces
    from tarsus.load.designs import CycleTorques, cycle_torques
    from tarsus.load.friction import contact_forces_with_friction
    from tarsus.load.handbook.method import handbook
    from tarsus.load.handbook.statics import compare_with_statics
    from tarsus.load.inertia import MotionTorques, motion_torques
    from tarsus.load.loads import Loads, loads
    from tarsus.load.payload import Payload
    from tarsus.load.sizing import ServoSizing, size_servos
    from tarsus.load.supply import Supply, supply
    from tarsus.load.torque import joint_torques
    from tarsus.load.verdict import JointVerdict, joint_verdicts
    from tarsus.report.angles import plot_angles
    from tarsus.report.animation import animate
    from tarsus.report.footpaths import plot_footpaths
    from tarsus.report.gait_diagram import plot_gait
    from tarsus.report.skeleton import plot_robot
    from tarsus.report.timeline import plot_timeline
    from tarsus.robot.catalogue import list_servos, load_servo
    from tarsus.robot.file import list_robots, load_robot, robot_schema
    from tarsus.robot.robot import JOINTS, GaitDefaults, Robot, Source, stack_robots
    from tarsus.robot.servo import Servo

__version__ = "0.1.0"

# Where each public name lives. It is imported when first asked for: `import tarsus` and `tarsus --help` do not wait
# for NumPy. A test holds this table, the imports above and `__all__` against each other.
_HOMES = {
    "tarsus.drive.recording": ("Recording",),
    "tarsus.drive.run": ("run_scenario",),
    "tarsus.drive.scenario": ("Scenario",),
    "tarsus.errors": (
        *("CollisionError", "InputError", "MissingDataError", "RobotFileError", "StrokeError", "TarsusError"),
        *("UnknownNameError", "UnreachableError"),
    ),
    "tarsus.gait.cycle": ("cycle_feet",),
    "tarsus.gait.gait": ("GAITS", "Gait"),
    "tarsus.gait.live.admittance": ("Admittance",),
    "tarsus.gait.live.fold": ("folded_pose",),
    "tarsus.gait.live.fold_power": ("power_off_order",),
    "tarsus.gait.live.guard": ("Guard", "GuardBounds", "Guarded", "Intervention"),
    "tarsus.gait.live.rise": ("fold", "sit_down", "stand_up"),
    "tarsus.gait.live.senses": ("Senses",),
    "tarsus.gait.live.sequence": ("Sequence",),
    "tarsus.gait.live.sequence_player": ("SequencePlayer",),
    "tarsus.gait.live.walker": ("Walker",),
    "tarsus.gait.live.wish": ("Wish",),
    "tarsus.gait.motion": ("Motion",),
    "tarsus.gait.path": ("Path", "curved_path", "straight_path", "twist_path"),
    "tarsus.gait.plan": ("plan_walk",),
    "tarsus.gait.stroke": ("max_stroke",),
    "tarsus.kinematics.body": ("coxa_frames", "reachable_share"),
    "tarsus.kinematics.inverse": ("inverse_kinematics",),
    "tarsus.kinematics.leg": ("forward_kinematics", "leg_jacobian"),
    "tarsus.kinematics.mass": ("centre_of_mass", "total_mass"),
    "tarsus.kinematics.polygon": ("support_polygon",),
    "tarsus.kinematics.pose": ("Pose",),
    "tarsus.kinematics.reach": ("IKSolution", "Reach"),
    "tarsus.kinematics.rest": ("Rest", "resting_pose"),
    "tarsus.kinematics.stability": ("stability_margin",),
    "tarsus.kinematics.stance": ("default_clearance", "default_stance", "reachable_band"),
    "tarsus.load.contact": ("ContactForces", "contact_forces"),
    "tarsus.load.designs": ("CycleTorques", "cycle_torques"),
    "tarsus.load.friction": ("contact_forces_with_friction",),
    "tarsus.load.handbook.method": ("handbook",),
    "tarsus.load.handbook.statics": ("compare_with_statics",),
    "tarsus.load.inertia": ("MotionTorques", "motion_torques"),
    "tarsus.load.loads": ("Loads", "loads"),
    "tarsus.load.payload": ("Payload",),
    "tarsus.load.sizing": ("ServoSizing", "size_servos"),
    "tarsus.load.supply": ("Supply", "supply"),
    "tarsus.load.torque": ("joint_torques",),
    "tarsus.load.verdict": ("JointVerdict", "joint_verdicts"),
    "tarsus.report.angles": ("plot_angles",),
    "tarsus.report.animation": ("animate",),
    "tarsus.report.footpaths": ("plot_footpaths",),
    "tarsus.report.gait_diagram": ("plot_gait",),
    "tarsus.report.skeleton": ("plot_robot",),
    "tarsus.report.timeline": ("plot_timeline",),
    "tarsus.robot.catalogue": ("list_servos", "load_servo"),
    "tarsus.robot.file": ("list_robots", "load_robot", "robot_schema"),
    "tarsus.robot.robot": ("JOINTS", "GaitDefaults", "Robot", "Source", "stack_robots"),
    "tarsus.robot.servo": ("Servo",),
}
_HOME_OF = {name: module for module, names in _HOMES.items() for name in names}

__all__ = [
    "GAITS",
    "JOINTS",
    "Admittance",
    "CollisionError",
    "ContactForces",
    "CycleTorques",
    "Gait",
    "GaitDefaults",
    "Guard",
    "GuardBounds",
    "Guarded",
    "IKSolution",
    "InputError",
    "Intervention",
    "JointVerdict",
    "Loads",
    "MissingDataError",
    "Motion",
    "MotionTorques",
    "Path",
    "Payload",
    "Pose",
    "Reach",
    "Recording",
    "Rest",
    "Robot",
    "RobotFileError",
    "Scenario",
    "Senses",
    "Sequence",
    "SequencePlayer",
    "Servo",
    "ServoSizing",
    "Source",
    "StrokeError",
    "Supply",
    "TarsusError",
    "UnknownNameError",
    "UnreachableError",
    "Walker",
    "Wish",
    "__version__",
    "animate",
    "centre_of_mass",
    "compare_with_statics",
    "contact_forces",
    "contact_forces_with_friction",
    "coxa_frames",
    "curved_path",
    "cycle_feet",
    "cycle_torques",
    "default_clearance",
    "default_stance",
    "fold",
    "folded_pose",
    "forward_kinematics",
    "handbook",
    "inverse_kinematics",
    "joint_torques",
    "joint_verdicts",
    "leg_jacobian",
    "list_robots",
    "list_servos",
    "load_robot",
    "load_servo",
    "loads",
    "max_stroke",
    "motion_torques",
    "plan_walk",
    "plot_angles",
    "plot_footpaths",
    "plot_gait",
    "plot_robot",
    "plot_timeline",
    "power_off_order",
    "reachable_band",
    "reachable_share",
    "resting_pose",
    "robot_schema",
    "run_scenario",
    "sit_down",
    "size_servos",
    "stability_margin",
    "stack_robots",
    "stand_up",
    "straight_path",
    "supply",
    "support_polygon",
    "total_mass",
    "twist_path",
]


def __getattr__(name: str) -> Any:
    """Import a public name from where it lives."""
    if name not in _HOME_OF:
        raise AttributeError(f"module 'tarsus' has no attribute {name!r}")
    value = getattr(import_module(_HOME_OF[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
