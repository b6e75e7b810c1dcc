"""The work of `tarsus run`: it makes plant, controller and source of commands, runs them, and records the run."""

from __future__ import annotations

import contextlib
import dataclasses
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tarsus.cli.pulses import calibration_of
from tarsus.cli.run.status_line import StatusLine
from tarsus.cli.run.studio_drive import driven_from_studio
from tarsus.cli.signals import as_interrupts
from tarsus.cli.timeline import timeline_of
from tarsus.control.loop.recording import Recording
from tarsus.control.loop.run import CommandSource
from tarsus.control.loop.run import run as run_loop
from tarsus.control.plant import Plant
from tarsus.control.robot_controller import RobotController
from tarsus.control.robot_state import RobotState
from tarsus.errors import InputError, ServoFaultError
from tarsus.hardware.calibration.blank import nominal_calibration
from tarsus.hardware.calibration.bus_commands import bus_commands, usual_bus
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.live.emulated_robot import EmulatedRobot
from tarsus.hardware.live.gamepad import Gamepad
from tarsus.hardware.live.keyboard import KEYS, Keyboard
from tarsus.hardware.live.live_commands import InputDevice, LiveCommands
from tarsus.hardware.live.supervision import Rising, Supervised
from tarsus.hardware.plant.pacer import Timing
from tarsus.hardware.plant.servo_plant import ServoPlant
from tarsus.hardware.plant.tick_record import TickRecord
from tarsus.hardware.telemetry.log import TelemetryLog
from tarsus.robot.file import load_robot
from tarsus.robot.robot import Robot
from tarsus.scenario.runner import scenario_commands, scenario_controller
from tarsus.scenario.scenario import Scenario

__all__ = ["perform"]

_DEMO = "at 0 s: walk 60 mm/s; at 2 s: walk turn 20 deg/s; at 3 s: stop"
# Least and greatest number of ticks per second in physics [1/s].
_SLOWEST, _FASTEST = 20.0, 500.0
# Greatest twist by keys and gamepads: forward, sideways and turning [m/s, m/s, rad/s].
_SPEEDS = (0.06, 0.05, 0.4)
_REAL, _EMULATED, _SIMULATED = "real", "emulated", "simulated"


def perform(robot: str, options: dict[str, Any], *, out: Path | None, quiet: bool) -> dict[str, Any]:
    """Run a robot, and return what happened.

    Parameters
    ----------
    robot : str
        Name of the robot, or path of its file.
    options : dict
        Options of `tarsus run`.
    out : Path, optional
        Existing folder for the records.
    quiet : bool
        Whether nothing is shown during the run.

    Raises
    ------
    TarsusError
        If the run can't begin.
    """
    where, kind = _bus(options)
    chosen = load_robot(robot)
    if where == _SIMULATED:
        return _simulated(chosen, options, out=out)
    calibration = _calibration(robot, chosen, options, where, kind)
    calibration.require_complete()
    start = options["start"] or ("lying" if where == _REAL else None)
    with as_interrupts(), contextlib.ExitStack() as stack:
        scenario = _scenario(options)
        found = None if start is None else RobotState(start)
        controller = scenario_controller(scenario, calibration.limited_robot, start=found)
        buses = None
        if where == _EMULATED:
            emulated = stack.enter_context(EmulatedRobot(calibration, controller.output.angles))
            calibration, buses = emulated.calibration, emulated.buses
        log = None if out is None else stack.enter_context(TelemetryLog(chosen, out))
        line = stack.enter_context(StatusLine(quiet=quiet))
        bus = f"{where}: {', '.join(each.properties.text for each in calibration.buses)}"
        driven = None
        observers = [] if log is None else [log.write]
        if options["studio"]:
            driven = stack.enter_context(driven_from_studio(controller, calibration, options["studio"], bus))
            observers.append(driven.observe)
        plant = ServoPlant(
            calibration.limited_robot,
            calibration,
            buses=buses,
            observer=line.observer(_each_of(observers)),
        )
        line.plant = plant
        if driven is not None:
            driven.plant = plant
        with plant:
            rate = _rate(options["rate"], plant, scenario.rate)
            source = _source(plant, scenario, options, stack, line) if driven is None else driven
            if start == "lying":
                source = Rising(source)
            outcome = _run(controller, plant, Supervised(source, plant), rate, options["duration"], line)
    if log is not None and log.problem:
        plant.notes.append(log.problem)
    return _summary(chosen, bus, plant, outcome, line, out, logged=log is not None and not log.problem)


