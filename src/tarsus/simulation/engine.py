"""MuJoCo, imported when it is first used."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from tarsus.errors import TarsusError

__all__ = ["FAULTY", "engine_problem", "mujoco_module"]

FAULTY = ("4.0.0",)
"""Versions of MuJoCo that compute wrongly: the Newton solver of 4.0.0 factorises wrongly."""


def mujoco_module() -> Any:
    """Return the module `mujoco`.

    Raises
    ------
    TarsusError
        If it is not installed, or a version that computes wrongly.
    """
    try:
        mujoco = import_module("mujoco")
    except ImportError:
        raise TarsusError("the simulation needs MuJoCo; install it with: pip install 'tarsus[sim]'") from None
    if mujoco.__version__ in FAULTY:
        raise TarsusError(
            f"MuJoCo {mujoco.__version__} computes contacts wrongly; install another version with: "
            "pip install 'mujoco!=4.0.0'"
        )
    return mujoco


def engine_problem() -> str | None:
    """Return why physics is not available, and what to install; None if it is available."""
    try:
        mujoco_module()
    except TarsusError as error:
        return str(error)
    return None
