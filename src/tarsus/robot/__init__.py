"""What the robot is: a value of arrays, its file, the presets and the servo catalogue."""

from tarsus.robot.catalogue import list_servos, load_servo, servo_catalogue
from tarsus.robot.file import list_robots, load_robot, robot_schema, template_text
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.robot import JOINTS, GaitDefaults, Robot, Source, stack_robots
from tarsus.robot.servo import Servo

__all__ = [
    "JOINTS",
    "GaitDefaults",
    "LegGeometry",
    "Robot",
    "Servo",
    "Source",
    "list_robots",
    "list_servos",
    "load_robot",
    "load_servo",
    "robot_schema",
    "servo_catalogue",
    "stack_robots",
    "template_text",
]
