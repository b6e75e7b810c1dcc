"""Inputs of boards, to which foot switches are connected."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol, runtime_checkable

__all__ = ["InputBoard"]


@runtime_checkable
class InputBoard(Protocol):
    """A board with inputs; `BusCommands.inputs` also tells which buses have them, and how many.

    Attributes
    ----------
    inputs : range
        Numbers of its inputs.
    """

    inputs: range

    def read_inputs(self, numbers: Sequence[int]) -> tuple[float, ...]:
        """Return the levels of inputs: voltages as shares of the highest, or only 0 and 1 from digital inputs.

        Parameters
        ----------
        numbers : sequence of int
            The inputs.

        Raises
        ------
        InputError
            If the board has no such input.
        NoAnswerError, CorruptAnswerError
            If it does not answer, or its answer is damaged.
        PortError
            If the port is gone.
        """

    def input_seconds(self, numbers: Sequence[int]) -> float:
        """Return how long reading inputs takes on the wire [s].

        Parameters
        ----------
        numbers : sequence of int
            The inputs.
        """
