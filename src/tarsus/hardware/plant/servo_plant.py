"""A plant of real servos: starts slowly, keeps limits, notices faults, sits down before it lets go."""

from __future__ import annotations

import atexit
import math
from collections.abc import Callable, Mapping
from types import TracebackType
from typing import TYPE_CHECKING, Self

import numpy as np

from tarsus.control.control_output import ControlOutput
from tarsus.control.readings import SensorReadings
from tarsus.errors import BusError, InputError, PortError, TarsusError
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.bus.separate_telemetry import SeparateTelemetry
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.plant.fault import FaultKind, Reaction, ServoFault
from tarsus.hardware.plant.joint_map import JointMap
from tarsus.hardware.plant.pacer import Pacer, Timing
from tarsus.hardware.plant.ports import Ports
from tarsus.hardware.plant.reading.reader import WHOLE
from tarsus.hardware.plant.reading.servo_input import ServoInput
from tarsus.hardware.plant.servo_output import ServoOutput
from tarsus.hardware.plant.settings import PlantSettings
from tarsus.hardware.plant.sit_down import SITTING_TICK, sitting_angles
from tarsus.hardware.plant.soft_start import check_start, glide
from tarsus.hardware.plant.tick_record import TickRecord
from tarsus.hardware.sensors.attitude_line import AttitudeLine
from tarsus.hardware.transport.clock import Clock, SystemClock
from tarsus.representation import represented
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["ServoPlant"]

_START_TICK = 0.02
# Share of the greatest rate that leaves enough time for answers that are late now and then.
_RESERVED = 0.8
# Lateness of ticks that is assumed before any is measured [s].
_UNKNOWN = 0.02


