"""Finds which input of a board belongs to which foot, and its level on the ground: each foot is pressed by hand."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from statistics import median

from tarsus.errors import BusError, CalibrationError, PortError
from tarsus.hardware.bringup.bench import Bench
from tarsus.hardware.bringup.connection import Connection
from tarsus.hardware.bringup.dialogue import Topic
from tarsus.hardware.bringup.progress import Progress
from tarsus.hardware.bus.inputs import InputBoard
from tarsus.hardware.calibration.parts import BusSettings, FootSwitches

__all__ = ["board_of_inputs", "find_foot_switches"]

_TITLE = "Foot switches"
# A level is the median of this many readings.
_READINGS = 5
# Least change of a pressed foot's level, as a share of the highest level; greatest other change, as a share of it.
_CHANGE, _OTHERS = 0.1, 0.5
# The levels of a switch are below the first and above the second share; otherwise it is a force sensor.
_LOW, _HIGH = 0.25, 0.75
# Hysteresis as a share of the smallest change, and at most [V].
_SHARE, _MOST = 0.3, 0.2

Levels = Mapping[int, float]


def board_of_inputs(progress: Progress) -> BusSettings | None:
    """Return the bus whose board has inputs for foot switches; None without one.

    Parameters
    ----------
    progress : Progress
        The calibration so far.
    """
    buses = progress.calibration.buses
    switches = progress.calibration.foot_switches
    if switches is not None:
        return next(bus for bus in buses if bus.name == switches.bus)
    return next((bus for bus in buses if bus.properties.inputs), None)


def find_foot_switches(progress: Progress, connection: Connection, bench: Bench, *, settings: BusSettings) -> None:
    """Ask to press one foot after the other, and keep which input changes, and which way.

    Feet whose input is known are not asked for again.

    Parameters
    ----------
    progress : Progress
        The calibration so far.
    connection : Connection
        Knows the boards.
    bench : Bench
        The servos.
    settings : BusSettings
        The bus whose board has the inputs.
    """
    ask, robot = progress.ask, progress.calibration.robot
    board = connection.board(bench, settings)
    if not isinstance(board, InputBoard):
        return
    known = progress.calibration.foot_switches
    todo = [leg for leg in range(robot.legs) if known is None or known.inputs[leg] is None]
    if not todo:
        return
    options = {"": "no" if known is None else "no others", "y": "yes"}
    which = "foot switches" if known is None else f"more foot switches than the {robot.legs - len(todo)} that are known"
    question = f"Does the robot have {which}, on inputs of {settings.properties.text}?"
    if ask.choose(question, options, topic=Topic(title=_TITLE)) != "y":
        return
    bench.release(None)
    ask.choose("Lift all feet off everything.", {"": "nothing touches them"}, topic=Topic(title=_TITLE))
    free = _levels(progress, board, settings)
    if not free:
        ask.say("no input can be read; see the board's inputs in its documentation")
        return
    for leg in todo:
        _press(progress, board, settings, leg=leg, free=free)


def _press(progress: Progress, board: InputBoard, settings: BusSettings, *, leg: int, free: Levels) -> None:
    """Ask to press a foot until its input is known, or it has none."""
    ask, name = progress.ask, progress.calibration.robot.leg_names[leg]
    topic = Topic(title=_TITLE, leg=leg, pose="pressed")
    options = {"": "it is pressed", "n": "it has no switch"}
    while ask.choose(f"Press the {name} foot, and hold it.", options, topic=topic) != "n":
        pressed = _levels(progress, board, settings)
        changes = {number: pressed[number] - free[number] for number in free if number in pressed}
        order = sorted(changes, key=lambda number: -abs(changes[number]))
        if not order or abs(changes[order[0]]) < _CHANGE:
            ask.say(f"no input changed: {_listed(pressed)}. Press harder, or look at its cable and resistor.")
        elif len(order) > 1 and abs(changes[order[1]]) > _OTHERS * abs(changes[order[0]]):
            ask.say(f"inputs {order[0]} and {order[1]} changed both; press this foot alone")
        elif _keep(progress, settings, leg, order[0], free=free[order[0]], pressed=pressed[order[0]]):
            return


def _keep(progress: Progress, settings: BusSettings, leg: int, number: int, *, free: float, pressed: float) -> bool:
    """Keep the input of a leg, unless it contradicts what is known; return whether it was kept."""
    ask, robot = progress.ask, progress.calibration.robot
    high = pressed > free
    known = progress.calibration.foot_switches
    if known is None:
        known = FootSwitches(bus=settings.name, inputs=(None,) * robot.legs, closed=high)
    if number in known.inputs:
        ask.say(f"input {number} is that of the {robot.leg_names[known.inputs.index(number)]} foot already")
        return False
    if high != known.closed:
        way, others = ("high", "low") if high else ("low", "high")
        ask.say(f"input {number} goes {way}, the others go {others}: connect all switches alike")
        return False
    inputs = tuple(number if at == leg else other for at, other in enumerate(known.inputs))
    found = dataclasses.replace(known, inputs=inputs)
    count, highest = settings.properties.analogue
    if number < count:
        found = _with_threshold(found, leg, highest, free=free, pressed=pressed)
    try:
        progress.keep(progress.calibration.replace(foot_switches=found))
    except CalibrationError as error:
        ask.say("; ".join(error.problems))
        return False
    volts = f", {free * highest:.2f} V free and {pressed * highest:.2f} V pressed" if number < count else ""
    ask.say(f"the {robot.leg_names[leg]} foot is input {number}{volts}")
    return True


def _with_threshold(switches: FootSwitches, leg: int, highest: float, *, free: float, pressed: float) -> FootSwitches:
    """Return the switches with a threshold for a leg where it has a force sensor."""
    low, high = sorted((free, pressed))
    if not switches.thresholds and low < _LOW and high > _HIGH:
        return switches
    thresholds = list(switches.thresholds or (highest / 2,) * len(switches.inputs))
    thresholds[leg] = round((low + high) / 2 * highest, 2)
    hysteresis = round(min(_SHARE * (high - low) * highest, _MOST, switches.hysteresis), 3)
    return dataclasses.replace(switches, thresholds=tuple(thresholds), hysteresis=hysteresis)


def _levels(progress: Progress, board: InputBoard, settings: BusSettings) -> Levels:
    """Return the levels of all inputs that can be read and are not channels of servos."""
    joints = progress.calibration.joints
    servos = {joint.number for row in joints for joint in row if joint.bus == settings.name}
    # Only a Maestro has channels that are inputs as well.
    taken = servos if settings.properties.name == "maestro" else set()
    found = {}
    for number in board.inputs:
        if number in taken:
            continue
        try:
            found[number] = median(board.read_inputs((number,))[0] for _ in range(_READINGS))
        except PortError:
            raise
        except BusError:
            # This channel is no input, or the board has fewer inputs.
            continue
    return found


def _listed(levels: Levels) -> str:
    return ", ".join(f"input {number} {level:.2f}" for number, level in levels.items())
