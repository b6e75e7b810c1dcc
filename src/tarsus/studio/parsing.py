"""Parsing of received messages."""

from __future__ import annotations

from pydantic import ValidationError
from pydantic_core import from_json

from tarsus.studio.error_messages import malformed
from tarsus.studio.messages import ClientMessage, client_message
from tarsus.studio.messages.general import ErrorMessage
from tarsus.studio.problems import problems_of

__all__ = ["read"]

_LARGEST_ID = 2**53 - 1
_MOST_PROBLEMS = 3


def read(text: str | bytes, *, most: int) -> ClientMessage | ErrorMessage:
    """Return the parsed message of a client, or the error that answers malformed input.

    Parameters
    ----------
    text : str or bytes
        JSON.
    most : int
        Greatest size in bytes.
    """
    size = len(text.encode(errors="replace")) if isinstance(text, str) else len(text)
    if size > most:
        return malformed(f"the message has {size} bytes; at most {most} are read").model_copy(update={"kind": "limit"})
    try:
        return client_message.validate_json(text)
    except ValidationError as error:
        return malformed(_text(error), id=_id_of(text))


def _id_of(text: str | bytes) -> int | None:
    try:
        document = from_json(text)
    except ValueError:
        return None
    number = document.get("id") if isinstance(document, dict) else None
    return number if type(number) is int and 0 <= number <= _LARGEST_ID else None


def _text(error: ValidationError) -> str:
    found = problems_of(error, ClientMessage, whole="the message")
    more = f" (and {len(found) - _MOST_PROBLEMS} more)" if len(found) > _MOST_PROBLEMS else ""
    return f"malformed message: {'; '.join(found[:_MOST_PROBLEMS])}{more}"
