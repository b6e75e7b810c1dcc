"""The end of a bring-up: all legs in the reference pose, and a slow walk in the air."""

from __future__ import annotations

import dataclasses
from functools import partial

from tarsus.control.command import Command
from tarsus.control.loop.run import run
from tarsus.control.robot_controller import RobotController
from tarsus.errors import TarsusError
from tarsus.hardware.bringup.connection import Connection
from tarsus.hardware.bringup.dialogue import Topic
from tarsus.hardware.bringup.progress import Progress
from tarsus.hardware.bringup.reference_pose import reference_angles
from tarsus.hardware.bringup.zeros import set_zeros
from tarsus.hardware.plant.servo_plant import ServoPlant
from tarsus.hardware.transport.clock import Clock
from tarsus.robot.robot import JOINTS

__all__ = ["check_pose", "walk_in_the_air"]

_TOPIC = Topic(title="Check pose and walk")
_ON_A_BOX = "All legs go slowly to the reference pose; put the robot on a box, feet in the air."
_AT_ONCE = (
    "All legs go to the reference pose, one servo after the other, each at once and at full speed, as servos of pulses "
    "do: put the robot on a box, feet in the air, bring the legs near that pose by hand, and take all hands away."
)
_WALK, _WALK_TIME = (0.03, 0.0, 0.0), 4.0


def check_pose(progress: Progress, connection: Connection, *, clock: Clock) -> None:
    """Move all legs to the reference pose until each looks right; set the zeros of a leg that does not anew.

    Parameters
    ----------
    progress : Progress
        The calibration, complete.
    connection : Connection
        Opens the buses.
    clock : Clock
        The clock.
    """
    ask, robot = progress.ask, progress.calibration.limited_robot
    while True:
        slowly = progress.calibration.kind(0, 0).feedback
        ask.choose(_ON_A_BOX if slowly else _AT_ONCE, {"": "go"}, topic=_TOPIC)
        plant = _plant(progress, connection, clock)
        try:
            output = RobotController(robot).output
            plant.start(dataclasses.replace(output, angles=reference_angles(robot), belly=True))
            options = {"": "yes", **progress.leg_options}
            answer = ask.choose("Does every leg look like the drawing?", options, topic=_TOPIC)
        except TarsusError as error:
            ask.say(str(error))
            options = {"": "none: try again", **progress.leg_options}
            answer = ask.choose("Which leg is wrong?", options, topic=_TOPIC)
            if not answer:
                continue
        finally:
            plant.stop()
        if not answer:
            return
        leg = int(answer) - 1
        for j in range(len(JOINTS)):
            progress.keep(progress.calibration.with_joint(leg, j, zero=None))
        connection.perform(partial(set_zeros, progress, leg=leg))


def walk_in_the_air(progress: Progress, connection: Connection, *, clock: Clock) -> None:
    """Walk slowly, feet free, if whoever looks wants it.

    Parameters
    ----------
    progress : Progress
        The calibration, complete.
    connection : Connection
        Opens the buses.
    clock : Clock
        The clock.
    """
    options = {"": "yes", "n": "no"}
    if progress.ask.choose("A slow walk in the air, feet free?", options, topic=_TOPIC) == "n":
        return
    plant = _plant(progress, connection, clock)
    robot = progress.calibration.limited_robot
    recording = run(RobotController(robot), plant, [(0.0, Command(twist=_WALK))], duration=_WALK_TIME)
    problems = "; ".join(recording.problems) or "no problems"
    progress.ask.say(f"it walked for {recording.motion.duration:.1f} s; {problems}")


def _plant(progress: Progress, connection: Connection, clock: Clock) -> ServoPlant:
    calibration = progress.calibration
    robot = calibration.limited_robot
    declared = None if calibration.kind(0, 0).feedback else reference_angles(robot)
    return ServoPlant(robot, calibration, buses=connection.open_all(), declared=declared, clock=clock)