def _bus(options: dict[str, Any]) -> tuple[str, str]:
    """Return whether the robot is real, emulated or simulated, and the kind of its emulated bus, empty if not given."""
    where, _, kind = (options["bus"] or (_REAL if options["calibration"] else _EMULATED)).partition(":")
    if where not in (_REAL, _EMULATED, _SIMULATED):
        raise InputError(f"--bus {options['bus']}: it must be real, emulated, emulated:KIND or simulated")
    if kind and where != _EMULATED:
        raise InputError(f"--bus {options['bus']}: only emulated buses have a kind; give --bus {where}")
    if where != _REAL and options["port"] is not None:
        raise InputError(f"--port is for real robots; with --bus {where} leave it out, or give --bus real")
    if where == _SIMULATED and options["calibration"] is not None:
        raise InputError("physics moves the joints without servo commands: leave --calibration out, or --bus simulated")
    return where, kind


def _each_of(observers: Sequence[Callable[[TickRecord], None]]) -> Callable[[TickRecord], None]:
    def observe(record: TickRecord) -> None:
        for each in observers:
            each(record)

    return observe


def _rate(asked: float | None, plant: ServoPlant, usual: float) -> float:
    """Return the ticks per second [1/s]: as asked, else as usual but at most what the wires carry with a reserve."""
    greatest, least = plant.greatest_rate, 1.0 / plant.settings.longest_tick
    if asked is None:
        found = min(usual, float(np.floor(plant.usual_rate)))
        if found >= least:
            return found
        asked = found
    if greatest < least:
        raise InputError(
            f"the wires carry {greatest:.0f} ticks per second; walking takes {least:g}, below which joints are slowed "
            "down: set a higher baud rate, or a shorter return delay"
        )
    return _within(asked, least, greatest, f"the {greatest:.0f} Hz that the wires carry")


def _within(rate: float, least: float, greatest: float, most: str) -> float:
    """Return a rate [1/s] if it is in its range, else raise an error; `most` describes the upper end of the range."""
    if not least <= rate <= greatest:
        raise InputError(
            f"--rate is {rate:g} Hz; it must be from {least:g} Hz, below which joints are slowed down, to {most}"
        )
    return rate


@dataclasses.dataclass
class _Outcome:
    recording: Recording | None = None
    fault: ServoFaultError | None = None
    interrupted: bool = False


def _run(
    controller: RobotController,
    plant: Plant,
    source: CommandSource,
    rate: float,
    duration: float | None,
    line: StatusLine,
) -> _Outcome:
    outcome = _Outcome()
    try:
        outcome.recording = run_loop(controller, plant, line.watched(_limited(source, duration)), rate=rate)
    except ServoFaultError as error:
        outcome.fault = error
    except KeyboardInterrupt:
        outcome.interrupted = True
    return outcome


def _limited(source: CommandSource, duration: float | None) -> CommandSource:
    """Return a source of commands that is over after a duration at the latest."""
    if duration is None:
        return source
    end = duration

    class Limited:
        command = staticmethod(source.command)

        def over(self, time: float, output: Any) -> bool:
            """Return whether the run is over."""
            return time >= end or source.over(time, output)

    return Limited()


def _calibration(name: str, robot: Robot, options: dict[str, Any], where: str, kind: str) -> Calibration:
    if options["calibration"] is not None:
        found = calibration_of(robot, options["calibration"])
        kinds = [bus.kind for bus in found.buses]
        if kind and kind not in kinds:
            bus_commands(kind)
            raise InputError(
                f"--bus emulated:{kind}: {options['calibration']} is for {', '.join(kinds)}; give --bus emulated"
            )
    elif where == _REAL:
        raise InputError("a real robot needs its calibration: --calibration FILE; tarsus bring-up makes one")
    else:
        # Where the first servo is unknown or does not measure its position, bus servos are emulated: they show more.
        usual = usual_bus(robot.servos[0][0])
        found = nominal_calibration(robot, name, kind=kind or (usual.name if usual.feedback else "feetech-sts"))
    if options["port"]:
        buses = (dataclasses.replace(found.buses[0], port=options["port"]), *found.buses[1:])
        found = found.replace(buses=buses)
    return found


