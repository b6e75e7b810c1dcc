"""Encoding of the state as a short text for links, and decoding.

The text is the version, a dot, and the compressed JSON of the state in URL-safe base 64 (RFC 4648). Default values are
omitted: a preset in its default stance takes a dozen characters.
"""

from __future__ import annotations

import base64
import binascii
import zlib

from pydantic import ValidationError

from tarsus.errors import InputError
from tarsus.studio.messages.state import StudioState
from tarsus.studio.problems import problems_of

__all__ = ["state_of", "text_of"]

_VERSION = "1"
# Greatest decompressed size [bytes]; a robot file of 100 legs with individual keys has a tenth of it.
_LARGEST = 2**20


def text_of(state: StudioState) -> str:
    """Return the text of a state.

    Parameters
    ----------
    state : StudioState
        The state.
    """
    document = state.model_dump_json(exclude_defaults=True).encode()
    # Raw deflate, as the zlib header and checksum take eight characters.
    packer = zlib.compressobj(level=9, wbits=-15)
    packed = packer.compress(document) + packer.flush()
    return f"{_VERSION}.{base64.urlsafe_b64encode(packed).decode('ascii').rstrip('=')}"


def state_of(text: str) -> StudioState:
    """Return the state of a text.

    Parameters
    ----------
    text : str
        From `text_of`.

    Raises
    ------
    InputError
        If the text is not valid.
    """
    version, dot, packed = text.strip().partition(".")
    if not dot:
        raise InputError("this link has no state of the studio: it must start with a version and a dot")
    if version != _VERSION:
        raise InputError(f"this link has version {version[:20]!r}; this studio supports version {_VERSION!r}")
    try:
        content = base64.b64decode(packed + "=" * (-len(packed) % 4), altchars=b"-_", validate=True)
        unpacker = zlib.decompressobj(wbits=-15)
        document = unpacker.decompress(content, _LARGEST)
        if not unpacker.eof:
            raise InputError("this link is truncated, or too large")
        return StudioState.model_validate_json(document)
    except (binascii.Error, ValueError, zlib.error) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"this link is damaged: {_reason(error)}") from None


def _reason(error: Exception) -> str:
    if isinstance(error, ValidationError):
        return problems_of(error, StudioState, whole="the state")[0]
    return "the text has been changed"
