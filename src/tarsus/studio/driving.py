"""Live walking: the walker that a visitor drives."""

from __future__ import annotations

from tarsus.errors import TarsusError
from tarsus.robot.robot import Robot
from tarsus.studio.messages.client import Wish
from tarsus.studio.messages.moving import DriveFrame

__all__ = ["Driver"]


class Driver:
    """A live walker, and what it is wished to do."""

    def __init__(self, robot: Robot, *, id: int) -> None:
        self.id = id
        raise TarsusError("live walking is not there yet")

    def wish(self, wish: Wish) -> None:
        """Take a wish."""

    def step(self, dt: float) -> DriveFrame:
        """Go on."""
        raise NotImplementedError