def _scenario(options: dict[str, Any]) -> Scenario:
    if options["keys"] or options["gamepad"] or options["studio"]:
        return Scenario()
    return timeline_of(options["scenario"] or _DEMO, None)


def _source(
    plant: Plant,
    scenario: Scenario,
    options: dict[str, Any],
    stack: contextlib.ExitStack,
    line: StatusLine,
) -> CommandSource:
    device: InputDevice
    if options["keys"]:
        device = stack.enter_context(Keyboard())
        line.say("  ".join(f"{key if key != ' ' else 'space'}: {text}" for key, (_, text) in KEYS.items()))
    elif options["gamepad"]:
        device = stack.enter_context(Gamepad(options["gamepad"]))
    else:
        return scenario_commands(scenario, plant)
    return LiveCommands(device, speeds=_SPEEDS)


def _simulated(robot: Robot, options: dict[str, Any], *, out: Path | None) -> dict[str, Any]:
    """Run in physics, as fast as the computer simulates it."""
    from tarsus.simulation.simulated_plant import SimulatedPlant

    if options["keys"] or options["gamepad"] or options["studio"]:
        raise InputError("physics does not run in real time: use --bus emulated with --keys, --gamepad or --studio")
    scenario = _scenario(options)
    start = None if options["start"] is None else RobotState(options["start"])
    controller, plant = scenario_controller(scenario, robot, start=start), SimulatedPlant(robot)
    source: CommandSource = scenario_commands(scenario, plant)
    if options["start"] == "lying":
        source = Rising(source)
    most = f"{_FASTEST:g} Hz in physics, whose steps are 2 ms"
    rate = _within(options["rate"] or scenario.rate, _SLOWEST, _FASTEST, most)
    with StatusLine(quiet=True) as line:
        outcome = _run(controller, plant, source, rate, options["duration"], line)
    return _summary(robot, "simulated", None, outcome, line, out)


def _summary(
    robot: Robot,
    bus: str,
    plant: ServoPlant | None,
    outcome: _Outcome,
    line: StatusLine,
    out: Path | None,
    *,
    logged: bool = False,
) -> dict[str, Any]:
    from tarsus.cli.run.figures import write_figures

    recording, fault = outcome.recording, outcome.fault
    problems = [str(fault)] if fault else list(recording.problems if recording else ())
    if plant is not None:
        problems += [note for note in plant.notes if fault is None]
    timing = None if plant is None else line.timing
    way = None if recording is None else np.asarray(recording.motion.body.position)[:, :2]
    return {
        "robot": robot.name,
        "bus": bus,
        "possible": not problems and not outcome.interrupted,
        "interrupted": outcome.interrupted,
        "problems": problems,
        "duration_s": line.duration if recording is None else recording.motion.duration,
        "distance_mm": None if way is None else float(np.hypot(*(way[-1] - way[0]))) * 1000,
        "timing": timing and _milliseconds(timing),
        "tracking_deg": line.tracking,
        "voltage_v": line.lowest_voltage,
        "fault": None if plant is None or plant.fault is None else str(plant.fault.kind),
        "joint": None if plant is None or plant.fault is None else plant.fault.joint,
        "notes": [] if plant is None else [*plant.notes],
        "files": [] if out is None else [str(file) for file in write_figures(robot, recording, logged, out)],
    }


def _milliseconds(timing: Timing) -> dict[str, Any]:
    late = {"median_late_ms": timing.median * 1e3, "worst_late_ms": timing.worst * 1e3}
    return {"ticks": timing.ticks, "missed": timing.missed, "rate_hz": timing.rate, **late}
