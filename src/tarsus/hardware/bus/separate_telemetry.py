"""Telemetry that takes a separate request for each value."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol, runtime_checkable

from tarsus.hardware.bus.answers import Answers, Telemetry

__all__ = ["SeparateTelemetry"]


@runtime_checkable
class SeparateTelemetry(Protocol):
    """A bus that reads a single value of telemetry in less time than all of them."""

    def read_one(self, value: str, ids: Sequence[int]) -> Answers[Telemetry]:
        """Return one value of what servos measure; the others are None.

        Parameters
        ----------
        value : str
            One of the bus's `Capabilities.telemetry`.
        ids : sequence of int
            The servos.
        """
