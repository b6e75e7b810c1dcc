"""Notices servos that do not answer, or whose answers are damaged."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable

import numpy as np

from tarsus.errors import BusError, CorruptAnswerError
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.plant.fault import FaultKind, ServoFault
from tarsus.hardware.plant.joint_map import JointMap
from tarsus.hardware.plant.settings import PlantSettings

__all__ = ["AnswerMonitor"]

# The common silence of no more servos than this says nothing about the whole bus.
_FEW = 3
# Least delay of the computer that a fault mentions, and time between requests as long as no tick is known [s].
_TICK = 0.03


class AnswerMonitor:
    """Notices silence and damaged answers.

    Time in which the computer did not run this program, because others kept it busy, does not count as a servo's
    silence.

    Parameters
    ----------
    calibration : Calibration
        A complete calibration.
    joints : JointMap
        Its joints.
    settings : PlantSettings
        The bounds.

    Attributes
    ----------
    grace : float
        How much longer a servo may be silent because the computer itself is late [s].
    interval : float
        Time between two requests to a servo; silence before its first failure counts for no longer than this [s].
    """

    def __init__(self, calibration: Calibration, joints: JointMap, settings: PlantSettings) -> None:
        self._calibration, self._joints, self._settings = calibration, joints, settings
        shape = (calibration.robot.legs, 3)
        self._failures = np.zeros(shape, dtype=int)
        self._failing_since = np.full(shape, np.nan)
        self._answered = np.full(shape, np.nan)
        self._late = np.zeros(shape)
        self.grace, self.interval = 0.0, _TICK

    def answered(
        self,
        bus: str,
        asked: Collection[int],
        *,
        answered: Collection[int],
        errors: Iterable[BusError],
        now: float,
        voltage: float | None = None,
    ) -> ServoFault | None:
        """Take note of who answered, and return a fault.

        Parameters
        ----------
        bus : str
            Name of the bus.
        asked, answered : collection of int
            Servos that were asked, and those that gave a valid answer.
        errors : iterable of BusError
            Why the others did not.
        now : float
            The time [s].
        voltage : float, optional
            The last voltage of the supply that was measured, for messages [V].
        """
        for number in answered:
            place = self._joints.joint(bus, number)
            self._failures[place], self._failing_since[place], self._answered[place] = 0, math.nan, now
            self._late[place] = 0.0
        if not asked or len(answered) == len(asked):
            return None
        for error in errors:
            if error.id is not None and error.id in asked:
                fault = self._failed(bus, error.id, error, now)
                if fault is not None:
                    common = not answered and len(asked) > _FEW and fault.kind is FaultKind.NO_ANSWER
                    return _all_silent(bus, len(asked), voltage, now) if common else fault
        return None

    def _failed(self, bus: str, number: int, error: BusError, now: float) -> ServoFault | None:
        place, settings = self._joints.joint(bus, number), self._settings
        self._failures[place] += 1
        self._late[place] += error.late
        if self._failures[place] == 1:
            self._failing_since[place] = now
        late = float(self._late[place])
        doubted = now - float(self._failing_since[place])
        answered, failing = float(self._answered[place]), float(self._failing_since[place])
        # Silence began at the last answer, unless the servo was not asked for a while before its first failure.
        since = now - (failing if math.isnan(answered) else max(answered, failing - self.interval)) - late
        if (
            self._failures[place] < settings.least_failures
            or doubted < settings.least_doubt
            or since < settings.silence + self.grace
        ):
            return None
        kind = FaultKind.CORRUPT if isinstance(error, CorruptAnswerError) else FaultKind.NO_ANSWER
        number_of = int(self._failures[place])
        beside = f", beside {late * 1e3:.0f} ms in which this computer did not run" if late >= _TICK else ""
        text = f"{number_of} answers in a row failed, none for {since * 1e3:.0f} ms{beside}: {error.received}"
        return ServoFault.of_joint(kind, self._calibration, place, text=text, time=now)


def _all_silent(bus: str, number: int, voltage: float | None, now: float) -> ServoFault:
    last = "" if voltage is None else f", last voltage {voltage:.1f} V"
    text = (
        f"all {number} servos on {bus} fell silent at once{last}: the supply has broken down, or the data line is cut"
    )
    return ServoFault(kind=FaultKind.BROWN_OUT, text=text, time=now)
