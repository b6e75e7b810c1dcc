"""The messages between studio and browser, as pydantic models; their TypeScript types are generated from them."""

from __future__ import annotations

from typing import Annotated, TypeAlias

from pydantic import Field, TypeAdapter

from tarsus.studio.messages.client import ClientMessage
from tarsus.studio.messages.general import Done, ErrorMessage, FileMessage, SourceMessage
from tarsus.studio.messages.machine import BringUpMessage, CalibrationMessage
from tarsus.studio.messages.motion import DriveFrame, LoadsMessage, ServosMessage, WalkMessage
from tarsus.studio.messages.physics import SimulatedMessage, TerrainMessage
from tarsus.studio.messages.pose import PoseMessage, RobotMessage, StateMessage, Welcome, WorkspaceMessage

__all__ = ["CLOSED", "SOCKET", "ClientMessage", "ServerMessage", "client_message"]

SOCKET = "/session/1"
"""Path of the socket; it ends with the version of the messages, so that outdated pages do not connect."""

CLOSED = {
    "TOKEN": (4401, "Missing or wrong token: open the link that the server printed."),
    "IDLE": (4408, "No message for too long; clients may reconnect."),
    "RATE": (4429, "Too many messages, or too many malformed ones."),
    "FULL": (4503, "The server has reached its number of sessions; clients may retry later."),
    "LARGE": (1009, "A message was larger than `bounds.message_bytes`."),
}
"""Codes with which the server closes the socket, and their reasons."""

ServerMessage: TypeAlias = Annotated[
    Welcome
    | RobotMessage
    | StateMessage
    | PoseMessage
    | WorkspaceMessage
    | WalkMessage
    | LoadsMessage
    | ServosMessage
    | TerrainMessage
    | SimulatedMessage
    | DriveFrame
    | SourceMessage
    | BringUpMessage
    | CalibrationMessage
    | FileMessage
    | ErrorMessage
    | Done,
    Field(discriminator="type"),
]
"""Any message of the server."""

client_message: TypeAdapter[ClientMessage] = TypeAdapter(ClientMessage)
"""Validates the messages of clients."""
