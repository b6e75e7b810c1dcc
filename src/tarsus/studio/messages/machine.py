"""Messages of the server on machines: what the servos of a robot that runs measure."""

from __future__ import annotations

from pydantic import Field

from tarsus.studio.messages.base import Part

__all__ = ["FrameMachine", "RunOffer"]


class RunOffer(Part):
    """The run that this server belongs to; then only the view Drive is available."""

    bus: str = Field(description="Servos: real or emulated, and their buses.")


class FrameMachine(Part):
    """What the servos of a robot that runs measure, where the frame itself has what is commanded."""

    angles_deg: list[float | None] = Field(
        description="Legs x (coxa, femur, tibia); null for a joint that is not measured."
    )
    behind_deg: float | None = Field(description="Greatest difference of commanded and measured angles.")
    behind_joint: str | None
    voltage_v: float | None = Field(description="Lowest of the supply.")
    temperature_c: float | None = Field(description="Of the warmest servo.")
    temperature_joint: str | None
    rate_hz: float = Field(description="Ticks per second.")
    missed: int = Field(description="Ticks that came too late.")
    stopped: bool = Field(description="Whether the deadman has stopped the robot, as nothing was heard of the driver.")
    problems: list[str] = Field(description="Faults, and what else the servos report.")