@represented("robot", "calibration", "timing", "fault")
class ServoPlant:
    """Executes joint angles with servos: a `Plant`.

    Whatever angles come in, those sent are within the limits of the calibration, and no faster than the joints may
    move. A fault ends the run with `ServoFaultError`; `stop` then sits down before the servos are released, unless the
    servos can't move any more.

    Parameters
    ----------
    robot : Robot
        The robot of the calibration.
    calibration : Calibration
        A complete calibration.
    buses : mapping of str to Bus, optional
        The buses by their names in the calibration; opened from its ports where left out, and closed at the end.
    declared : array, shape (legs, 3), optional
        Joint angles at the start where positions are not measured [rad]; those with which the controller starts.
    settings : PlantSettings, optional
        Bounds.
    imu : AttitudeLine, optional
        The inertial sensor; that of the calibration where the plant opens the buses.
    clock : Clock, optional
        The machine's, unless emulated servos have one of their own.
    observer : callable, optional
        Takes a `TickRecord` for every tick, also of soft start and sitting down.

    Attributes
    ----------
    calibration : Calibration
        The calibration.
    fault : ServoFault or None
        What ended the run; None without a fault.
    notes : list of str
        What could not be done at the end, a line each.

    Raises
    ------
    CalibrationError
        If the calibration is not complete.
    InputError
        If it is for another robot, or a bus is missing.
    PortError
        If a port can't be opened.
    """

    def __init__(
        self,
        robot: Robot,
        calibration: Calibration,
        *,
        buses: Mapping[str, Bus] | None = None,
        declared: Float[np.ndarray, "legs 3"] | None = None,
        settings: PlantSettings | None = None,
        imu: AttitudeLine | None = None,
        clock: Clock | None = None,
        observer: Callable[[TickRecord], None] | None = None,
    ) -> None:
        calibration.require_complete()
        if robot.leg_names != calibration.robot.leg_names:
            raise InputError(f"the calibration is for {calibration.robot.name!r}; the robot is {robot.name!r}")
        self.robot, self.calibration = robot, calibration
        self.settings = settings or PlantSettings()
        self.fault: ServoFault | None = None
        self._declared = declared
        self._clock: Clock = clock or SystemClock()
        self._observer = observer
        joints = JointMap(calibration)
        self._pacer = Pacer(self._clock, recently_late=_UNKNOWN)
        self._belly = True
        self._ports = Ports(calibration, buses, imu, timeout=self.settings.timeout)
        opened = self._ports.buses
        self._rates = [bus.timing(joints.numbers(name)) for name, bus in opened.items()]
        self._servos = ServoOutput(calibration, opened, joints, self.settings, self._clock)
        self._input = ServoInput(
            calibration, opened, joints, settings=self.settings, imu=self._ports.imu, clock=self._clock
        )
        self.notes = self._input.notes
        # Torque ends with the program, however that ends; only a kill leaves it to the watchdog.
        atexit.register(self.release)

    def __enter__(self) -> Self:
        """Return the plant itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Stop, and close the ports."""
        self.stop()

    @property
    def timing(self) -> Timing:
        """How well the ticks were kept until now."""
        return self._pacer.timing

    @property
    def greatest_rate(self) -> float:
        """Ticks per second that the wires carry: goals of all servos, and positions of half of them [1/s]."""
        # Buses take their goals in parallel; positions are read from one bus after the other.
        reading = sum(each.positions for each in self._rates) / 2 + self._input.seconds
        return 1.0 / max(self._servos.writing + reading, 1e-6)

    @property
    def usual_rate(self) -> float:
        """Ticks per second at which every servo tells something in each tick, with a reserve for the computer [1/s]."""
        pairs = zip(self._rates, self._ports.buses.values(), strict=True)
        # Where each value takes a request, position and temperature take turns.
        values = sum(
            each.positions + each.telemetry / len(bus.capabilities.telemetry)
            for each, bus in pairs
            if isinstance(bus, SeparateTelemetry)
        )
        busy = self._servos.writing + values / 2 + self._input.seconds
        return min(_RESERVED * self.greatest_rate, WHOLE / max(busy, 1e-6))

    @property
    def speed_factor(self) -> float:
        """Share of the speed that the servos' temperatures allow."""
        return self._input.telemetry.speed_factor

    def start(self, output: ControlOutput) -> None:
        """Find the servos, switch them on where they are, and move them slowly to where the controller starts.

        Without measured positions the servos get their first pulses at the declared angles, leg by leg.

        Parameters
        ----------
        output : ControlOutput
            What the controller starts with.

        Raises
        ------
        NoAnswerError
            If servos are missing; the message names the joints.
        InputError
            If a joint is far beyond its limits, or an angle is not finite.
        PortError
            If a port is gone.
        """
        self._servos.find()
        measured = self._input.all_positions()
        known = ~np.isnan(measured)
        declared = output.angles if self._declared is None else np.asarray(self._declared, dtype=float)
        begin = np.where(known, measured, declared)
        check_start(self.calibration, begin, known)
        self._belly = output.belly
        try:
            self._servos.switch_on(begin, measured=bool(known.all()))
            for angles in glide(begin, output.angles, speed=self.settings.start_speed, dt=_START_TICK):
                self._tick(angles, _START_TICK)
        except BaseException:
            # A caller whose start failed does not call `stop`.
            self.release()
            raise
        self._input.forget_motion()
        self._pacer = Pacer(self._clock, recently_late=self._pacer.recently_late)

    def step(self, output: ControlOutput, dt: float) -> SensorReadings:
        """Send joint angles at the beginning of a tick, and return what is measured then.

        Parameters
        ----------
        output : ControlOutput
            What the controller gave out.
        dt : float
            Duration of the tick [s].

        Raises
        ------
        ServoFaultError
            If something fails; the message names the joint, what was measured, and what would help.
        InputError
            If the plant was not started, or the duration is not finite.
        """
        if not self._servos.powered:
            raise InputError("the servo plant has not been started; call start(output) before step(output, dt)")
        if not 0 < dt < math.inf:
            raise InputError(f"dt is {dt:g} s; it must be a finite number greater than 0")
        self._belly = output.belly
        self._tick(output.angles, dt)
        return self._input.readings(output.contacts)

    def stop(self) -> None:
        """Sit down if the robot stands and its servos allow it, then release all servos and close the ports.

        May be called more than once. An interrupt while the robot sits down releases the servos at once.
        """
        try:
            limp = self.fault is not None and self.fault.reaction is Reaction.LIMP
            if self._servos.powered and not self._belly and not limp:
                self._sit_down()
        finally:
            self.release()
            self._ports.close()

    def release(self) -> None:
        """Release all servos at once. May be called more than once, and never raises."""
        atexit.unregister(self.release)
        if self._servos.powered:
            self.notes += self._servos.release()

    def _tick(self, angles: Float[np.ndarray, "legs 3"], dt: float) -> None:
        """Wait for the tick, send joint angles, measure, and raise the error of a fault."""
        now = self._pacer.wait(dt, excused=not self._input.complete)
        fault: ServoFault | None
        try:
            self._servos.send(angles, dt, now)
            late, writing = self._pacer.recently_late, self._servos.writing
            fault = self._input.measure(self._servos.angles, dt, begun=now, writing=writing, late=late)
        except InputError as error:
            # Nothing was sent: the servos hold where they are.
            fault = ServoFault(kind=FaultKind.INVALID_COMMAND, text=str(error), time=now)
        except PortError as error:
            fault = ServoFault(kind=FaultKind.PORT_GONE, text=str(error), time=now)
        except BusError as error:
            fault = ServoFault(kind=FaultKind.NO_ANSWER, text=str(error), time=now)
        self._observe(now, angles, fault)
        if fault is not None:
            self.fault = fault
            raise fault.error()

    def _observe(self, now: float, asked: Float[np.ndarray, "..."], fault: ServoFault | None) -> None:
        if self._observer is not None:
            problem = "" if fault is None else str(fault.error())
            try:
                self._observer(self._input.record(now, asked=asked, sent=self._servos.angles, fault=problem))
            except Exception:
                # Without the observer the robot can still sit down.
                self._observer = None
                raise

    # How it ends.

    def _sit_down(self) -> None:
        """Lower the body to the ground, as far as the servos manage it, without looking for faults any more."""
        self._belly = True
        if self.fault is not None and self.fault.kind is FaultKind.STUCK:
            # A servo that can't move must not burn while the others sit down.
            self._servos.release_one(self.fault)
        try:
            for angles in sitting_angles(self.calibration.limited_robot, self._servos.angles):
                now = self._pacer.wait(SITTING_TICK)
                self._servos.send(angles, SITTING_TICK, now)
                if self.fault is None:
                    self._input.settle(SITTING_TICK, begun=now, writing=self._servos.writing)
                self._observe(now, angles, None)
        except TarsusError as error:
            self.notes.append(f"the robot could not sit down: {error}")
            self._servos.let_down()
