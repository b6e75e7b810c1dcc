"""A value of a robot that is not plausible."""

from __future__ import annotations

from dataclasses import dataclass

from tarsus.representation import represented

__all__ = ["PlausibilityWarning"]


@represented()
@dataclass(frozen=True, kw_only=True)
class PlausibilityWarning:
    """A value that no robot like this one has, and its likely cause.

    Attributes
    ----------
    code : str
        Kind of the warning, such as ``"limits-unit"``.
    where : str
        The key, and the leg where not all legs are meant.
    what : str
        The number against its bound.
    cause : str
        The likely cause, or several, the likeliest first.
    remedy : str
        What would be plausible.
    """

    code: str
    where: str
    what: str
    cause: str
    remedy: str

    def text(self) -> str:
        """Describe the warning in a line."""
        return f"{self.where}: {self.what}. Likely cause: {self.cause}. {self.remedy}"
