"""Gymnasium, which an extra installs."""

from __future__ import annotations

from importlib import import_module

from tarsus.errors import TarsusError

__all__ = ["require_gymnasium"]


def require_gymnasium() -> None:
    """Refuse to go on without Gymnasium, and say what installs it.

    Raises
    ------
    TarsusError
        If it is not installed.
    """
    try:
        import_module("gymnasium")
    except ImportError:
        raise TarsusError("the environments need Gymnasium; install it with: pip install 'tarsus[rl]'") from None
