"""Checks that the commands of a scenario fit a robot, before it runs."""

from __future__ import annotations

from tarsus.errors import InputError, UnknownNameError
from tarsus.gait.gait import Gait
from tarsus.robot.robot import Robot
from tarsus.scenario.active_commands import leg_number
from tarsus.scenario.commands import Force, GaitChange
from tarsus.scenario.scenario import Scenario
from tarsus.scenario.wording import command_text

__all__ = ["require_drivable"]


def require_drivable(scenario: Scenario, robot: Robot) -> None:
    """Refuse commands that do not fit a robot.

    Parameters
    ----------
    scenario : Scenario
        The scenario.
    robot : Robot
        A single robot.

    Raises
    ------
    InputError
        If a command names a gait that does not fit the robot, or sets a force that its feet can't comply with.
    UnknownNameError
        If a command names a leg that the robot does not have.
    """
    for command in scenario.commands:
        at = f"at {command.at:g} s"
        leg = getattr(command, "leg", None)
        if leg is not None and leg_number(robot, leg) is None:
            raise UnknownNameError(f"{at}: {UnknownNameError.of('leg', leg, robot.leg_codes)}")
        if isinstance(command, Force):
            why = _not_compliant(scenario, robot)
            if why:
                raise InputError(f"{at}: {command_text(command)}: {why}")
        if isinstance(command, GaitChange):
            try:
                Gait.named(command.gait, legs=robot.legs)
            except InputError as error:
                raise InputError(f"{at}: {error}") from None


def _not_compliant(scenario: Scenario, robot: Robot) -> str:
    """Return why the feet would not comply with a force; empty where they would."""
    if scenario.admittance is None:
        return (
            "the feet are not compliant; set in the scenario: "
            "admittance = { mass_kg = 1, damping_ns_m = 60, stiffness_n_m = 400 }"
        )
    if not robot.has_masses:
        return f"{robot.name} has no masses, so that the weight on a foot is unknown; add them to its robot file"
    return ""
