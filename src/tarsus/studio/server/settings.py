"""How a studio is served: where, to whom, and how much of it."""

from __future__ import annotations

import ipaddress
import re
import secrets
from dataclasses import dataclass, field

from tarsus.errors import InputError
from tarsus.studio.messages.state import StudioState
from tarsus.studio.messages.pose import Bounds
from tarsus.studio.walks import MOST_SAMPLES

__all__ = ["Limits", "Settings", "is_loopback"]


@dataclass(frozen=True, kw_only=True)
class Limits:
    """What one visitor, and all of them together, may use.

    Attributes
    ----------
    message_bytes : int
        Size of a message.
    messages_per_s : float
        Messages a second, lasting; twice as many at once.
    malformed : int
        Messages that are none, or too many, before the session is ended.
    sessions : int
        Sessions at a time.
    idle_s : float
        Without a message for so long a session ends [s].
    waiting : int
        Messages of one visitor that wait for their turn.
    frame_hz : float
        Live frames a second.
    threads : int
        Sessions that are worked on at the same time.
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
        """What a client is told of them."""
        return Bounds(
            message_bytes=self.message_bytes,
            messages_per_s=self.messages_per_s,
            plan_samples=MOST_SAMPLES,
            idle_s=self.idle_s,
        )


@dataclass(frozen=True, kw_only=True)
class Settings:
    """A server's settings.

    Attributes
    ----------
    host : str
        Address that it listens at.
    port : int
        Port that it listens at.
    public : bool
        Whether anybody may come in without a token, to the simulator and nothing else.
    token : str or None
        What a visitor must know; None where nobody has to.
    start : StudioState
        What a new session begins with.
    limits : Limits
        How much a visitor may use.

    Raises
    ------
    InputError
        If the token has characters that a link or a cookie can't hold as they are.
    """

    host: str = "127.0.0.1"
    port: int = 0
    public: bool = False
    token: str | None = None
    start: StudioState = field(default_factory=StudioState)
    limits: Limits = field(default_factory=Limits)

    def __post_init__(self) -> None:
        if self.token is not None and not re.fullmatch(r"[A-Za-z0-9._~-]{1,200}", self.token):
            raise InputError("a token is 1 to 200 letters and digits, dots, dashes, underscores and tildes")

    @property
    def loopback(self) -> bool:
        """Whether only this machine can come in."""
        return is_loopback(self.host)

    @property
    def cookie(self) -> str:
        """Name of the cookie that keeps the token: cookies don't tell one port from another."""
        return f"tarsus_studio_{self.port}"

    @staticmethod
    def new_token() -> str:
        """Return a token that can't be guessed."""
        return secrets.token_urlsafe(18)


def is_loopback(host: str) -> bool:
    """Return whether an address is this machine's own, for itself alone.

    Parameters
    ----------
    host : str
        An address or a name.
    """
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return False
