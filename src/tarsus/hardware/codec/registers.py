"""Vendors' register tables, kept in CSV files with the source of each line."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from functools import cache
from importlib import resources

from tarsus.errors import InputError
from tarsus.representation import represented

__all__ = ["Register", "RegisterTable", "load_models", "load_registers"]


@represented("name", "address", "size", "unit")
@dataclass(frozen=True, slots=True)
class Register:
    """A register of a servo.

    Attributes
    ----------
    name : str
        What it holds.
    address, size : int
        Where it is, and how many bytes it has.
    access : str
        ``"r"`` or ``"rw"``; ``"eeprom"`` if it is also kept without supply.
    sign : str
        How negative values are written: ``""`` for none, ``"two"`` for two's complement, else the number of the bit
        that is set for negative values.
    scale : float
        What 1 means, in `unit`.
    unit : str
        Unit of the scaled value.
    source : str
        Where this is from.
    """

    name: str
    address: int
    size: int
    access: str
    sign: str
    scale: float
    unit: str
    source: str

    def decode(self, data: bytes, *, byteorder: str = "little") -> int:
        """Return the number that a register holds.

        Parameters
        ----------
        data : bytes
            The register's content.
        byteorder : str
            ``"little"`` or ``"big"``.
        """
        raw = int.from_bytes(data, "big" if byteorder == "big" else "little")
        if not self.sign:
            return raw
        if self.sign == "two":
            return raw - (1 << 8 * self.size) if raw >> (8 * self.size - 1) else raw
        bit = 1 << int(self.sign)
        return -(raw & (bit - 1)) if raw & bit else raw & (bit - 1)

    def encode(self, value: int, *, byteorder: str = "little") -> bytes:
        """Return a register's content for a number.

        Parameters
        ----------
        value : int
            The number.
        byteorder : str
            ``"little"`` or ``"big"``.

        Raises
        ------
        InputError
            If the register can't hold it.
        """
        bits = int(self.sign) if self.sign.isdigit() else 8 * self.size - (self.sign == "two")
        # With a sign bit, -(1 << bits) would set that bit alone, which reads as 0.
        least = -(1 << bits) + (self.sign != "two") if self.sign else 0
        if not least <= value < 1 << bits:
            raise InputError(f"register {self.name} can't hold {value}: it has {bits} bits for the magnitude")
        raw = value
        if value < 0:
            raw = -value | 1 << bits if self.sign != "two" else value + (1 << 8 * self.size)
        return raw.to_bytes(self.size, "big" if byteorder == "big" else "little")


class RegisterTable:
    """The registers of a kind of servo, and its byte order.

    Parameters
    ----------
    name : str
        Name of the table, such as ``"feetech-sts"``.
    byteorder : str
        ``"little"`` or ``"big"``.
    """

    def __init__(self, name: str, *, byteorder: str = "little") -> None:
        self._registers, self._byteorder = load_registers(name), byteorder

    def __contains__(self, register: str) -> bool:
        return register in self._registers

    def __getitem__(self, register: str) -> Register:
        return self._registers[register]

    def block(self, first: str, last: str) -> tuple[int, int]:
        """Return the first address and the number of bytes from one register to another.

        Parameters
        ----------
        first, last : str
            Their names, in any order.
        """
        one, other = sorted((self[first], self[last]), key=lambda register: register.address)
        return one.address, other.address + other.size - one.address

    def encode(self, register: str, value: int) -> bytes:
        """Return a register's content for a number.

        Parameters
        ----------
        register : str
            Its name.
        value : int
            The number.

        Raises
        ------
        InputError
            If the register can't hold it.
        """
        return self[register].encode(value, byteorder=self._byteorder)

    def decode(self, register: str, data: bytes, first: int) -> int:
        """Return the number that a register holds.

        Parameters
        ----------
        register : str
            Its name.
        data : bytes
            Content of consecutive registers.
        first : int
            Address of the first of them.
        """
        one = self[register]
        begin = one.address - first
        return one.decode(data[begin : begin + one.size], byteorder=self._byteorder)


@cache
def load_registers(table: str) -> dict[str, Register]:
    """Return the registers of a kind of servo, by their names.

    Parameters
    ----------
    table : str
        Name of the table, such as ``"feetech-sts"``.
    """
    return {
        row["name"]: Register(
            name=row["name"],
            address=int(row["address"]),
            size=int(row["size"]),
            access=row["access"],
            sign=row["sign"],
            scale=float(row["scale"] or 1),
            unit=row["unit"],
            source=row["source"],
        )
        for row in _rows(table)
    }


@cache
def load_models(bus: str) -> dict[int, str]:
    """Return the names of servos by their makers' numbers.

    Parameters
    ----------
    bus : str
        Name of the bus, such as ``"feetech-sts"``.
    """
    return {int(row["number"]): row["name"] for row in _rows("models") if row["bus"] == bus}


def _rows(table: str) -> csv.DictReader[str]:
    text = (resources.files("tarsus.hardware") / "tables" / f"{table}.csv").read_text(encoding="utf-8")
    return csv.DictReader(text.splitlines())
