"""Units in which a length may have been typed instead of mm."""

from __future__ import annotations

from collections.abc import Callable

__all__ = ["unit_causes"]

# Units in which lengths may have been typed that are too small or too large, with their size in mm. Factors of 10 and
# 0.1 also stand for a digit that is missing or too many.
_TOO_SMALL = (("cm", 10.0), ("inches", 25.4), ("m", 1000.0))
_TOO_LARGE = (("tenths of a mm", 0.1),)


def unit_causes(length: float, fits: Callable[[float], bool], *, too_small: bool) -> tuple[str, str]:
    """Return the likely causes of a length that is not plausible, and what it would be in mm.

    Parameters
    ----------
    length : float
        The length as typed [mm].
    fits : callable
        Takes a factor; returns whether the length times the factor is plausible.
    too_small : bool
        Whether the length is too small; else it is too large.

    Returns
    -------
    cause, remedy : str
        As in `PlausibilityWarning`.
    """
    known = _TOO_SMALL if too_small else _TOO_LARGE
    found = [(unit, factor) for unit, factor in known if fits(factor)]
    if not found:
        return f"a typing error: lengths are in mm, and this is too {'small' if too_small else 'large'}", "Measure it"
    units = " or ".join(unit for unit, _ in found)
    lengths = " or ".join(f"{length * factor:.4g}" for _, factor in found)
    slip = ", or a digit is missing" if too_small else ", or there is a digit too many"
    return (
        f"these look like {units} instead of mm{slip if found[0][1] in (10.0, 0.1) else ''}",
        f"In mm it would be {lengths}",
    )
