"""The memory of emulated servos that are read and written by registers."""

from __future__ import annotations

import math
from collections.abc import Collection

from tarsus.hardware.codec.registers import Register
from tarsus.hardware.emulation.servo import EmulatedServo
from tarsus.hardware.emulation.supply import Supply

__all__ = ["ServoMemory"]

# Speed up to which a servo reports that it stands still [turns/s].
_STANDING = 1e-3


class ServoMemory:
    """Registers of a servo: measured values are filled in when they are read, written ones are passed to the servo.

    Parameters
    ----------
    servo : EmulatedServo
        The servo.
    registers : dict of str to Register
        The vendor's table.
    supply : Supply
        What feeds it.
    byteorder : str
        ``"little"`` or ``"big"``.
    initial : dict of str to int
        Initial values of registers that are not 0 at first.
    """

    def __init__(
        self,
        servo: EmulatedServo,
        registers: dict[str, Register],
        supply: Supply,
        *,
        byteorder: str = "little",
        initial: dict[str, int] | None = None,
    ) -> None:
        self.servo, self._registers, self._supply, self._byteorder = servo, registers, supply, byteorder
        self._initial = dict(initial or {})
        size = max(one.address + one.size for one in registers.values())
        self._bytes = bytearray(size)
        for name, value in self._initial.items():
            self.set(name, value)
        self.set("goal", round(servo.goal))

    def has(self, name: str) -> bool:
        """Return whether there is a register.

        Parameters
        ----------
        name : str
            Name of the register.
        """
        return name in self._registers

    def address(self, name: str) -> int:
        """Return where a register begins.

        Parameters
        ----------
        name : str
            Name of the register.
        """
        return self._registers[name].address

    def touches(self, name: str, address: int, count: int) -> bool:
        """Return whether some bytes belong to a register.

        Parameters
        ----------
        name : str
            Name of the register.
        address : int
            The first byte.
        count : int
            How many.
        """
        one = self._registers[name]
        return address < one.address + one.size and one.address < address + count

    def get(self, name: str) -> int:
        """Return the number in a register, as it was last written or measured.

        Parameters
        ----------
        name : str
            Name of the register.
        """
        one = self._registers[name]
        return one.decode(bytes(self._bytes[one.address : one.address + one.size]), byteorder=self._byteorder)

    def set(self, name: str, value: int) -> None:
        """Set the number in a register.

        Parameters
        ----------
        name : str
            Name of the register.
        value : int
            The number.
        """
        one = self._registers[name]
        self._bytes[one.address : one.address + one.size] = one.encode(value, byteorder=self._byteorder)

    def read(self, address: int, count: int) -> bytes:
        """Return registers, with what is measured now.

        Parameters
        ----------
        address : int
            The first register.
        count : int
            How many bytes.
        """
        self._measure()
        return bytes(self._bytes[address : address + count]).ljust(count, b"\x00")

    def write(self, address: int, data: bytes) -> None:
        """Write registers; those that can only be read stay as they are.

        Parameters
        ----------
        address : int
            The first register.
        data : bytes
            Their content.
        """
        locked = "lock" in self._registers and self.get("lock") != 0
        written: list[str] = []
        for name, one in self._registers.items():
            begin, end = max(address, one.address), min(address + len(data), one.address + one.size)
            if begin >= end or "w" not in one.access or (locked and "eeprom" in one.access):
                continue
            self._bytes[begin:end] = data[begin - address : end - address]
            written.append(name)
        self._carry_out(written)

    def restart(self) -> None:
        """Reset the registers that are lost without supply to their initial values."""
        for name, one in self._registers.items():
            if "eeprom" not in one.access and "w" in one.access:
                self.set(name, self._initial.get(name, 0))

    def _carry_out(self, written: Collection[str]) -> None:
        servo = self.servo
        if "torque" in written:
            servo.torque = bool(self.get("torque"))
            servo.overheated = servo.overheated and not servo.torque
        if "goal" in written:
            low, high = self.get("lowest"), self.get("highest")
            servo.goal = float(min(max(self.get("goal"), low), high) if high > low else self.get("goal"))
        if "goal_speed" in written:
            one = self._registers["goal_speed"]
            unit = servo.traits.per_turn / 60.0 if one.unit == "rpm" else 1.0
            servo.speed_limit = self.get("goal_speed") * one.scale * unit or math.inf
        if "torque_limit" in written:
            servo.torque_limit = min(self.get("torque_limit") * self._registers["torque_limit"].scale, 1.0)

    def _measure(self) -> None:
        servo = self.servo
        moving = abs(servo.speed) > _STANDING * servo.traits.per_turn
        measured = {
            "position": servo.position,
            "speed": servo.speed,
            "load": servo.load,
            "voltage": self._supply.voltage,
            "temperature": servo.temperature,
            "current": math.copysign(servo.current, servo.load),
            "moving": float(moving),
        }
        for name in measured.keys() & self._registers.keys():
            one = self._registers[name]
            unit = 60.0 / servo.traits.per_turn if one.unit == "rpm" else 1.0
            self.set(name, round(measured[name] * unit / one.scale))
        self.set("torque", int(servo.torque))
