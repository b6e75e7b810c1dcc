"""Settings of the server: address, access, limits."""

from __future__ import annotations

import ipaddress
import re
import secrets
from dataclasses import dataclass, field

from tarsus.errors import InputError
from tarsus.studio.machine.calibration import CalibrationText
from tarsus.studio.machine.driven_run import DrivenRun
from tarsus.studio.machine.hardware import Hardware
from tarsus.studio.messages.pose import Bounds
from tarsus.studio.messages.state import StudioState
from tarsus.studio.walks import MOST_SAMPLES

__all__ = ["Limits", "Settings", "is_loopback"]


@dataclass(frozen=True, kw_only=True)
class Limits:
    """Limits per visitor and of the whole server.

    Attributes
    ----------
    message_bytes : int
        Greatest size of a message [bytes].
    messages_per_s : float
        Sustained messages per second; bursts may have twice as many.
    malformed : int
        Number of malformed or excess messages in succession that are tolerated; one more ends the session.
    sessions : int
        Simultaneous sessions.
    idle_s : float
        Time without messages after which a session ends [s].
    waiting : int
        Queued messages per visitor.
    frame_hz : float
        Frames of driving per second.
    threads : int
        Sessions that are processed simultaneously.
    """

    message_bytes: int = 256 * 1024
    messages_per_s: float = 120.0
    malformed: int = 200
    sessions: int = 40
    idle_s: float = 3600.0
    waiting: int = 32
    frame_hz: float = 60.0
    threads: int = 4

    @property
    def bounds(self) -> Bounds:
        """The limits that are sent to clients."""
        return Bounds(
            message_bytes=self.message_bytes,
            messages_per_s=self.messages_per_s,
            plan_samples=MOST_SAMPLES,
            idle_s=self.idle_s,
        )


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Settings of a server.

    Attributes
    ----------
    host : str
        Address to listen on.
    port : int
        Port to listen on.
    public : bool
        Whether the server is open without a token, and has no access to hardware.
    token : str or None
        Secret of the link; None if none is required.
    start : StudioState
        Initial state of sessions.
    limits : Limits
        Limits per visitor and of the server.
    run : DrivenRun or None
        The run of a machine that this server belongs to.
    hardware : Hardware or None
        The servos of this computer; None for no access to them.
    calibration : CalibrationText or None
        The calibration whose pulses are shown.

    Raises
    ------
    InputError
        If the token has characters that links or cookies do not allow, or a public server has access to hardware.
    """

    host: str = "127.0.0.1"
    port: int = 0
    public: bool = False
    token: str | None = None
    start: StudioState = field(default_factory=StudioState)
    limits: Limits = field(default_factory=Limits)
    run: DrivenRun | None = None
    hardware: Hardware | None = None
    calibration: CalibrationText | None = None

    def __post_init__(self) -> None:
        if self.token is not None and not re.fullmatch(r"[A-Za-z0-9._~-]{1,200}", self.token):
            raise InputError("the token must have 1 to 200 letters, digits, dots, dashes, underscores or tildes")
        if self.public and (self.hardware is not None or self.run is not None):
            raise InputError("a public server has no access to hardware: any visitor could move the servos")

    @property
    def loopback(self) -> bool:
        """Whether only this machine can connect."""
        return is_loopback(self.host)

    @property
    def cookie(self) -> str:
        """Name of the cookie with the token; it contains the port, as browsers share cookies between ports."""
        return f"tarsus_studio_{self.port}"

    @staticmethod
    def new_token() -> str:
        """Return a random token."""
        return secrets.token_urlsafe(18)


def is_loopback(host: str) -> bool:
    """Return whether an address is a loopback address.

    Parameters
    ----------
    host : str
        Address or host name.
    """
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return False
