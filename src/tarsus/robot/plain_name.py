"""Names of robots and legs: text without control characters, which XML files can't hold."""

from __future__ import annotations

import re

from tarsus.errors import InputError

__all__ = ["PLAIN", "control_character", "require_plain_name"]

_CONTROLS = r"\u0000-\u001f\u007f-\u009f\ufffe\uffff"

PLAIN = f"^[^{_CONTROLS}]*$"
"""Regular expression of names, in the syntax that JSON schemas and Python share."""

_CONTROL = re.compile(rf"[{_CONTROLS}\ud800-\udfff]")


def control_character(text: str) -> str:
    """Return the code of the first control character in a text, such as ``"U+0001"``; an empty string without one.

    Parameters
    ----------
    text : str
        The text.
    """
    found = _CONTROL.search(text)
    return f"U+{ord(found[0]):04X}" if found else ""


def require_plain_name(what: str, name: object) -> None:
    """Refuse anything that is not text without control characters.

    Parameters
    ----------
    what : str
        What has the name, for messages.
    name : object
        Expected: a name.

    Raises
    ------
    InputError
        If it is not text, or contains a control character.
    """
    if not isinstance(name, str):
        raise InputError(f"{what} is {name!r}; it must be text")
    if code := control_character(name):
        raise InputError(f"{what} is {name!r}; it must not contain control characters, such as {code}")
