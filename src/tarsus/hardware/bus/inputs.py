"""Inputs of boards: what foot switches are connected to."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol, runtime_checkable

__all__ = ["InputBoard"]


@runtime_checkable
class InputBoard(Protocol):
    """A board with inputs; which buses are some, `BusCommands.inputs` tells too.

    Attributes
    ----------
    inputs : range
        Numbers of its inputs.
    """

    inputs: range

    def read_inputs(self, numbers: Sequence[int]) -> tuple[float, ...]:
        """Return the levels of inputs: voltages as shares of the highest, 0 or 1 where the board tells no more.

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
