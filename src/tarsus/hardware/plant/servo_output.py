"""What goes out to the servos: commands, torque on and off, watchdogs."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from tarsus.errors import BusError, NoAnswerError
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.plant.command_limiter import CommandLimiter
from tarsus.hardware.plant.fault import ServoFault
from tarsus.hardware.plant.joint_map import JointMap
from tarsus.hardware.plant.settings import PlantSettings
from tarsus.hardware.plant.soft_start import release_order
from tarsus.hardware.transport.clock import Clock

if TYPE_CHECKING:
    from jaxtyping import Float, Int

__all__ = ["ServoOutput"]

# How many times missing servos are searched for before the first motion.
_TRIES = 3
# Shares of the torque with which a robot that can't sit down sinks to the ground, and how long each lasts [s].
_FADING, _FADE = (0.5, 0.35, 0.25, 0.15, 0.08), 0.25


class ServoOutput:
    """Sends limited commands to servos, and switches them on and off.

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
    clock : Clock
        The clock.

    Attributes
    ----------
    powered : bool
        Whether servos may have torque.
    writing : float
        How long the commands of a tick take on the wire, with all buses in parallel [s].
    """

    def __init__(
        self,
        calibration: Calibration,
        buses: Mapping[str, Bus],
        joints: JointMap,
        settings: PlantSettings,
        clock: Clock,
    ) -> None:
        self._calibration, self._buses, self._joints = calibration, buses, joints
        self._settings, self._clock = settings, clock
        self._limiter = CommandLimiter(calibration)
        self._last: float | None = None
        self.powered = False
        self.writing = max(bus.timing(joints.numbers(name)).goals for name, bus in buses.items())

    @property
    def angles(self) -> Float[np.ndarray, "legs 3"]:
        """Joint angles of the last commands; NaN before the first [rad]."""
        sent = self._limiter.sent
        if sent is None:
            return np.full((self._calibration.robot.legs, 3), np.nan)
        return self._calibration.angles(sent)

    def find(self) -> None:
        """Search for the servos, and raise an error where one does not answer.

        Raises
        ------
        NoAnswerError
            If servos are missing; the message names the joints.
        """
        for name, bus in self._buses.items():
            numbers = self._joints.numbers(name)
            if bus.capabilities.ping == "none" or not numbers:
                continue
            missing = list(numbers)
            for _ in range(_TRIES):
                found = bus.scan(missing).values
                missing = [number for number in missing if number not in found]
                if not missing:
                    break
            if missing:
                listed = ", ".join(self._joints.describe(name, number) for number in missing)
                raise NoAnswerError(
                    bus.name,
                    bus.port,
                    expected=f"answers of {len(numbers)} servos",
                    received=f"none of {len(missing)}: {listed}",
                    remedy="tarsus check-servos finds out why.",
                )

    def switch_on(self, angles: Float[np.ndarray, "legs 3"], *, measured: bool) -> None:
        """Switch on the servos one leg after the other, each with its present position as its command, at full torque.

        Parameters
        ----------
        angles : array, shape (legs, 3)
            Where the joints are [rad].
        measured : bool
            Whether these angles are measured; otherwise servos get their first pulse one at a time.
        """
        goals = self._joints.goals(self._limiter.begin(angles))
        self.powered = True
        self._last = self._clock.now()
        for name, bus in self._buses.items():
            # Servos that the watchdog of an earlier run has stopped refuse goals.
            bus.set_watchdog(self._joints.numbers(name), None)
        for leg in release_order(self._calibration.robot.legs):
            for name, bus in self._buses.items():
                numbers = self._joints.numbers(name, (leg,))
                if measured and numbers:
                    bus.write_goals({number: goals[name][number] for number in numbers})
                    bus.set_torque(numbers, True)
                    continue
                for number in numbers:
                    bus.set_torque((number,), True)
                    bus.write_goals({number: goals[name][number]})
                    self._clock.sleep(self._settings.start_interval)
        for name, bus in self._buses.items():
            numbers, span = self._joints.numbers(name), bus.capabilities.watchdog
            if span is not None:
                bus.set_watchdog(numbers, min(max(self._settings.watchdog, span[0]), span[1]))
            # A program that was ended may have left them with less. Not before the goals, as they may hold already.
            bus.set_torque_limit(numbers, 1.0)

    def send(self, angles: Float[np.ndarray, "legs 3"], dt: float, now: float) -> None:
        """Send joint angles, as far as limits and speeds allow, and wait until they have been transmitted.

        A port accepts commands at once, but servos answer a request only after the commands have been transmitted.

        Parameters
        ----------
        angles : array, shape (legs, 3)
            Joint angles [rad].
        dt : float
            Duration of the tick; joints move no farther than they can in this time [s].
        now : float
            The time [s].

        Raises
        ------
        InputError
            If they are not finite; nothing is sent then.
        BusError
            If they can't be sent.
        """
        elapsed = 0.0 if self._last is None else now - self._last
        commands: Int[np.ndarray, "legs 3"] = self._limiter.limited(
            angles, min(elapsed, dt, self._settings.longest_tick)
        )
        self._last = now
        for name, goals in self._joints.goals(commands).items():
            self._buses[name].write_goals(goals)
        self._clock.sleep(now + self.writing - self._clock.now())

    def release_one(self, fault: ServoFault) -> None:
        """Release the servo of a fault, and send it nothing more.

        Parameters
        ----------
        fault : ServoFault
            A fault of one joint.
        """
        joint = self._calibration.joints[fault.leg][fault.number]
        assert joint.number is not None
        with contextlib.suppress(BusError):
            self._buses[joint.bus].set_torque((joint.number,), False)
        self._joints = self._joints.without(joint.bus, joint.number)

    def let_down(self) -> None:
        """Reduce the torque in steps, on all buses that can limit it, until `release` restores it."""
        for share in _FADING:
            able = [(name, bus) for name, bus in self._buses.items() if bus.capabilities.torque_limit]
            for name, bus in able:
                with contextlib.suppress(BusError):
                    bus.set_torque_limit(self._joints.numbers(name), share)
            self._clock.sleep(_FADE if able else 0.0)

    def release(self) -> list[str]:
        """Release all servos at once, and return what could not be done. Never raises."""
        notes = []
        self.powered = False
        for name, bus in self._buses.items():
            try:
                # Twice, as a packet may be lost.
                released = [bus.set_torque(None, False) for _ in range(2)]
                if not all(released):
                    notes.append(f"{bus.name} on {bus.port} can't release servos: switch their supply off")
                bus.set_watchdog(self._joints.numbers(name), None)
                bus.set_torque_limit(self._joints.numbers(name), 1.0)
            except Exception as error:
                notes.append(f"the servos on {name} may still hold: {error}")
        return notes
