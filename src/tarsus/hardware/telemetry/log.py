"""Log of a servo plant, written tick by tick: whatever ends the run, at most the rows still buffered are lost."""

from __future__ import annotations

import csv
import io
import json
import math
import os
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from tarsus.errors import InputError
from tarsus.hardware.plant.tick_record import TickRecord
from tarsus.robot.robot import JOINTS, Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["TelemetryLog", "read_log"]

_PER_JOINT = ("commanded_deg", "sent_deg", "measured_deg", "temperature_c", "load")
_SCHEMA = {
    "type": "object",
    "properties": {
        "name": {"type": "array", "items": {"type": "string"}},
        "commanded_deg": {"type": "array", "items": {"type": "number"}},
        "sent_deg": {"type": "array", "items": {"type": "number"}},
        "measured_deg": {"type": "array", "items": {"type": ["number", "null"]}},
        "temperature_c": {"type": "array", "items": {"type": ["number", "null"]}},
        "load": {"type": "array", "items": {"type": ["number", "null"]}},
        "voltage_v": {"type": ["number", "null"]},
        "fault": {"type": "string"},
    },
}


class TelemetryLog:
    """A table (CSV) and an MCAP file of a run, for Foxglove; each tick is written as it comes.

    Parameters
    ----------
    robot : Robot
        Which robot.
    folder : path
        Existing folder; the files are ``telemetry.csv`` and ``telemetry.mcap``.

    Attributes
    ----------
    problem : str
        Why no more can be written, for example a full disk; empty where all was. The run goes on without the log.

    Raises
    ------
    InputError
        If a file can't be written, or the package ``mcap`` is missing.
    """

    def __init__(self, robot: Robot, folder: str | os.PathLike[str]) -> None:
        try:
            from mcap.writer import Writer
        except ImportError:
            raise InputError("a log of telemetry needs mcap: pip install 'tarsus[hardware]'") from None
        self.table, self.mcap = Path(folder) / "telemetry.csv", Path(folder) / "telemetry.mcap"
        self._names = _names(robot)
        self.problem = ""
        try:
            self._csv = self.table.open("w", encoding="utf-8", newline="")
            self._raw = self.mcap.open("wb")
        except OSError as error:
            raise InputError(f"{error.filename} can't be written: {error.strerror}") from None
        self._rows = csv.writer(self._csv)
        self._rows.writerow([*_columns(robot), "fault"])
        self._mcap = Writer(self._raw)
        self._mcap.start(profile="", library="tarsus")
        schema = self._mcap.register_schema("tarsus.Joints", "jsonschema", json.dumps(_SCHEMA).encode())
        self._channel = self._mcap.register_channel("/joints", "json", schema)
        self._first: float | None = None

    def __enter__(self) -> Self:
        """Return the log itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the files."""
        for close in (self._mcap.finish, self._raw.close, self._csv.close):
            try:
                close()
            except OSError as failure:
                self._failed(failure)

    def write(self, record: TickRecord) -> None:
        """Write a tick, unless that has failed before.

        Parameters
        ----------
        record : TickRecord
            What the plant did.
        """
        if self.problem:
            return
        try:
            self._write(record)
        except OSError as error:
            self._failed(error)

    def _failed(self, error: OSError) -> None:
        where = self.table.parent
        self.problem = self.problem or f"the telemetry in {where} is not complete: {error.strerror or error}"

    def _write(self, record: TickRecord) -> None:
        if self._first is None:
            self._first = record.time
        time = record.time - self._first
        columns = (
            *(np.degrees(values) for values in (record.asked, record.sent, record.measured)),
            record.temperatures,
            record.loads,
        )
        lists = [
            [None if math.isnan(value) else round(value, 4) for value in part.ravel().tolist()] for part in columns
        ]
        voltage = None if record.voltage is None else round(record.voltage, 3)
        cells: list[Any] = [f"{time:.5f}", voltage, *(value for part in lists for value in part), record.fault]
        self._rows.writerow(["" if cell is None else cell for cell in cells])
        if record.fault:
            self._csv.flush()
        message = dict(zip(_PER_JOINT, lists, strict=True))
        data = json.dumps({"name": self._names, **message, "voltage_v": voltage, "fault": record.fault}).encode()
        stamp = round(time * 1e9)
        self._mcap.add_message(self._channel, log_time=stamp, publish_time=stamp, data=data)


def _names(robot: Robot) -> list[str]:
    codes = [code.replace(" ", "_") for code in robot.leg_codes]
    return [f"{code}_{joint}" for code in codes for joint in JOINTS]


def _columns(robot: Robot) -> list[str]:
    return ["time_s", "voltage_v", *(f"{name}_{what}" for what in _PER_JOINT for name in _names(robot))]


def read_log(
    path: str | os.PathLike[str], robot: Robot
) -> tuple[Float[np.ndarray, "n"], Float[np.ndarray, "n legs 3"], Float[np.ndarray, "n legs 3"]]:
    """Return times [s], and the joint angles sent and measured, from the whole rows of the table of a log [rad].

    Parameters
    ----------
    path : path
        The table.
    robot : Robot
        Which robot.

    Returns
    -------
    time : array, shape (n,)
        Times [s].
    sent, measured : array, shape (n, legs, 3)
        Joint angles; NaN where nothing was measured [rad].

    Raises
    ------
    InputError
        If it is no such table.
    """
    joints = robot.legs * len(JOINTS)
    try:
        content = Path(path).read_bytes()
        # A full disk or a kill cuts the last row off, maybe within a number.
        whole = content[: content.rfind(b"\n") + 1].decode()
        head, *rows = csv.reader(io.StringIO(whole, newline=""))
        if head[:-1] != _columns(robot):
            raise ValueError("its columns are others")
        size = 2 + 3 * joints
        values = np.array([[float(cell or "nan") for cell in row[:size]] for row in rows]).reshape(len(rows), size)
    except (OSError, ValueError) as error:
        raise InputError(f"{os.fspath(path)} is no table of telemetry of this robot: {error}") from None
    angles = np.radians(values[:, 2:]).reshape(len(values), 3, robot.legs, len(JOINTS))
    return values[:, 0], angles[:, 1], angles[:, 2]
