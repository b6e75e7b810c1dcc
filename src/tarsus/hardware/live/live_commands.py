"""Commands from someone who drives, with a deadman: the robot stops when nothing is heard any more."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from tarsus.control.command import Command
from tarsus.control.control_output import ControlOutput
from tarsus.hardware.transport.clock import Clock, SystemClock

__all__ = ["Input", "InputDevice", "LiveCommands"]

_NO_TWIST = (0.0, 0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class Input:
    """What a driver does.

    Attributes
    ----------
    twist : tuple of float, optional
        Shares of the greatest speeds, -1 to 1: forward, left, turning; None leaves them.
    state : str
        State that is asked for; empty for none.
    gait : str
        Gait that is asked for; empty for none.
    body_height : float
        Change of the body height [m].
    quit : bool
        Whether the run is to end.
    """

    twist: tuple[float, float, float] | None = None
    state: str = ""
    gait: str = ""
    body_height: float = 0.0
    quit: bool = False


class InputDevice(Protocol):
    """A keyboard, a gamepad, or what comes over a network."""

    def read(self) -> list[Input] | None:
        """Return what came since the last time, without waiting; None where the device is gone."""


class LiveCommands:
    """A source of commands from an input device; a deadman stops the robot when nothing is heard for a time.

    Parameters
    ----------
    device : InputDevice
        The device.
    speeds : (float, float, float)
        Greatest speeds: forward, left [m/s], turning [rad/s].
    deadman : float
        Time without input after which the twist is 0 [s].
    clock : Clock, optional
        The machine's.
    """

    def __init__(
        self,
        device: InputDevice,
        *,
        speeds: tuple[float, float, float],
        deadman: float = 0.7,
        clock: Clock | None = None,
    ) -> None:
        self._device, self._speeds, self._deadman = device, speeds, deadman
        self._clock: Clock = clock or SystemClock()
        self._twist = _NO_TWIST
        self._heard = self._clock.now()
        self._quit = False

    def command(self, time: float, output: ControlOutput, note: Callable[[str, str], None]) -> Command:  # noqa: ARG002
        """Return the command for the next tick."""
        inputs, now = self._device.read(), self._clock.now()
        changes: dict[str, Any] = {}
        if inputs is None:
            self._quit = True
            note("command", "the input device is gone")
        for each in inputs or ():
            self._heard = now
            self._quit = self._quit or each.quit
            self._twist = self._twist if each.twist is None else each.twist
            if each.state:
                changes["state"] = each.state
            if each.gait:
                changes["gait"] = each.gait
            if each.body_height and output.state.upright:
                changes["body_height"] = float(output.body.position[2]) + each.body_height
        if any(self._twist) and (self._quit or now - self._heard > self._deadman):
            self._twist = _NO_TWIST
            note("command", "stop" if self._quit else f"nothing heard for {self._deadman:g} s: stop")
        vx, vy, wz = (share * speed for share, speed in zip(self._twist, self._speeds, strict=True))
        return Command(twist=(vx, vy, wz), **changes)

    def over(self, time: float, output: ControlOutput) -> bool:  # noqa: ARG002
        """Return whether the run is over: the driver has quit, and the robot stands still."""
        return self._quit and output.at_rest
