"""Notices servos that are too hot or carry too much, and a failing supply."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from tarsus.hardware.bus.answers import Telemetry
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.plant.fault import FaultKind, ServoFault
from tarsus.hardware.plant.joint_map import Joint, JointMap
from tarsus.hardware.plant.settings import PlantSettings

__all__ = ["TelemetryMonitor", "least_voltage"]

# Alarms by the fault that they mean: a servo that reports one switches itself off.
_ALARMS = ((FaultKind.OVERHEATED, ("temperature", "overheating")), (FaultKind.OVERLOADED, ("overload",)))


def least_voltage(calibration: Calibration) -> float | None:
    """Return the voltage below which the servos must not run [V]; None where it is not known.

    Parameters
    ----------
    calibration : Calibration
        A calibration.
    """
    if calibration.supply is not None:
        return calibration.supply.least_voltage
    known = [servo.supply[0] for row in calibration.robot.servos for servo in row if servo is not None and servo.supply]
    return max(known, default=None)


class TelemetryMonitor:
    """Keeps what servos report, and notices what is beyond its bound.

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
    temperatures, voltages, currents, loads : array, shape (legs, 3)
        The last values; NaN where never measured [deg C, V, A, share of the full drive].
    """

    def __init__(self, calibration: Calibration, joints: JointMap, settings: PlantSettings) -> None:
        self._calibration, self._joints, self._settings = calibration, joints, settings
        shape = (calibration.robot.legs, 3)
        self._heavy_since = np.full(shape, np.nan)
        # Since when each servo, and each one that tells a voltage, has had too low a one.
        self._low_since, self._all_low_since = np.full(shape, np.inf), math.inf
        self.temperatures = np.full(shape, np.nan)
        self.voltages = np.full(shape, np.nan)
        self.currents = np.full(shape, np.nan)
        self.loads = np.full(shape, np.nan)

    @property
    def lowest_voltage(self) -> float | None:
        """The lowest voltage among the last that were measured [V]; None where none was."""
        return None if np.isnan(self.voltages).all() else float(np.nanmin(self.voltages))

    @property
    def speed_factor(self) -> float:
        """Share of the speed that the temperatures allow: 1, and less from `PlantSettings.warm` on."""
        settings = self._settings
        if np.isnan(self.temperatures).all():
            return 1.0
        hottest = float(np.nanmax(self.temperatures))
        share = (hottest - settings.warm) / (settings.hot - settings.warm)
        return 1.0 - 0.7 * min(max(share, 0.0), 1.0)

    def measured(self, bus: str, values: Mapping[int, Telemetry], *, now: float) -> ServoFault | None:
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
            fault = self._of_voltage(place, telemetry.voltage, now) or self._of_servo(place, telemetry, now)
            if fault is not None:
                return fault
        return None

    def _of_voltage(self, place: Joint, voltage: float | None, now: float) -> ServoFault | None:
        least, settings = least_voltage(self._calibration), self._settings
        if voltage is None or least is None:
            return None
        if voltage < least * settings.brown_out:
            text = f"the supply has {voltage:.1f} V, below {least * settings.brown_out:.1f} V"
            return ServoFault(kind=FaultKind.BROWN_OUT, text=f"{text}: a brown-out is suspected", time=now)
        if voltage >= least:
            self._low_since[place] = self._all_low_since = math.inf
            return None
        since = self._low_since[place] = min(float(self._low_since[place]), now)
        # Where voltages are read seldom, each time from another servo, it takes long until one is asked again.
        self._all_low_since = min(self._all_low_since, now)
        where = f" at the {self._calibration.joint_name(*place)}" if since < self._all_low_since else ""
        lasted = now - min(since, self._all_low_since)
        if lasted < settings.low_time:
            return None
        text = f"the supply has {voltage:.1f} V{where}, less than {least:.1f} V for {lasted:.1f} s"
        return ServoFault(kind=FaultKind.LOW_VOLTAGE, text=text, time=now)

    def _of_servo(self, place: Joint, telemetry: Telemetry, now: float) -> ServoFault | None:
        settings, temperature = self._settings, telemetry.temperature
        if temperature is not None and temperature >= settings.hot:
            text = f"{temperature:.0f} deg C, at most {settings.hot:.0f} deg C"
            return self._of_joint(FaultKind.OVERHEATED, place, text, now)
        for kind, alarms in _ALARMS:
            if any(name in alarms for name in telemetry.alarms):
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

    def _of_joint(self, kind: FaultKind, place: Joint, text: str, now: float) -> ServoFault:
        return ServoFault.of_joint(kind, self._calibration, place, text=text, time=now)
