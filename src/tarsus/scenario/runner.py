"""Runs a scenario: through the robot controller, on any plant."""

from __future__ import annotations

from typing import Any

from tarsus.control.loop.recording import Recording
from tarsus.control.loop.run import run
from tarsus.control.plant import IdealPlant, Plant
from tarsus.control.robot_controller import RobotController
from tarsus.control.robot_state import RobotState
from tarsus.errors import InputError
from tarsus.gait.gait import Gait
from tarsus.robot.file import load_robot
from tarsus.robot.robot import Robot
from tarsus.scenario.active_commands import ScenarioCommands
from tarsus.scenario.commands import Force, Ground, Tilt
from tarsus.scenario.drivable import require_drivable
from tarsus.scenario.scenario import Scenario
from tarsus.scenario.wording import command_text

__all__ = ["run_scenario", "scenario_commands", "scenario_controller"]

_STARTS = {"standing": RobotState.STANDING, "sitting": RobotState.LYING, "folded": RobotState.FOLDED}


def run_scenario(
    scenario: Scenario, *, robot: Robot | str | None = None, plant: Plant | None = None, guard: bool = True
) -> Recording:
    """Run a scenario through the robot controller on a plant, and record every tick.

    Commands are given at the first tick at or after their time. While the guard holds the robot, the controller waits.

    Parameters
    ----------
    scenario : Scenario
        The timeline of commands.
    robot : Robot or str, optional
        Which robot; the plant's, or else the scenario's own, where left out.
    plant : Plant, optional
        What executes the joint angles; an `IdealPlant` where left out.
    guard : bool
        Whether a guard checks the angles.

    Raises
    ------
    InputError
        If no robot is named, a command names a gait that does not fit it or sets a force that its feet can't comply
        with, or the plant can't simulate what a command asks for.
    UnknownNameError
        If a command names a leg that the robot does not have.
    UnreachableError
        If the robot can't stand in the stance of the scenario.
    """
    chosen = _robot(scenario, robot, plant)
    controller = scenario_controller(scenario, chosen, guard=guard)
    plant = IdealPlant(chosen) if plant is None else plant
    return run(
        controller,
        plant,
        scenario_commands(scenario, plant),
        rate=scenario.rate,
        jitter=scenario.jitter,
        seed=scenario.seed,
        name=scenario.name,
    )


def scenario_controller(
    scenario: Scenario, robot: Robot, *, start: RobotState | None = None, guard: bool = True
) -> RobotController:
    """Return a controller with the settings of a scenario.

    Parameters
    ----------
    scenario, robot : Scenario, Robot
        The scenario; a single robot.
    start : RobotState, optional
        Initial state of the robot; that of the scenario where left out.
    guard : bool
        Whether a guard checks the angles.

    Raises
    ------
    InputError
        If a command names a gait that does not fit the robot, or sets a force that its feet can't comply with.
    UnknownNameError
        If a command names a leg that the robot does not have.
    """
    require_drivable(scenario, robot)
    levelling: Any = None if scenario.levelling == "none" else scenario.levelling or "level"
    return RobotController(
        robot,
        Gait.named(scenario.gait or robot.gait.name, legs=robot.legs),
        start=_STARTS[scenario.start] if start is None else start,
        body_height=scenario.body_height,
        swing_height=scenario.swing_height,
        levelling=levelling,
        admittance=scenario.admittance,
        guard=guard,
    )


def scenario_commands(scenario: Scenario, plant: Plant) -> ScenarioCommands:
    """Return the commands of a scenario for a plant.

    Parameters
    ----------
    scenario, plant : Scenario, Plant
        The scenario; what executes the joint angles.

    Raises
    ------
    InputError
        If the plant can't simulate what a command asks for.
    """
    environment = getattr(plant, "environment", None)
    for command in scenario.commands:
        if environment is None and isinstance(command, Ground | Tilt | Force):
            raise InputError(
                f"at {command.at:g} s: {command_text(command)}: only an ideal plant simulates what sensors measure; "
                "leave the command out"
            )
    return ScenarioCommands(scenario, plant.robot, environment)


def _robot(scenario: Scenario, robot: Robot | str | None, plant: Plant | None) -> Robot:
    chosen = robot if robot is not None else plant.robot if plant is not None else scenario.robot
    if not chosen:
        raise InputError("the scenario names no robot; give one")
    return chosen if isinstance(chosen, Robot) else load_robot(chosen)
