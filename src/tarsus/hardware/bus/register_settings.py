"""Limits and watchdogs of servos that are read and written by registers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tarsus.errors import ServoStatusError
from tarsus.hardware.bus.capabilities import Capabilities
from tarsus.hardware.bus.checks import checked_ids, checked_range, checked_share, checked_speed, checked_time
from tarsus.hardware.bus.dialect import Dialect, Series
from tarsus.hardware.bus.link import Link
from tarsus.hardware.bus.register_reader import RegisterReader
from tarsus.hardware.codec.registers import RegisterTable

__all__ = ["RegisterSettings"]

_UNLOCKED, _LOCKED = 0, 1


class RegisterSettings:
    """Sets limits, speed, torque and watchdog; a part of `RegisterBus`.

    Attributes
    ----------
    name : str
        Name of the bus.
    port : str
        Name of the port.
    capabilities : Capabilities
        What it can do.
    """

    name: str
    port: str
    capabilities: Capabilities
    _series: Series
    _dialect: Dialect
    _table: RegisterTable
    _link: Link
    _reader: RegisterReader
    # Values of the speed register that are sent with each goal, by id.
    _speed: dict[int, int]

    def set_limits(self, id: int, lowest: float, highest: float) -> bool:
        """Set the range of goals that a servo accepts, and keeps without supply; its torque must be off.

        Parameters
        ----------
        id : int
            The servo.
        lowest, highest : float
            Range [tick].

        Raises
        ------
        NoAnswerError, CorruptAnswerError
            If its answer does not come, or is damaged.
        ServoStatusError
            If the servo does not take the limits.
        """
        limits = dict(
            zip(("lowest", "highest"), checked_range(self.name, self.capabilities, id, lowest, highest), strict=True)
        )
        lockable = "lock" in self._table
        steps = [*([("lock", _UNLOCKED)] * lockable), *limits.items(), *([("lock", _LOCKED)] * lockable)]
        refused: tuple[str, ...] = ()
        for name, value in steps:
            # Whether servos answer to a write depends on their status level, so the registers are read back afterwards.
            frame = self._dialect.write(id, self._table[name].address, self._table.encode(name, value))
            for answer in self._link.ask(frame, (id,), 0).values.values():
                refused += self._dialect.errors_in(answer.code)
        for name, value in limits.items():
            self._confirm(id, name, value, refused)
        return True

    def set_speed_limit(self, ids: Sequence[int], speed: float | None) -> bool:
        """Set the highest speed of servos.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        speed : float or None
            Speed [tick/s]; None for the servo's own highest speed.
        """
        limit = checked_speed(self.name, self.capabilities, speed)
        # 0 would mean the highest speed, so a limit that rounds to 0 is sent as 1.
        value = 0 if limit is None else min(max(round(limit / self._unit("goal_speed")), 1), self._series.fastest)
        values = dict.fromkeys(checked_ids(self.name, self.capabilities, ids), value)
        if "goal_speed" in self._series.goal:
            self._speed.update(values)
        else:
            self._write_all("goal_speed", values)
        return True

    def set_torque_limit(self, ids: Sequence[int], share: float) -> bool:
        """Set the highest torque of servos; SCS servos have none that can be set at run time.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        share : float
            Share of the highest torque, 0 to 1.
        """
        share = checked_share(self.name, share)
        chosen = checked_ids(self.name, self.capabilities, ids)
        if not self.capabilities.torque_limit:
            return False
        value = round(share / self._table["torque_limit"].scale)
        self._write_all("torque_limit", dict.fromkeys(chosen, value))
        return True

    def set_watchdog(self, ids: Sequence[int], seconds: float | None) -> bool:
        """Make Dynamixel X servos stop by themselves if no packet comes for some time; others can't.

        A servo that its watchdog has stopped takes goals again after this call.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        seconds : float or None
            The time [s]; None for never.
        """
        chosen = checked_ids(self.name, self.capabilities, ids)
        if self.capabilities.watchdog is None:
            return False
        seconds = checked_time(self.name, self.capabilities, seconds)
        self._write_all("watchdog", dict.fromkeys(chosen, 0))
        if seconds is not None:
            self._write_all("watchdog", dict.fromkeys(chosen, round(seconds / self._table["watchdog"].scale)))
        return True

    def _unit(self, register: str) -> float:
        """Return what 1 in a register means, in its unit; speeds in rpm are converted to [tick/s]."""
        one = self._table[register]
        return one.scale * ((self.capabilities.per_turn or 0.0) / 60.0 if one.unit == "rpm" else 1.0)

    def _write_all(self, register: str, values: Mapping[int, int]) -> None:
        """Write a register of several servos in one packet that nobody answers."""
        if values:
            content = {id: self._table.encode(register, value) for id, value in values.items()}
            self._link.send(self._dialect.sync_write(self._table[register].address, content))

    def _confirm(self, id: int, register: str, wanted: int, refused: tuple[str, ...]) -> None:
        """Read a register back; raise `ServoStatusError` if it does not hold what was written."""
        block = self._table.block(register, register)
        read = self._table.decode(register, self._reader.read((id,), block).require()[id].data, block[0])
        if read != wanted:
            raise ServoStatusError(
                self.name,
                self.port,
                id=id,
                expected=f"its register {register} to hold {wanted}",
                received=f"{read}" + "".join(f", error {text!r}" for text in dict.fromkeys(refused)),
                remedy="Switch its torque off and write again; if that fails, its memory is locked or worn out.",
            )
