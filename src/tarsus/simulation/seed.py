"""Seeds of what is random in simulations."""

from __future__ import annotations

import operator

from tarsus.errors import InputError

__all__ = ["require_seed"]


def require_seed(seed: int) -> int:
    """Return a seed as a plain integer, or refuse it.

    Parameters
    ----------
    seed : int
        The seed.

    Raises
    ------
    InputError
        If it is not a whole number, or negative.
    """
    try:
        number = operator.index(seed)
    except TypeError:
        number = -1
    if number < 0:
        raise InputError(f"seed is {seed!r}; it must be a whole number, not negative")
    return number
