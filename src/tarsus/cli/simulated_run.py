"""Runs of `tarsus simulate`: a planned walk or a scenario on a simulated plant, and the files of the run."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
import numpy as np
from click.core import ParameterSource

from tarsus.cli.output import Progress
from tarsus.cli.planning import plan
from tarsus.cli.timeline import timeline_of
from tarsus.control.compensated_plant import CompensatedPlant
from tarsus.control.plant import Plant
from tarsus.errors import InputError, TarsusError
from tarsus.gait.motion import Motion
from tarsus.load.compliant.joint_springs import JointSprings
from tarsus.load.deflection import SHARE, compensate_deflection, what_is_compensated
from tarsus.report.animation import animate
from tarsus.robot.file import load_robot
from tarsus.robot.robot import Robot
from tarsus.scenario.runner import run_scenario
from tarsus.simulation.servos.servo_model import ServoModel
from tarsus.simulation.simulated_plant import SimulatedPlant
from tarsus.simulation.terrain.flat import Flat
from tarsus.simulation.truth.as_motion import trace_motion
from tarsus.simulation.truth.comparison import compare, planned_torques
from tarsus.simulation.truth.outcome import Outcome
from tarsus.simulation.truth.trace import Trace, trace_to_csv, trace_to_dataset
from tarsus.simulation.truth.traced_plant import TracedPlant

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["SimulatedRun", "run_plan", "run_timeline", "write_run"]


@dataclass(frozen=True, eq=False, kw_only=True)
class SimulatedRun:
    """A run in physics.

    Attributes
    ----------
    motion : Motion
        The motion that was planned, or commanded by the controller.
    plant : SimulatedPlant
        The plant, in its state at the end.
    trace : Trace
        What the robot did over time.
    outcome : Outcome
        Summary of the trace in numbers.
    planned : (array, shape (3,), array, shape (3,)), optional
        Peak and root mean square torque of coxa, femur and tibia that statics predicts [N m].
    assumed : tuple of str
        Assumptions of plan, model and servos, a line each.
    command_problems : tuple of str
        Commands of a scenario that were not met in full, and interventions of the guard, a line each.
    """

    motion: Motion
    plant: SimulatedPlant
    trace: Trace
    outcome: Outcome
    planned: tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]] | None
    assumed: tuple[str, ...]
    command_problems: tuple[str, ...] = ()


def run_plan(robot: str, options: dict[str, Any], settings: dict[str, Any], progress: Progress) -> SimulatedRun:
    """Plan a walk, and execute it in physics.

    Parameters
    ----------
    robot : str
        Name of the robot, or path of its file.
    options : dict
        Options of `tarsus.cli.planning.plan`.
    settings : dict
        Keyword arguments of `SimulatedPlant`.
    progress : callable
        Takes what is done, and the completed fraction.

    Raises
    ------
    TarsusError
        If the walk is not possible, or can't be simulated.
    """
    if settings["sensors"] != "blind":
        reason = "a planned walk is executed as it is, without feedback"
        raise click.UsageError(f"--sensors {settings['sensors']} needs --scenario: {reason}")
    motion = plan(robot, {**options, "compensate": None})
    if not motion.ok:
        raise TarsusError(f"the walk is not possible: {motion.problems[0]}; `tarsus walk` shows the whole verdict")
    if options["compensate"]:
        motion = compensate_deflection(motion, springs=_springs(motion.robot, settings["servos"]))
    progress("physics", 0.1)
    truth = compare(motion, **settings)
    return SimulatedRun(
        motion=motion,
        plant=truth.plant,
        trace=truth.trace,
        outcome=truth.outcome,
        planned=(truth.planned_peak, truth.planned_rms),
        assumed=(*motion.assumed, *truth.assumed),
    )


def run_timeline(
    scenario: str, robot: str, options: dict[str, Any], settings: dict[str, Any], progress: Progress
) -> SimulatedRun:
    """Run a scenario through the robot controller in physics.

    Parameters
    ----------
    scenario : str
        Path of a scenario file, or a timeline.
    robot, options, settings, progress
        As for `run_plan`; of the options, only the rate and the compensation may be given.

    Raises
    ------
    UsageError
        If another option of a walk is given.
    TarsusError
        If the scenario can't be run.
    """
    given = [name for name, value in options.items() if value is not None and name not in ("rate", "compensate")]
    if given:
        raise click.UsageError(f"--{given[0].replace('_', '-')} and --scenario exclude each other")
    asked = click.get_current_context().get_parameter_source("rate") is ParameterSource.COMMANDLINE
    commands = timeline_of(scenario, options["rate"] if asked else None)
    plant = SimulatedPlant(load_robot(robot), **settings)
    traced = TracedPlant(plant)
    progress("physics", 0.1)
    executing: Plant = traced
    assumed = plant.assumed
    if options["compensate"]:
        executing = CompensatedPlant(traced, springs=_springs(plant.robot, settings["servos"]))
        assumed = (*assumed, what_is_compensated(SHARE))
    recording = run_scenario(commands, robot=plant.robot, plant=executing)
    trace = traced.trace
    standing = recording.longest_standing
    planned = None if standing is None else planned_torques(standing)
    return SimulatedRun(
        motion=recording.motion,
        plant=plant,
        trace=trace,
        outcome=Outcome.of(trace),
        planned=planned,
        assumed=assumed,
        command_problems=recording.command_problems,
    )


def write_run(
    found: SimulatedRun, *, out: Path | None, zarr: bool, video: Path | None, progress: Progress
) -> list[Path]:
    """Write the files of a run, and return their paths.

    Parameters
    ----------
    found : SimulatedRun
        The run.
    out : Path, optional
        Existing folder for the table.
    zarr : bool
        Whether to write a Zarr store there, too.
    video : Path, optional
        Where to write a video.
    progress : callable
        Takes what is done, and the completed fraction.

    Raises
    ------
    TarsusError
        If a file can't be written, or a package for it is missing.
    """
    written = []
    if out is not None:
        written.append(out / "trace.csv")
        trace_to_csv(found.trace, written[-1])
        if zarr:
            written.append(out / "trace.zarr")
            _write_zarr(found.trace, written[-1])
    if video is not None:
        motion, terrain = trace_motion(found.trace, found.motion), found.plant.terrain
        animate(
            motion,
            video,
            height=None if isinstance(terrain, Flat) else terrain.height,
            progress=lambda fraction: progress(video.name, fraction),
        )
        written.append(video)
    return written


def _springs(robot: Robot, servos: str) -> JointSprings | None:
    """Return the joint springs of ideal servos; None for those of the robot's own servos."""
    return JointSprings.uniform(robot, ServoModel.ideal(robot).stiffness) if servos == "ideal" else None


def _write_zarr(trace: Trace, path: Path) -> None:
    dataset = trace_to_dataset(trace)
    try:
        dataset.to_zarr(path, mode="w", zarr_format=2)
    except ImportError:
        raise InputError("a Zarr store needs zarr: pip install 'tarsus[data]'") from None
    except OSError as error:
        raise InputError(f"{path} can't be written: {error.strerror}") from None
