"""Reads positions and telemetry of servos, as many in a tick as the wire carries."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.errors import BusError, PortError
from tarsus.hardware.bus.answers import Telemetry
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.plant.joint_map import JointMap
from tarsus.hardware.plant.reading.position_turn import PositionTurn
from tarsus.hardware.plant.reading.telemetry_turn import TelemetryTurn
from tarsus.hardware.transport.clock import Clock

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["WHOLE", "Reading", "ServoReader"]

# Share of a tick that the wire may be busy, and the share of positions in what the goals leave of that time: on a slow
# line each servo then reports its position in one tick and its temperature in the next.
WHOLE, _POSITIONS = 0.925, 0.5
_SUSPECTED = 0.25
# How much longer a tick may last on a slow line, to retry servos that did not answer [s].
_DOUBT = 0.03


class Reading(NamedTuple):
    """An attempt to read positions or telemetry.

    Attributes
    ----------
    bus : str
        Name of the bus.
    asked, answered : collection of int
        Servos that were asked, and those that answered.
    errors : tuple of BusError
        Why the others did not.
    telemetry : mapping of int to Telemetry
        What servos reported of themselves, by id.
    """

    bus: str
    asked: Collection[int]
    answered: Collection[int]
    errors: tuple[BusError, ...]
    telemetry: Mapping[int, Telemetry] = MappingProxyType({})


class ServoReader:
    """Reads servos, and keeps what was read last.

    Parameters
    ----------
    buses : mapping of str to Bus
        The buses by name.
    joints : JointMap
        The joints.
    calibration : Calibration
        A complete calibration.
    clock : Clock
        The clock.

    Attributes
    ----------
    angles, speeds : array, shape (legs, 3)
        Joint angles and speeds as last measured; NaN where never [rad, rad/s].
    read : array of bool, shape (legs, 3)
        Which joints were measured when positions were read last.
    """

    def __init__(self, buses: Mapping[str, Bus], joints: JointMap, calibration: Calibration, clock: Clock) -> None:
        self._buses, self._joints, self._calibration, self._clock = buses, joints, calibration, clock
        shape = (calibration.robot.legs, 3)
        self.angles, self.speeds = np.full(shape, np.nan), np.full(shape, np.nan)
        self._times = np.full(shape, np.nan)
        self._turns = {
            name: PositionTurn(bus, joints.numbers(name))
            for name, bus in buses.items()
            if bus.capabilities.positions and joints.numbers(name)
        }
        self._telemetry = {
            name: TelemetryTurn(bus, joints.numbers(name), clock)
            for name, bus in buses.items()
            if bus.capabilities.telemetry and joints.numbers(name)
        }
        self.read = np.zeros(shape, dtype=bool)
        # Share of all servos whose positions a tick has time for.
        self._share = 1.0
        self._groups: dict[str, tuple[tuple[int, ...], ...]] = {}

    def all_positions(self) -> Float[np.ndarray, "legs 3"]:
        """Return the measured joint angles; NaN for joints whose bus does not measure them [rad].

        Raises
        ------
        BusError
            If a servo gives no valid answer, even when asked again.
        """
        for name, turn in self._turns.items():
            bus, numbers = self._buses[name], self._joints.numbers(name)
            found: dict[int, float] = {}
            start = self._clock.now()
            for last in (False, False, True):
                answers = bus.read_positions([number for number in numbers if number not in found])
                found |= answers.require() if last else answers.values
                if len(found) == len(numbers):
                    break
            longer = turn.took(len(numbers), self._clock.now() - start)
            if name in self._telemetry:
                self._telemetry[name].slower(longer)
            self._keep(name, found)
        return self.angles.copy()

    def plan(self, dt: float, *, writing: float) -> bool:
        """Choose the servos whose positions are read in a tick, and return whether telemetry is to be read first.

        On a slow line positions come last: by then servos have had most of the tick to follow their commands.

        Parameters
        ----------
        dt : float
            Duration of the tick [s].
        writing : float
            How long commands take on the wire [s].
        """
        whole = sum(turn.seconds for turn in self._turns.values())
        self._share = _POSITIONS * (WHOLE * dt - writing) / whole if whole else 1.0
        failing = any(turn.failed for turn in self._turns.values())
        self._groups = {name: turn.next(self._share) for name, turn in self._turns.items()}
        return self._share < 1.0 and not failing

    def positions(self, dt: float, *, begun: float) -> Iterator[Reading]:
        """Read positions, and yield each reading; on a slow line, retry within the tick where servos do not answer.

        Parameters
        ----------
        dt : float
            Duration of the tick [s].
        begun : float
            When it began [s].
        """
        self.read[:] = False
        groups, self._groups = self._groups, {}
        for name, chosen in groups.items():
            for numbers in chosen:
                yield self._read(name, numbers)
            yield from self._doubted(name, dt, begun)

    def again(self, which: Bool[np.ndarray, "legs 3"]) -> Iterator[Reading]:
        """Read some positions once more on a slow line, where the next look would come late, and yield each reading.

        Parameters
        ----------
        which : array of bool, shape (legs, 3)
            The joints.
        """
        self.read[:] = False
        for name in self._turns if self._share < 1.0 else ():
            numbers = tuple(number for number in self._joints.numbers(name) if which[self._joints.joint(name, number)])
            if numbers:
                yield self._read(name, numbers)

    def suspect(self, suspicion: Float[np.ndarray, "legs 3"]) -> None:
        """Look more often at joints that may be stuck, where not all are read in each tick.

        Parameters
        ----------
        suspicion : array, shape (legs, 3)
            How near each is to being taken for stuck, at 1; those above a quarter are suspected, the worst first.
        """
        for name, turn in self._turns.items():
            worst = {number: suspicion[self._joints.joint(name, number)] for number in self._joints.numbers(name)}
            numbers = sorted((number for number in worst if worst[number] > _SUSPECTED), key=lambda n: -worst[n])
            turn.suspect(numbers)
            if name in self._telemetry:
                self._telemetry[name].suspect(numbers)

    def telemetry(self, dt: float, *, begun: float) -> Iterator[Reading]:
        """Read the telemetry of as many servos as the tick has time for, and yield each reading.

        Servos that report an alarm with their position come first. On a slow line where each value takes a request, a
        servo that does not answer, while others do, is asked for its position at once.

        Parameters
        ----------
        dt : float
            Duration of the tick [s].
        begun : float
            When it began [s].
        """
        for name, turn in self._telemetry.items():
            positions = self._turns.get(name)
            beside = () if positions is None else positions.last
            left = begun + WHOLE * dt - self._clock.now() - self._coming
            try:
                for asked, answers in turn.read(dt, left=left, beside=beside):
                    if positions is None or not turn.separate:
                        # Whether a servo answers is judged by its positions alone.
                        yield Reading(name, (), (), (), answers.values)
                        continue
                    positions.asked(asked, answers.values)
                    yield Reading(name, asked, answers.values.keys(), answers.errors, answers.values)
                    if answers.values:
                        yield from self._doubted(name, dt, begun)
            except PortError:
                raise
            except BusError:
                continue

    @property
    def _coming(self) -> float:
        """How long it takes to read the positions that are planned and not read yet [s]."""
        return sum(self._turns[name].share(sum(map(len, chosen))) for name, chosen in self._groups.items())

    @property
    def times(self) -> Float[np.ndarray, "legs 3"]:
        """When each joint was measured last; NaN where never [s]."""
        return self._times.copy()

    @property
    def ages(self) -> Float[np.ndarray, "legs 3"]:
        """Time since each joint was measured last; NaN where never [s]."""
        return np.maximum(self._clock.now() - self._times, 0.0)

    def _doubted(self, name: str, dt: float, begun: float) -> Iterator[Reading]:
        """Retry servos that did not answer, on a slow line, where the next tick would come too late for that."""
        turn = self._turns[name]
        while self._share < 1.0 and turn.failed and self._clock.now() - begun < WHOLE * dt + _DOUBT:
            yield self._read(name, turn.failed)

    def _read(self, bus: str, numbers: tuple[int, ...]) -> Reading:
        turn, start = self._turns[bus], self._clock.now()
        answers = self._buses[bus].read_positions(numbers)
        turn.asked(numbers, answers.values)
        if not answers.errors:
            turn.took(len(numbers), self._clock.now() - start)
        self._keep(bus, answers.values)
        if bus in self._telemetry:
            self._telemetry[bus].alarmed(answers.alarms)
        return Reading(bus, numbers, answers.values.keys(), answers.errors)

    def _keep(self, bus: str, values: Mapping[int, float]) -> None:
        now = self._clock.now()
        zeros, slopes = self._calibration.zeros, self._calibration.slopes
        for number, value in values.items():
            place = self._joints.joint(bus, number)
            angle = (value - zeros[place]) / slopes[place]
            passed = now - self._times[place]
            if passed > 0:
                self.speeds[place] = (angle - self.angles[place]) / passed
            self.angles[place], self._times[place], self.read[place] = angle, now, True
