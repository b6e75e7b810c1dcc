"""Contradictions in a calibration: within itself, with the bus, or with the robot."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from tarsus.errors import InputError, nearest_name
from tarsus.hardware.calibration.bus_commands import BUS_COMMANDS, BusCommands
from tarsus.hardware.calibration.parts import BusSettings, FootSwitches, JointCalibration, SupplySettings
from tarsus.robot.robot import JOINTS, Robot

__all__ = ["Contradiction", "angle_range", "contradictions"]

# Pulse widths per degree are rounded numbers, so that the travel of a servo is met to 1 % only.
_TRAVEL_TOLERANCE = 1.01
_ROUNDING = 1e-9
# Channels of each PCA9685.
_CHANNELS = 16


class Contradiction(NamedTuple):
    """A contradiction in a calibration.

    Attributes
    ----------
    place : tuple of (str or int)
        Path in the calibration file: ``("legs", leg, "femur")`` or ``("buses", number)``.
    text : str
        What is wrong, the number and its bound.
    """

    place: tuple[str | int, ...]
    text: str


def contradictions(
    robot: Robot,
    buses: Sequence[BusSettings],
    joints: Sequence[Sequence[JointCalibration]],
    foot_switches: FootSwitches | None = None,
    supply: SupplySettings | None = None,
) -> list[Contradiction]:
    """Return all contradictions in the values of a calibration.

    Parameters
    ----------
    robot : Robot
        A single robot.
    buses : sequence of BusSettings
        The buses.
    joints : nested sequence of JointCalibration
        ``joints[leg][joint]``.
    foot_switches : FootSwitches, optional
        The foot switches.
    supply : SupplySettings, optional
        The supply.
    """
    found = list(_of_buses(buses))
    if supply is not None and not supply.least_voltage < supply.voltage:
        text = (
            f"the supply has {supply.voltage:g} V, and the servos must not run below {supply.least_voltage:g} V: "
            "least_v must be less than voltage_v"
        )
        found.append(Contradiction(("supply",), text))
    known = {bus.name: bus for bus in buses if bus.kind in BUS_COMMANDS}
    taken: dict[tuple[str, int], str] = {}
    for leg, row in enumerate(joints):
        for j, joint in enumerate(row):
            name = f"{robot.leg_names[leg]} {JOINTS[j]}"
            texts = list(_of_joint(robot, leg, j, joint, known))
            if joint.number is not None:
                other = taken.setdefault((joint.bus, joint.number), name)
                if other != name:
                    texts.append(
                        f"{_key(known.get(joint.bus))} {joint.number} on bus {joint.bus!r} is that of {other} already"
                    )
            found += [Contradiction(("legs", leg, JOINTS[j]), f"{name}: {text}") for text in texts]
    if foot_switches is not None:
        found += [
            Contradiction(("sensors", "foot_switches"), text)
            for text in _of_switches(robot, foot_switches, known, joints)
        ]
    return found


def angle_range(joint: JointCalibration) -> tuple[float, float]:
    """Return the least and greatest joint angle within the limits of a joint's commands [rad].

    Parameters
    ----------
    joint : JointCalibration
        A joint of which all is known.
    """
    if joint.limits is None or joint.zero is None:
        raise InputError(f"the joint's {', '.join(joint.missing)} must be known")
    low, high = sorted((limit - joint.zero) / joint.slope for limit in joint.limits)
    return low, high


def _key(bus: BusSettings | None) -> str:
    return bus.properties.number_key if bus else "id"


def _of_buses(buses: Sequence[BusSettings]) -> Iterator[Contradiction]:
    names: set[str] = set()
    for number, bus in enumerate(buses):
        if bus.kind not in BUS_COMMANDS:
            nearest = nearest_name(bus.kind, BUS_COMMANDS)
            hint = f"; did you mean {nearest!r}?" if nearest else f"; there are: {', '.join(BUS_COMMANDS)}"
            yield Contradiction(("buses", number), f"bus {bus.name!r}: no kind of bus is called {bus.kind!r}{hint}")
        if bus.name in names:
            yield Contradiction(("buses", number), f"two buses are called {bus.name!r}; each needs a name of its own")
        names.add(bus.name)


def _of_joint(robot: Robot, leg: int, j: int, joint: JointCalibration, buses: dict[str, BusSettings]) -> Iterator[str]:
    """Yield what is wrong with one joint."""
    if joint.bus not in buses:
        yield f"there is no bus {joint.bus!r}; there are: {', '.join(buses) or 'none'}"
        return
    kind = buses[joint.bus].properties
    first, last = kind.numbers
    if buses[joint.bus].addresses:
        last = _CHANNELS * len(buses[joint.bus].addresses) - 1
    if joint.number is not None and not first <= joint.number <= last:
        yield f"{kind.number_key} is {joint.number}; on {kind.text} it is from {first} to {last}"
    if joint.direction not in (None, 1, -1):
        yield f"direction is {joint.direction}; it must be 1 or -1"
        return
    for key, value in (("zero", joint.zero), ("scale", joint.scale)):
        if value is not None and not (math.isfinite(value) and (key == "zero" or value > 0)):
            yield f"{key} is {value:g}; it must be a finite number{' greater than 0' * (key == 'scale')}"
            return
    limits = list(_of_limits(joint, kind))
    yield from limits
    if not limits:
        yield from _of_angles(robot, leg, j, joint, kind)


def _of_limits(joint: JointCalibration, kind: BusCommands) -> Iterator[str]:
    """Yield what is wrong with the limits of the commands."""
    if joint.limits is None:
        return
    low, high = joint.limits
    least, most = kind.commands
    if not low < high:
        yield f"limits are {low:g} and {high:g} {kind.unit}; the lower one comes first"
    elif not (least <= low and high <= most):
        yield f"limits are {low:g} to {high:g} {kind.unit}; {kind.text} can send {least:g} to {most:g}"


def _of_angles(robot: Robot, leg: int, j: int, joint: JointCalibration, kind: BusCommands) -> Iterator[str]:
    """Yield how a joint contradicts the robot's limits or the servo's travel."""
    own, servo = np.asarray(robot.limits)[leg, j], robot.servos[leg][j]
    if joint.limits is not None and joint.scale is not None and servo is not None and servo.travel is not None:
        swept = (joint.limits[1] - joint.limits[0]) / joint.scale
        if swept > servo.travel * _TRAVEL_TOLERANCE:
            yield (
                f"limits of {joint.limits[0]:g} to {joint.limits[1]:g} {kind.unit} are {math.degrees(swept):.4g} deg, "
                f"beyond the travel of the {servo.name}, {math.degrees(servo.travel):.4g} deg"
            )
    whole = not joint.missing
    if whole:
        low, high = angle_range(joint)
        if high < own[0] or low > own[1]:
            yield (
                f"its limits are {math.degrees(low):.4g} to {math.degrees(high):.4g} deg as joint angles, all of it "
                f"beyond those of the robot, {_degrees(own)} deg: zero or direction is wrong"
            )
            return
    if joint.soft_limits is None:
        return
    low, high = joint.soft_limits
    if not low < high:
        yield f"soft limits are {_degrees(joint.soft_limits)} deg; the lower one comes first"
    elif low < own[0] - _ROUNDING or high > own[1] + _ROUNDING:
        yield f"soft limits of {_degrees(joint.soft_limits)} deg are beyond those of the robot, {_degrees(own)} deg"
    elif whole:
        ends = angle_range(joint)
        if low < ends[0] - _ROUNDING or high > ends[1] + _ROUNDING:
            yield (
                f"soft limits of {_degrees(joint.soft_limits)} deg are beyond what the limits of the commands allow, "
                f"{_degrees(ends)} deg"
            )


def _of_switches(
    robot: Robot,
    switches: FootSwitches,
    buses: dict[str, BusSettings],
    joints: Sequence[Sequence[JointCalibration]],
) -> Iterator[str]:
    if len(switches.inputs) != robot.legs:
        yield f"foot switches: {len(switches.inputs)} inputs; the robot has {robot.legs} legs"
    used = [number for number in switches.inputs if number is not None]
    if len(set(used)) < len(used):
        yield "foot switches: two legs have the same input"
    if switches.bus not in buses:
        yield f"foot switches: there is no bus {switches.bus!r}; there are: {', '.join(buses) or 'none'}"
        return
    kind = buses[switches.bus].properties
    if not kind.inputs:
        able = ", ".join(name for name, one in BUS_COMMANDS.items() if one.inputs)
        yield (
            f"foot switches: a {kind.name} bus has no inputs; connect them to a board of the kind {able}, as a second "
            "bus if need be"
        )
        return
    channels = {joint.number for row in joints for joint in row if joint.bus == switches.bus} - {None}
    for number in used:
        if number >= kind.inputs:
            yield f"foot switches: {kind.name} has no input {number}; inputs are 0 to {kind.inputs - 1}"
        elif kind.name == "maestro" and number in channels:
            yield f"foot switches: channel {number} is that of a servo; a Maestro's channel is a servo's or an input"
    if switches.thresholds:
        yield from _of_thresholds(robot, switches, kind)


def _of_thresholds(robot: Robot, switches: FootSwitches, kind: BusCommands) -> Iterator[str]:
    """Yield what is wrong with the thresholds of inputs."""
    if len(switches.thresholds) != robot.legs:
        yield f"foot switches: {len(switches.thresholds)} thresholds; the robot has {robot.legs} legs"
        return
    count, highest = kind.analogue
    margin = switches.hysteresis / 2
    for name, number, threshold in zip(robot.leg_names, switches.inputs, switches.thresholds, strict=False):
        if number is None:
            continue
        if number >= count:
            able = f"inputs 0 to {count - 1} measure a voltage" if count else "none measures a voltage"
            yield f"foot switches: input {number} of {kind.text} tells high or low and has no threshold; {able}"
        elif not margin < threshold < highest - margin:
            yield (
                f"foot switches: the threshold of the {name} leg is {threshold:g} V; with a hysteresis of "
                f"{switches.hysteresis:g} V it must be between {margin:g} and {highest - margin:g} V, as {kind.text} "
                f"measures 0 to {highest:g} V"
            )


def _degrees(pair: Sequence[float]) -> str:
    return f"{math.degrees(pair[0]):.4g} to {math.degrees(pair[1]):.4g}"
