"""The state as a short text that a link can hold, and back.

The text is the version, a dot, and the state's JSON, compressed, in the URL-safe alphabet of base 64 (RFC 4648).
What has its default value is left out: a preset in its rest stance takes a dozen characters.
"""

from __future__ import annotations

import base64
import binascii
import zlib

from pydantic import ValidationError

from tarsus.errors import InputError
from tarsus.robot.document_problems import key_of
from tarsus.studio.messages.state import StudioState

__all__ = ["state_of", "text_of"]

_VERSION = "1"
# What a text may unfold to: a robot file of a hundred legs, each with keys of its own, has a tenth of it.
_LARGEST = 2**20


def text_of(state: StudioState) -> str:
    """Return the text that holds a state.

    Parameters
    ----------
    state : StudioState
        The state.
    """
    document = state.model_dump_json(exclude_defaults=True).encode()
    # Raw deflate: the frame that zlib puts around it would cost eight characters.
    packer = zlib.compressobj(level=9, wbits=-15)
    packed = packer.compress(document) + packer.flush()
    return f"{_VERSION}.{base64.urlsafe_b64encode(packed).decode('ascii').rstrip('=')}"


def state_of(text: str) -> StudioState:
    """Return the state that a text holds.

    Parameters
    ----------
    text : str
        From `text_of`.

    Raises
    ------
    InputError
        If it is no such text.
    """
    version, dot, packed = text.strip().partition(".")
    if not dot:
        raise InputError("this link holds no state of the studio: it must begin with a version and a dot")
    if version != _VERSION:
        raise InputError(f"this link was made by version {version[:20]!r} of the studio; this one reads {_VERSION!r}")
    try:
        content = base64.b64decode(packed + "=" * (-len(packed) % 4), altchars=b"-_", validate=True)
        unpacker = zlib.decompressobj(wbits=-15)
        document = unpacker.decompress(content, _LARGEST)
        if not unpacker.eof:
            raise InputError("this link is cut off, or holds more than any state of the studio")
        return StudioState.model_validate_json(document)
    except (binascii.Error, ValueError, zlib.error) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"this link is damaged: {_reason(error)}") from None


def _reason(error: Exception) -> str:
    if isinstance(error, ValidationError):
        first = error.errors(include_url=False, include_input=False)[0]
        return f"{key_of(first['loc']) or 'the state'}: {first['msg'].lower()}"
    return "it is not the text that was copied"
