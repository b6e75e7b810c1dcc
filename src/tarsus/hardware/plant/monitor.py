"""Notices faults: servos that don't answer, don't follow, are too hot or carry too much, and a failing supply."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Collection, Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from tarsus.errors import BusError, CorruptAnswerError
from tarsus.hardware.bus.protocol import Telemetry
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.plant.fault import FaultKind, ServoFault
from tarsus.hardware.plant.joint_map import Joint, JointMap
from tarsus.hardware.plant.settings import PlantSettings

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["ServoMonitor"]

# Of a whole bus with fewer servos than these nothing follows from their common silence.
_FEW = 3
_SAME = 1e-6
# Between two requests passes a tick; where more passes, nobody was asked [s].
_TICK = 0.03
# A servo whose alarm says so lets go by itself.
_HOT_ALARMS, _HEAVY_ALARMS = ("temperature", "overheating"), ("overload",)


class ServoMonitor:
    """Notices faults from answers, positions and telemetry.

    Parameters
    ----------
    calibration : Calibration
        A complete calibration.
    joints : JointMap
        Its joints.
    settings : PlantSettings
        The bounds.
    """

    def __init__(self, calibration: Calibration, joints: JointMap, settings: PlantSettings) -> None:
        self._calibration, self._joints, self._settings = calibration, joints, settings
        shape = (calibration.robot.legs, 3)
        self._failures = np.zeros(shape, dtype=int)
        self._failing_since = np.full(shape, np.nan)
        self._answered = np.full(shape, np.nan)
        self._history: deque[tuple[float, Float[np.ndarray, "legs 3"], Float[np.ndarray, "legs 3"]]] = deque(maxlen=200)
        self._behind_since = np.full(shape, np.nan)
        self._heavy_since = np.full(shape, np.nan)
        self._low_since: float | None = None
        # On a computer that is late itself, what is late to answer is not silent yet [s].
        self.grace = 0.0
        self.temperatures = np.full(shape, np.nan)
        self.voltages = np.full(shape, np.nan)
        self.currents = np.full(shape, np.nan)
        self.loads = np.full(shape, np.nan)

    @property
    def least_voltage(self) -> float | None:
        """Voltage below which the servos must not run [V]; None where unknown."""
        if self._calibration.supply is not None:
            return self._calibration.supply.least_voltage
        known = [s.supply[0] for row in self._calibration.robot.servos for s in row if s is not None and s.supply]
        return max(known) if known else None

    @property
    def lowest_voltage(self) -> float | None:
        """The lowest voltage among the last that were measured [V]; None where none was."""
        return None if np.isnan(self.voltages).all() else float(np.nanmin(self.voltages))

    def answered(
        self, bus: str, asked: Collection[int], answered: Collection[int], errors: Iterable[BusError], now: float
    ) -> ServoFault | None:
        """Take note of who answered, and return a fault.

        Parameters
        ----------
        bus : str
            Name of the bus.
        asked, answered : collection of int
            Who was asked, and who gave a valid answer.
        errors : iterable of BusError
            Why the others did not.
        now : float
            The time [s].
        """
        for number in answered:
            place = self._joints.joint(bus, number)
            self._failures[place], self._failing_since[place], self._answered[place] = 0, math.nan, now
        if not asked or len(answered) == len(asked):
            return None
        for error in errors:
            if error.id is not None and error.id in asked:
                fault = self._failed(bus, error.id, error, now)
                if fault is not None:
                    common = not answered and len(asked) > _FEW and fault.kind is FaultKind.NO_ANSWER
                    return self._all_silent(bus, len(asked), now) if common else fault
        return None

    def _failed(self, bus: str, number: int, error: BusError, now: float) -> ServoFault | None:
        place, settings = self._joints.joint(bus, number), self._settings
        self._failures[place] += 1
        if self._failures[place] == 1:
            self._failing_since[place] = now
        doubted = now - float(self._failing_since[place])
        since = now - _began(float(self._answered[place]), float(self._failing_since[place]))
        if (
            self._failures[place] < settings.least_failures
            or doubted < settings.least_doubt
            or since < settings.silence + self.grace
        ):
            return None
        kind = FaultKind.CORRUPT if isinstance(error, CorruptAnswerError) else FaultKind.NO_ANSWER
        number_of = int(self._failures[place])
        text = f"{number_of} answers in a row failed, none for {since * 1e3:.0f} ms: {error.received}"
        return self._of_joint(kind, place, text, now)

    def _all_silent(self, bus: str, number: int, now: float) -> ServoFault:
        lowest = self.lowest_voltage
        voltage = "" if lowest is None else f", last voltage {lowest:.1f} V"
        text = (
            f"all {number} servos on {bus} fell silent at once{voltage}: the supply has broken down, or the data line "
            "is cut"
        )
        return ServoFault(kind=FaultKind.BROWN_OUT, text=text, time=now)

    def followed(
        self, sent: Float[np.ndarray, "legs 3"], measured: Float[np.ndarray, "legs 3"], now: float
    ) -> ServoFault | None:
        """Compare what was sent with what was measured, and return a fault.

        Parameters
        ----------
        sent, measured : array, shape (legs, 3)
            Joint angles; NaN where nothing was measured [rad].
        now : float
            The time [s].
        """
        settings, history = self._settings, self._history
        history.append((now, sent, measured))
        delayed = self._at(now - settings.delay)
        if delayed is None:
            return None
        behind = np.abs(delayed[0] - measured)
        far = behind > settings.lag
        self._behind_since = np.where(far, np.where(np.isnan(self._behind_since), now, self._behind_since), np.nan)
        late = far & (now - self._behind_since >= settings.stuck_window)
        stuck = self._stuck(delayed[0], measured, behind, now) | late
        if not stuck.any():
            return None
        place = self._worst(np.where(stuck, behind, -1.0))
        text = (
            f"it is {math.degrees(behind[place]):.1f} deg behind its command, at {math.degrees(measured[place]):.1f} "
            f"deg, and does not follow within {(settings.delay + settings.stuck_window) * 1e3:.0f} ms"
        )
        return self._of_joint(FaultKind.STUCK, place, text, now)

    def _stuck(
        self,
        delayed: Float[np.ndarray, "legs 3"],
        measured: Float[np.ndarray, "legs 3"],
        behind: Float[np.ndarray, "legs 3"],
        now: float,
    ) -> Bool[np.ndarray, "legs 3"]:
        """Return which joints stand still although they were commanded to move."""
        settings = self._settings
        earlier = self._at(now - settings.stuck_window)
        before = self._at(now - settings.delay - settings.stuck_window)
        if earlier is None or before is None:
            return np.zeros_like(behind, dtype=bool)
        commanded, moved = np.abs(delayed - before[0]), np.abs(measured - earlier[1])
        angle = settings.stuck_angle
        return np.asarray((commanded >= angle) & (moved < 0.2 * commanded) & (behind >= angle))

    def _at(self, time: float) -> tuple[Float[np.ndarray, "legs 3"], Float[np.ndarray, "legs 3"]] | None:
        """Return what was sent and measured at a time; None where that is too long ago."""
        for at, sent, measured in reversed(self._history):
            if at <= time + _SAME:
                return sent, measured
        return None

    def forget_motion(self) -> None:
        """Begin anew with comparing motion, after a pause."""
        self._history.clear()
        self._behind_since[:] = math.nan

    def measured(self, bus: str, values: Mapping[int, Telemetry], now: float) -> ServoFault | None:
        """Take note of telemetry, and return a fault.

        Parameters
        ----------
        bus : str
            Name of the bus.
        values : mapping of int to Telemetry
            Telemetry by id.
        now : float
            The time [s].
        """
        for number, telemetry in values.items():
            place = self._joints.joint(bus, number)
            for array, value in (
                (self.temperatures, telemetry.temperature),
                (self.voltages, telemetry.voltage),
                (self.currents, telemetry.current),
                (self.loads, telemetry.load),
            ):
                if value is not None:
                    array[place] = value
            fault = self._of_voltage(telemetry.voltage, now) or self._of_servo(place, telemetry, now)
            if fault is not None:
                return fault
        return None

    def _of_voltage(self, voltage: float | None, now: float) -> ServoFault | None:
        least, settings = self.least_voltage, self._settings
        if voltage is None or least is None:
            return None
        if voltage < least * settings.brown_out:
            text = f"the supply has {voltage:.1f} V, below {least * settings.brown_out:.1f} V"
            return ServoFault(kind=FaultKind.BROWN_OUT, text=f"{text}: a brown-out is suspected", time=now)
        if voltage >= least:
            self._low_since = None
            return None
        self._low_since = now if self._low_since is None else self._low_since
        if now - self._low_since < settings.low_time:
            return None
        text = f"the supply has {voltage:.1f} V, less than {least:.1f} V for {now - self._low_since:.1f} s"
        return ServoFault(kind=FaultKind.LOW_VOLTAGE, text=text, time=now)

    def _of_servo(self, place: Joint, telemetry: Telemetry, now: float) -> ServoFault | None:
        settings, temperature = self._settings, telemetry.temperature
        if temperature is not None and temperature >= settings.hot:
            text = f"{temperature:.0f} deg C, at most {settings.hot:.0f} deg C"
            return self._of_joint(FaultKind.OVERHEATED, place, text, now)
        for kind, alarms in ((FaultKind.OVERHEATED, _HOT_ALARMS), (FaultKind.OVERLOADED, _HEAVY_ALARMS)):
            if any(alarm in alarms for alarm in telemetry.alarms):
                return self._of_joint(kind, place, f"the servo reports {', '.join(telemetry.alarms)}", now)
        if telemetry.load is None or abs(telemetry.load) < settings.heavy_load:
            self._heavy_since[place] = math.nan
            return None
        if math.isnan(self._heavy_since[place]):
            self._heavy_since[place] = now
        lasted = now - float(self._heavy_since[place])
        if lasted < settings.heavy_time:
            return None
        text = f"{abs(telemetry.load) * 100:.0f} % of its full drive for {lasted:.1f} s"
        return self._of_joint(FaultKind.OVERLOADED, place, text, now)

    @property
    def speed_factor(self) -> float:
        """Share of the speed that the temperatures allow: 1, and less from `PlantSettings.warm` on."""
        settings = self._settings
        if np.isnan(self.temperatures).all():
            return 1.0
        hottest = float(np.nanmax(self.temperatures))
        share = (hottest - settings.warm) / (settings.hot - settings.warm)
        return 1.0 - 0.7 * min(max(share, 0.0), 1.0)

    def _of_joint(self, kind: FaultKind, place: Joint, text: str, now: float) -> ServoFault:
        leg, j = place
        return ServoFault(kind=kind, text=text, joint=self._calibration.joint_name(leg, j), leg=leg, number=j, time=now)

    def _worst(self, values: Float[np.ndarray, "legs 3"]) -> Joint:
        leg, j = np.unravel_index(int(np.argmax(values)), values.shape)
        return int(leg), int(j)


def _began(answered: float, failed: float) -> float:
    """Return when silence began: at the last answer, unless nobody was asked for a while before the first failure."""
    return failed if math.isnan(answered) else max(answered, failed - _TICK)
