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
# How far the commanded body height may be from the present one, so that the body stops soon after the last input [m].
_AHEAD = 0.02


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
        self._height: float | None = None

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
        changes |= self._new_height(output, sum(each.body_height for each in inputs or ()))
        if any(self._twist) and (self._quit or now - self._heard > self._deadman):
            self._twist = _NO_TWIST
            note("command", "stop" if self._quit else f"nothing heard for {self._deadman:g} s: stop")
        vx, vy, wz = (share * speed for share, speed in zip(self._twist, self._speeds, strict=True))
        return Command(twist=(vx, vy, wz), **changes)

    def _new_height(self, output: ControlOutput, change: float) -> dict[str, float]:
        """Return the body height to command, if it is to change: the commanded one with the change."""
        if not output.state.upright:
            self._height = None
            return {}
        if not change:
            return {}
        # The body takes its time: the height that it has would leave out what was asked for in the meantime.
        present = float(output.body.position[2])
        wanted = (present if self._height is None else self._height) + change
        self._height = min(max(wanted, present - _AHEAD), present + _AHEAD)
        return {"body_height": self._height}

    def over(self, time: float, output: ControlOutput) -> bool:  # noqa: ARG002
        """Return whether the run is over: the driver has quit, and the robot stands still."""
        return self._quit and output.at_rest
