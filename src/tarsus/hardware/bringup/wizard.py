"""The steps of a bring-up, each of which can be left and resumed."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from tarsus.control.command import Command
from tarsus.control.loop.run import run
from tarsus.control.robot_controller import RobotController
from tarsus.errors import BusError, CalibrationError, CorruptAnswerError, PortError, TarsusError
from tarsus.hardware.bringup.bench import Bench
from tarsus.hardware.bringup.dialogue import Dialogue
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.calibration.blank import new_calibration
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.calibration.parts import BusSettings
from tarsus.hardware.plant.servo_plant import ServoPlant
from tarsus.hardware.transport.clock import Clock, SystemClock
from tarsus.robot.robot import JOINTS, Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["BringUp", "reference_angles"]

_Opener: TypeAlias = Callable[[BusSettings], Bus]
# A right angle between a level femur and the tibia can be checked with a set square.
_REFERENCE = (0.0, 0.0, math.radians(-90))
_MARGIN = math.radians(2)
_COARSE, _FINE = math.radians(3), math.radians(0.5)
# Ids beyond those that are needed, as makers deliver servos with others.
_SPARE = 12
_WALK, _WALK_TIME = (0.03, 0.0, 0.0), 4.0


def reference_angles(robot: Robot) -> Float[np.ndarray, "legs 3"]:
    """Return the pose in which zeros are set: femurs level, tibias vertical, as near as the limits allow [rad].

    Parameters
    ----------
    robot : Robot
        A single robot.
    """
    limits = np.asarray(robot.limits)
    return np.asarray(np.clip(np.tile(_REFERENCE, (robot.legs, 1)), limits[..., 0], limits[..., 1]))


class BringUp:
    """Finds out which servo is which joint, which way it turns, where its zero is and how far it may go.

    Parameters
    ----------
    calibration : Calibration
        As far as it is known.
    path : Path
        Where it is saved after every answer.
    dialogue : Dialogue
        Who answers.
    open_bus : callable
        Opens the bus of settings.
    ports : callable
        Returns the names of the ports that there are.
    clock : Clock, optional
        The machine's.
    """

    def __init__(
        self,
        calibration: Calibration,
        path: Path,
        dialogue: Dialogue,
        *,
        open_bus: _Opener,
        ports: Callable[[], tuple[str, ...]],
        clock: Clock | None = None,
    ) -> None:
        self.calibration, self._path, self._ask = calibration, path, dialogue
        self._open, self._ports = open_bus, ports
        self._clock: Clock = clock or SystemClock()
        self._bench: Bench | None = None
        robot = calibration.robot
        self._blank = new_calibration(robot, calibration.robot_file, kind=calibration.buses[0].kind)

    def perform(self) -> None:
        """Go through all steps that are not done yet.

        Raises
        ------
        Left
            If whoever answers goes away; all servos are released then.
        TarsusError
            If something can't be done, for example the file can't be written.
        """
        try:
            numbers = self._connected(self._find)
            for number in numbers:
                if number not in self._assigned():
                    self._connected(partial(self._identify, number))
            for leg in range(self.calibration.robot.legs):
                if any(joint.number is not None and joint.zero is None for joint in self.calibration.joints[leg]):
                    self._connected(partial(self._zeros, leg))
                self._connected(partial(self._limits, leg))
            self.calibration.require_complete()
            self._check_pose()
            self._walk()
        finally:
            self._disconnect()

    # Ports and servos.

    def _connected(self, step: Callable[[], Any]) -> list[int]:
        """Do a step; where the port is gone, ask for the cable and begin the step again."""
        while True:
            try:
                if self._bench is None:
                    self._bench = self._connect()
                found: list[int] = step() or []
                return found
            except PortError as error:
                self._disconnect()
                self._ask.say(str(error))
                self._ask.choose("Plug it in again.", {"": "go on"})
            except BusError as error:
                self._ask.say(str(error))
                self._ask.choose("Look at the cable and the supply.", {"": "try again"})

    def _disconnect(self) -> None:
        if self._bench is not None:
            self._bench.close()
            self._bench = None

    def _connect(self) -> Bench:
        settings = self.calibration.buses[0]
        if settings.port:
            return Bench(self._open(settings), self.calibration, self._clock)
        while True:
            for port in self._ports():
                found = dataclasses.replace(settings, port=port)
                try:
                    bus = self._open(found)
                except PortError:
                    continue
                if bus.capabilities.ping == "none" or bus.scan(self._range(bus)).values:
                    self._save(self.calibration.replace(buses=(found, *self.calibration.buses[1:])))
                    self._ask.say(f"servos answer on {port}")
                    return Bench(bus, self.calibration, self._clock)
                bus.close()
            names = ", ".join(self._ports()) or "none"
            self._ask.say(f"no servo answers; ports found: {names}. Check the USB cable and switch the servos on.")
            self._ask.choose("Search again?", {"": "yes"})

    def _range(self, bus: Bus) -> range:
        joints = self.calibration.robot.legs * len(JOINTS)
        ids = bus.capabilities.ids
        return range(ids.start, min(ids.start + joints + _SPARE, ids.stop))

    def _find(self) -> list[int]:
        """Return the servos; without enough of them, ask for the others."""
        assert self._bench is not None
        bus, needed = self._bench.bus, self.calibration.robot.legs * len(JOINTS)
        if bus.capabilities.ping != "servo":
            first = bus.capabilities.ids.start
            return list(range(first, min(first + needed + _SPARE, bus.capabilities.ids.stop)))
        while True:
            found = bus.scan(self._range(bus))
            numbers = sorted(found.values)
            twice = sorted({error.id for error in found.errors if error.id is not None and _damaged(error)})
            for number in twice:
                self._ask.say(f"id {number}: damaged answers. Two servos may have it: give one of them another id.")
            self._ask.say(f"{len(numbers)} of {needed} servos answer: {_listed(numbers)}")
            if len(numbers) >= needed:
                return numbers
            if self._ask.choose("Some are missing.", {"": "search again", "c": "continue without them"}) == "c":
                return numbers

    def _assigned(self) -> set[int]:
        return {joint.number for row in self.calibration.joints for joint in row if joint.number is not None}

    # Which joint, which way.

    def _identify(self, number: int) -> None:
        """Move one servo by a little, and ask what moved."""
        assert self._bench is not None
        key = self.calibration.kind(0, 0).number_key
        if len(self._assigned()) == self.calibration.robot.legs * len(JOINTS):
            return
        while True:
            self._ask.say(f"{key} {number} moves a little, and back.")
            self._bench.wiggle(number)
            legs = _legs_of(self.calibration.robot)
            answer = self._ask.choose("Which leg moved?", {**legs, "a": "move again", "n": "none"})
            if answer == "n":
                return
            if answer == "a":
                continue
            leg = int(answer) - 1
            joint = self._ask.choose("Which joint?", {"c": "coxa", "f": "femur", "t": "tibia", "b": "back"})
            if joint == "b":
                continue
            j = "cft".index(joint)
            other = self.calibration.joints[leg][j].number
            if other is not None:
                self._ask.say(f"that is {key} {other} already; look again, or start anew with another file")
                continue
            first, second, positive = self._ways(leg, j)
            way = self._ask.choose("Which way did it go first?", {first[0]: first, second[0]: second, "b": "back"})
            if way == "b":
                continue
            direction = positive if way == first[0] else -positive
            if self._try(leg, j, number=number, direction=direction):
                return

    def _ways(self, leg: int, j: int) -> tuple[str, str, int]:
        """Return the two ways a foot may go, and the sign of the first one."""
        if j > 0:
            return "up", "down", 1
        yaw = float(np.asarray(self.calibration.robot.mount_yaw)[leg])
        forward, left = -math.sin(yaw), math.cos(yaw)
        if abs(forward) >= abs(left) * 0.5:
            return "forward", "rearward", 1 if forward > 0 else -1
        return "left", "right", 1 if left > 0 else -1

    def _try(self, leg: int, j: int, **changes: object) -> bool:
        """Keep changes of a joint, unless they contradict what is known."""
        try:
            changed = self.calibration.with_joint(leg, j, **changes)
        except CalibrationError as error:
            self._ask.say("; ".join(error.problems))
            return False
        self._save(changed)
        return True

    def _save(self, changed: Calibration) -> None:
        changed.save(self._path)
        self.calibration = changed

    # Zeros and limits.

    def _zeros(self, leg: int) -> None:
        """Set the zeros of a leg that is held in the reference pose, or moved there by steps."""
        assert self._bench is not None
        name = self.calibration.robot.leg_names[leg]
        reference = reference_angles(self.calibration.robot)[leg]
        degrees = ", ".join(f"{joint} {math.degrees(a):.0f}" for joint, a in zip(JOINTS, reference, strict=True))
        self._ask.say(f"{name}: the reference pose is {degrees} deg: as in the drawing.")
        while not self._held(leg, name, reference):
            pass

    def _held(self, leg: int, name: str, reference: Float[np.ndarray, "3"]) -> bool:
        """Ask for the reference pose of a leg, and return whether its zeros can be."""
        assert self._bench is not None
        if self._bench.measures:
            self._bench.release([number for _, number in self._numbers(leg)])
            self._ask.choose(f"The {name} leg is limp: hold it in the reference pose.", {"": "it is"})
        for j, number in self._numbers(leg):
            if not self._bench.measures:
                self._step_to(number, f"{name} {JOINTS[j]}: move it to the reference pose")
            if not self._zero(leg, j, self._bench.position(number), float(reference[j])):
                wrong = self._ask.choose("That can't be.", {"": "hold the leg again", "d": "its direction is wrong"})
                if wrong == "d":
                    joint = self.calibration.joints[leg][j]
                    self._save(self.calibration.with_joint(leg, j, zero=None, direction=-(joint.direction or 1)))
                return False
        return True

    def _zero(self, leg: int, j: int, position: float, angle: float) -> bool:
        """Set the zero of a joint that is at an angle; return whether it can be."""
        joint = self.calibration.joints[leg][j]
        assert joint.direction is not None
        assert joint.scale is not None
        return self._try(leg, j, zero=round(position - joint.direction * joint.scale * angle, 1))

    def _numbers(self, leg: int) -> Iterator[tuple[int, int]]:
        for j, joint in enumerate(self.calibration.joints[leg]):
            if joint.number is not None:
                yield j, joint.number

    def _step_to(self, number: int, what: str) -> None:
        """Move a servo by small steps until whoever looks says so."""
        assert self._bench is not None
        self._bench.hold(number)
        scale = self.calibration.joints[0][0].scale or 0.0
        steps = {"+": _FINE, "-": -_FINE, "++": _COARSE, "--": -_COARSE}
        words = {key: f"{math.degrees(step):+.1f} deg" for key, step in steps.items()}
        while True:
            answer = self._ask.choose(f"{what}.", {"": "it is there", **words})
            if not answer:
                return
            self._bench.move(number, self._bench.position(number) + steps[answer] * scale)

    def _limits(self, leg: int) -> None:
        """Set the limits of a leg's joints by hand or by steps, unless they are set or those of the servo are kept."""
        assert self._bench is not None
        name = self.calibration.robot.leg_names[leg]
        todo = [(j, n) for j, n in self._numbers(leg) if self._untouched(leg, j)]
        if not todo:
            return
        if self._ask.choose(f"Limits of the {name} leg:", {"": "those of robot and servos", "h": "set them"}) != "h":
            return
        for j, number in todo:
            what = f"{name} {JOINTS[j]}"
            while True:
                ends = []
                for end in ("one end", "the other end"):
                    if self._bench.measures:
                        self._bench.release((number,))
                        self._ask.choose(f"{what}: move it by hand to {end}.", {"": "it is there"})
                    else:
                        self._step_to(number, f"{what}: move it to {end}")
                    ends.append(self._bench.position(number))
                low, high = sorted(ends)
                margin = _MARGIN * (self.calibration.joints[leg][j].scale or 0.0)
                if high - low <= 4 * margin:
                    self._ask.say(f"{what}: from {low:.0f} to {high:.0f} is no range; move it further")
                elif self._try(leg, j, limits=(math.ceil(low + margin), math.floor(high - margin))):
                    break

    def _untouched(self, leg: int, j: int) -> bool:
        return self.calibration.joints[leg][j].limits == self._blank.joints[leg][j].limits

    # The end.

    def _plant(self) -> ServoPlant:
        self._disconnect()
        buses = {settings.name: self._open(settings) for settings in self.calibration.buses}
        declared = None if self._blank.kind(0, 0).feedback else reference_angles(self.calibration.limited_robot)
        robot = self.calibration.limited_robot
        return ServoPlant(robot, self.calibration, buses=buses, declared=declared, clock=self._clock)

    def _check_pose(self) -> None:
        """Move all legs to the reference pose, and ask whether it looks like that."""
        while True:
            self._ask.choose("All legs go slowly to the reference pose; put the robot on a box, feet in the air.", _GO)
            plant = self._plant()
            robot = self.calibration.limited_robot
            try:
                output = RobotController(robot).output
                angles = reference_angles(robot)
                plant.start(dataclasses.replace(output, angles=angles, belly=True))
                answer = self._ask.choose("Does every leg look like the drawing?", {"": "yes", **_legs_of(robot)})
            except TarsusError as error:
                self._ask.say(str(error))
                answer = self._ask.choose("Which leg is wrong?", {"": "none: try again", **_legs_of(robot)})
                if not answer:
                    continue
            finally:
                plant.stop()
            if not answer:
                return
            leg = int(answer) - 1
            for j in range(len(JOINTS)):
                self._save(self.calibration.with_joint(leg, j, zero=None))
            self._connected(partial(self._zeros, leg))

    def _walk(self) -> None:
        """Walk slowly in the air."""
        if self._ask.choose("A slow walk in the air, feet free?", {"": "yes", "n": "no"}) == "n":
            return
        robot = self.calibration.limited_robot
        plant = self._plant()
        recording = run(RobotController(robot), plant, [(0.0, Command(twist=_WALK))], duration=_WALK_TIME)
        self._ask.say(
            f"it walked for {recording.motion.duration:.1f} s; {'; '.join(recording.problems) or 'no problems'}"
        )


_GO = {"": "go"}


def _legs_of(robot: Robot) -> dict[str, str]:
    """Return keys for the legs of a robot."""
    return {str(leg + 1): name for leg, name in enumerate(robot.leg_names)}


def _damaged(error: BusError) -> bool:
    return isinstance(error, CorruptAnswerError)


def _listed(numbers: list[int]) -> str:
    """Return numbers as ranges: ``1 to 5, 7``."""
    parts: list[list[int]] = []
    for number in numbers:
        if parts and parts[-1][-1] == number - 1:
            parts[-1].append(number)
        else:
            parts.append([number])
    return ", ".join(f"{part[0]} to {part[-1]}" if len(part) > 1 else str(part[0]) for part in parts) or "none"
