"""What comes in from servos and sensors: positions, telemetry, contacts, attitude, and the faults that they show."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.control.readings import SensorReadings
from tarsus.errors import BusError
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.plant.fault import ServoFault
from tarsus.hardware.plant.joint_map import JointMap
from tarsus.hardware.plant.monitor.answer_monitor import AnswerMonitor
from tarsus.hardware.plant.monitor.motion_monitor import MotionMonitor
from tarsus.hardware.plant.monitor.telemetry_monitor import TelemetryMonitor
from tarsus.hardware.plant.reading.foot_contacts import FootContacts
from tarsus.hardware.plant.reading.reader import Reading, ServoReader
from tarsus.hardware.plant.settings import PlantSettings
from tarsus.hardware.plant.tick_record import TickRecord
from tarsus.hardware.sensors.attitude_line import AttitudeLine
from tarsus.hardware.transport.clock import Clock

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["ServoInput"]

# How much longer servos may be silent per second by which ticks begin later than usual, and the usual lateness [s].
_GRACE, _USUAL = 3.0, 0.005
# Time between two requests to a servo: at least [s], and in ticks, as it is asked early in some and late in others.
_INTERVAL, _VARYING = 0.03, 1.3


class ServoInput:
    """Measures, and judges what is measured.

    Parameters
    ----------
    calibration : Calibration
        A complete calibration.
    buses : mapping of str to Bus
        The buses by name.
    joints : JointMap
        The joints.
    settings : PlantSettings
        Bounds.
    imu : AttitudeLine or None
        The inertial sensor.
    clock : Clock
        The clock.

    Attributes
    ----------
    telemetry : TelemetryMonitor
        What servos reported last.
    complete : bool
        Whether all servos that were asked in the last tick have answered.
    notes : list of str
        What is no longer measured, a line each.
    """

    def __init__(
        self,
        calibration: Calibration,
        buses: Mapping[str, Bus],
        joints: JointMap,
        *,
        settings: PlantSettings,
        imu: AttitudeLine | None,
        clock: Clock,
    ) -> None:
        self._reader = ServoReader(buses, joints, calibration, clock)
        self._answers = AnswerMonitor(calibration, joints, settings)
        self._motion = MotionMonitor(calibration, settings)
        self.telemetry = TelemetryMonitor(calibration, joints, settings)
        switches = calibration.foot_switches
        self._feet = None if switches is None else FootContacts(switches, buses[switches.bus], clock)
        self._imu, self._clock = imu, clock
        self.complete, self._troubled = True, False
        self.notes: list[str] = []

    @property
    def angles(self) -> Float[np.ndarray, "legs 3"]:
        """Joint angles as last measured; NaN where never [rad]."""
        return self._reader.angles.copy()

    def all_positions(self) -> Float[np.ndarray, "legs 3"]:
        """Return the measured joint angles; NaN for joints whose bus does not measure them [rad].

        Raises
        ------
        BusError
            If a servo gives no valid answer, even when asked again.
        """
        return self._reader.all_positions()

    def forget_motion(self) -> None:
        """Restart the comparison of motion with commands, after a pause."""
        self._motion.forget()

    def measure(
        self, sent: Float[np.ndarray, "legs 3"], dt: float, *, begun: float, writing: float, late: float
    ) -> ServoFault | None:
        """Read positions and some telemetry, and return the first fault.

        Parameters
        ----------
        sent : array, shape (legs, 3)
            Joint angles of the last commands [rad].
        dt : float
            Duration of the tick [s].
        begun, writing : float
            When it began, and how long commands took on the wire [s].
        late : float
            How late recent ticks began [s].

        Raises
        ------
        PortError
            If a port is gone.
        """
        reader = self._reader
        if self.complete:
            self._answers.grace = _GRACE * max(0.0, late - _USUAL)
        self.complete = True
        self._answers.interval = max(_INTERVAL, _VARYING * dt)
        first, found, left = reader.plan(dt, writing=writing), None, begun + writing
        if first:
            found = self._judged(reader.telemetry(dt, begun=begun - self.seconds))
        found = found or self._judged(reader.positions(dt, begun=begun)) or self._followed(sent, left)
        if found is None and self._motion.doubtful.any():
            found = self._judged(reader.again(self._motion.doubtful)) or self._followed(sent, left)
        reader.suspect(self._motion.suspicion)
        # While answers are missing the line is slow, and whether it recovers is more urgent than telemetry.
        if found is None and self.complete and not first:
            found = self._judged(reader.telemetry(dt, begun=begun - self.seconds))
        # Last, so that contacts are fresh.
        if found is None and self.complete and self._feet is not None:
            trouble = self._feet.read()
            if trouble and not self._troubled:
                self.notes.append(f"foot switches can't be read: {trouble}")
            self._troubled = self._troubled or bool(trouble)
        return found

    def _judged(self, readings: Iterable[Reading]) -> ServoFault | None:
        """Pass readings to the monitors until the first fault, and return it."""
        for reading in readings:
            self.complete = self.complete and not reading.errors
            fault = self._answers.answered(
                reading.bus,
                reading.asked,
                answered=reading.answered,
                errors=reading.errors,
                now=self._clock.now(),
                voltage=self.telemetry.lowest_voltage,
            ) or self.telemetry.measured(reading.bus, reading.telemetry, now=self._clock.now())
            if fault is not None:
                return fault
        return None

    def _followed(self, sent: Float[np.ndarray, "legs 3"], sent_at: float) -> ServoFault | None:
        """Compare what was read last with what was sent."""
        reader = self._reader
        if not reader.read.any():
            return None
        return self._motion.followed(
            sent,
            reader.angles.copy(),
            read=reader.read.copy(),
            now=self._clock.now(),
            times=reader.times,
            sent_at=sent_at,
        )

    def settle(self, dt: float, *, begun: float, writing: float) -> None:
        """Read positions, and judge nothing.

        Parameters
        ----------
        dt : float
            Duration of the tick [s].
        begun, writing : float
            When it began, and how long commands took on the wire [s].
        """
        self._reader.plan(dt, writing=writing)
        for _ in self._reader.positions(dt, begun=begun):
            pass

    @property
    def seconds(self) -> float:
        """How long the foot switches take on the wire in a tick [s]."""
        return 0.0 if self._feet is None else self._feet.seconds

    def readings(self, planned: Bool[np.ndarray, "legs"]) -> SensorReadings:
        """Return the last values of all channels that are known: of joints, those for which every joint was measured.

        Parameters
        ----------
        planned : array of bool, shape (legs,)
            Which feet should be on the ground.
        """
        reader, telemetry = self._reader, self.telemetry
        channels = {
            "joint_angles": reader.angles,
            "joint_speeds": reader.speeds,
            "temperatures": telemetry.temperatures,
            "voltages": telemetry.voltages,
            "currents": telemetry.currents,
        }
        known: dict[str, Any] = {name: array.copy() for name, array in channels.items() if not np.isnan(array).any()}
        joint_ages = reader.ages
        ages: dict[str, Any] = {name: joint_ages for name in ("joint_angles", "joint_speeds") if name in known}
        age = None if self._feet is None else self._feet.age
        if self._feet is not None and age is not None:
            known["contacts"], ages["contacts"] = self._feet.contacts(planned), age
        if self._imu is not None:
            known |= self._attitude(self._imu, ages)
        return SensorReadings(**known, age=ages)

    def record(
        self, now: float, *, asked: Float[np.ndarray, "..."], sent: Float[np.ndarray, "legs 3"], fault: str
    ) -> TickRecord:
        """Return the record of a tick.

        Parameters
        ----------
        now : float
            When it began [s].
        asked : array
            Joint angles that the controller gave, whatever they are [rad].
        sent : array, shape (legs, 3)
            Those of the commands that were sent [rad].
        fault : str
            What was noticed; empty without a fault.
        """
        telemetry = self.telemetry
        given = np.asarray(asked, dtype=float) if np.shape(asked) == sent.shape else np.full(sent.shape, np.nan)
        return TickRecord(
            time=now,
            asked=given,
            sent=sent,
            measured=self.angles,
            temperatures=telemetry.temperatures.copy(),
            voltage=telemetry.lowest_voltage,
            loads=telemetry.loads.copy(),
            fault=fault,
        )

    def _attitude(self, imu: AttitudeLine, ages: dict[str, Any]) -> dict[str, Any]:
        """Return the channel of the inertial sensor; without it the robot walks on, and is not levelled."""
        try:
            age = imu.read()
        except BusError as error:
            self.notes.append(f"the inertial sensor is gone: {error}")
            self._imu = None
            return {}
        if imu.attitude is None:
            return {}
        ages["attitude"] = age
        return {"attitude": imu.attitude}
