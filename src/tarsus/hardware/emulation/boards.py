"""Emulated boards on serial ports: Maestro, SSC-32, Servo2040, and the sketch for lines of pulse widths."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator
from typing import Any

from tarsus.hardware.codec import lines, maestro, servo2040, ssc32
from tarsus.hardware.emulation.pulses import BOARD, EmulatedBoard, pulse_servos
from tarsus.hardware.emulation.servo import ServoTraits

__all__ = ["EmulatedLines", "EmulatedMaestro", "EmulatedServo2040", "EmulatedSsc32"]

# Size of each Maestro command [bytes].
_SIZES = {
    maestro.SET_TARGET: 4,
    maestro.SET_SPEED: 4,
    maestro.SET_ACCELERATION: 4,
    maestro.GET_POSITION: 2,
    maestro.GET_MOVING: 1,
    maestro.GET_ERRORS: 1,
    maestro.GO_HOME: 1,
}
# Inputs from this channel on are digital.
_ANALOGUE = 12
_TIMEOUT_ERROR = 1 << 5
_PROTOCOL_ERROR = 1 << 4
# Number of inputs of the sketch for lines of pulse widths.
_INPUTS = 6


class EmulatedMaestro(EmulatedBoard):
    """A Mini Maestro with the compact protocol, without CRC.

    Parameters
    ----------
    channels : iterable of int
        Channels with servos.
    traits : ServoTraits, optional
        What the servos are like.
    serial_timeout : float
        Silence after which pulses end, as it is set in the Maestro Control Center [s]; infinite for never.
    **line
        Passed on to `EmulatedLine`.
    """

    def __init__(
        self,
        channels: Iterable[int],
        *,
        traits: ServoTraits | None = None,
        serial_timeout: float = math.inf,
        **line: Any,
    ) -> None:
        super().__init__(pulse_servos(channels, traits), **line)
        self._timeout, self._errors = serial_timeout, 0

    def _watch(self, silent: float) -> None:
        if silent > self._timeout:
            self._errors |= _TIMEOUT_ERROR
            self.pulses.update(dict.fromkeys(self.pulses, 0.0))

    def _answers(self) -> Iterator[tuple[int, bytes]]:
        while self._buffer:
            code = self._buffer[0]
            size = _SIZES.get(code, 0)
            if code == maestro.SET_TARGETS:
                size = 3 + 2 * self._buffer[1] if len(self._buffer) > 1 else 2
            if not size:
                self._errors |= _PROTOCOL_ERROR
                self._buffer = self._buffer[1:]
                continue
            if len(self._buffer) < size:
                return
            command, self._buffer = self._buffer[:size], self._buffer[size:]
            answer = self._carried_out(code, command[1:])
            if answer:
                yield BOARD, answer

    def _carried_out(self, code: int, data: bytes) -> bytes:
        if code == maestro.SET_TARGET:
            self._set(data[0], data[1:])
        elif code == maestro.SET_TARGETS:
            self._set(data[1], data[2:])
        elif code == maestro.SET_SPEED and data[0] in self.servos:
            # In units of 0.25 us per 10 ms, which is 25 us/s.
            self.servos[data[0]].speed_limit = (data[1] | data[2] << 7) * 25.0 or math.inf
        elif code == maestro.GET_POSITION:
            return self._position(data[0]).to_bytes(2, "little")
        elif code == maestro.GET_MOVING:
            return bytes((any(servo.speed for servo in self.servos.values()),))
        elif code == maestro.GET_ERRORS:
            errors, self._errors = self._errors, 0
            return errors.to_bytes(2, "little")
        return b""

    def _position(self, channel: int) -> int:
        if channel in self.levels:
            level = self.levels[channel] if channel < _ANALOGUE else round(self.levels[channel])
            return round(maestro.FULL_LEVEL * level)
        return round(4 * self.pulses.get(channel, 0.0))

    def _set(self, first: int, data: bytes) -> None:
        for at in range(0, len(data), 2):
            self.pulses[first + at // 2] = (data[at] | data[at + 1] << 7) / 4


class EmulatedSsc32(EmulatedBoard):
    """An SSC-32U.

    Parameters
    ----------
    channels : iterable of int
        Channels with servos.
    traits : ServoTraits, optional
        What the servos are like.
    **line
        Passed on to `EmulatedLine`.
    """

    def __init__(self, channels: Iterable[int], *, traits: ServoTraits | None = None, **line: Any) -> None:
        super().__init__(pulse_servos(channels, traits), **line)

    def _answers(self) -> Iterator[tuple[int, bytes]]:
        while b"\r" in self._buffer:
            line, _, self._buffer = self._buffer.partition(b"\r")
            text = re.sub(r"\s", "", line.decode("ascii", "replace").upper())
            if text == "VER":
                yield BOARD, b"SSC32-V2.50USB\r"
            elif text == "Q":
                yield BOARD, b"+" if any(servo.speed for servo in self.servos.values()) else b"."
            elif asked := re.findall(r"QP(\d+)", text):
                yield BOARD, bytes(int(self.pulses.get(int(channel), 0.0) // 10) for channel in asked)
            elif re.fullmatch(f"[{ssc32.INPUTS}]+", text):
                yield BOARD, "".join(str(self._level(ssc32.INPUTS.index(one))) for one in text).encode("ascii")
            else:
                self._move(text)

    def _level(self, number: int) -> int:
        # Inputs have a pull-up.
        return round(self.levels.get(number, 1.0))

    def _move(self, text: str) -> None:
        if not re.fullmatch(r"(#\d+P\d+(S\d+)?)+(T\d+)?", text):
            return
        for channel, width, speed in re.findall(r"#(\d+)P(\d+)(?:S(\d+))?", text):
            if servo := self.servos.get(int(channel)):
                servo.speed_limit = float(speed or 0) or math.inf
            self.pulses[int(channel)] = min(max(float(width), 500.0), 2500.0) if int(width) else 0.0


class EmulatedServo2040(EmulatedBoard):
    """A Servo2040 with the firmware for Chica.

    Parameters
    ----------
    channels : iterable of int
        Channels with servos.
    traits : ServoTraits, optional
        What the servos are like.
    **line
        Passed on to `EmulatedLine`.
    """

    def __init__(self, channels: Iterable[int], *, traits: ServoTraits | None = None, **line: Any) -> None:
        super().__init__(pulse_servos(channels, traits), **line)
        self._widths = [1500] * servo2040.CHANNELS
        self._on = False

    def _answers(self) -> Iterator[tuple[int, bytes]]:
        while len(self._buffer) >= 3:
            code, first, count = self._buffer[:3]
            if code == servo2040.SET and len(self._buffer) >= 3 + 2 * count:
                data, self._buffer = self._buffer[3 : 3 + 2 * count], self._buffer[3 + 2 * count :]
                for at in range(count):
                    self._set(first + at, (data[2 * at] & 0x7F) | (data[2 * at + 1] & 0x7F) << 7)
            elif code == servo2040.SET:
                return
            elif code == servo2040.GET:
                self._buffer = self._buffer[3:]
                values = b"".join(self._value(first + at) for at in range(count))
                yield BOARD, bytes((servo2040.GET, first, count)) + values
            else:
                self._buffer = self._buffer[1:]

    def _set(self, pin: int, value: int) -> None:
        if pin < servo2040.CHANNELS:
            self._widths[pin] = value
        elif pin == servo2040.RELAY:
            self._on = bool(value)
        self.pulses.update({one: float(self._widths[one]) if self._on else 0.0 for one in self.servos})

    def _value(self, pin: int) -> bytes:
        if pin < servo2040.CHANNELS:
            value = self._widths[pin]
        elif pin < servo2040.CURRENT:
            value = round(3.3 * self.levels.get(pin - servo2040.TOUCH, 0.0) * 310.3)
        elif pin == servo2040.CURRENT:
            value = round(sum(servo.current for servo in self.servos.values()) / 0.0814) + 512
        else:
            value = round(self.supply.voltage * 310.3)
        return bytes((value & 0x7F, value >> 7 & 0x7F))


class EmulatedLines(EmulatedBoard):
    """A microcontroller with the sketch for lines of pulse widths.

    Parameters
    ----------
    channels : iterable of int
        Channels with servos.
    traits : ServoTraits, optional
        What the servos are like.
    outputs : int
        How many channels the board has.
    **line
        Passed on to `EmulatedLine`.
    """

    def __init__(
        self, channels: Iterable[int], *, traits: ServoTraits | None = None, outputs: int = 18, **line: Any
    ) -> None:
        super().__init__(pulse_servos(channels, traits), **line)
        self._outputs, self._limit = outputs, 0.5
        self._good: float | None = None

    def _step(self, now: float) -> None:
        self._now = now
        if self._good is not None and now - self._good > self._limit:
            self.pulses.update(dict.fromkeys(self.pulses, 0.0))
        super()._step(now)

    def _answers(self) -> Iterator[tuple[int, bytes]]:
        while b"\n" in self._buffer:
            line, _, self._buffer = self._buffer.partition(b"\n")
            text = lines.content(line)
            if text is None:
                continue
            self._good = self._now
            words = text.split()
            if words == ["?"]:
                yield BOARD, lines.checked(f"tarsus {self._outputs}")
            elif words == ["I"]:
                yield BOARD, lines.checked("I " + "".join(map(self._level, range(_INPUTS))))
            elif words[:1] == ["W"] and len(words) == 2 and words[1].isdigit():
                self._limit = int(words[1]) / 1e3 or math.inf
            else:
                self._set(words)

    def _level(self, number: int) -> str:
        # Inputs have a pull-up.
        return str(round(self.levels.get(number, 1.0)))

    def _set(self, words: list[str]) -> None:
        if len(words) != self._outputs or not all(word.isdigit() for word in words):
            return
        widths = [int(word) for word in words]
        if all(width == 0 or 500 <= width <= 2500 for width in widths):
            self.pulses.update({channel: float(width) for channel, width in enumerate(widths)})
