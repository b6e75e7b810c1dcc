"""Conversion of millimetres, grams and degrees in files to SI and back, exact to the bit.

Numbers in files are decimals. Computed as decimals and rounded once, 68 mm is the double nearest to 0.068 m and
converts back to 68; ``68 / 1000 * 1000`` in doubles does not in general.
"""

from __future__ import annotations

from decimal import Context, Decimal

__all__ = ["degrees", "from_milli", "per_degree", "per_radian", "radians", "to_decimal", "to_milli"]

# More digits than the 17 of a double, so that each conversion is rounded once, at its end; no traps, whatever
# the decimal context of the calling program.
_CONTEXT = Context(prec=60, traps=[])
_PI = Decimal("3.14159265358979323846264338327950288419716939937510582097494459")
_DIGITS_OF_A_DOUBLE = 17


def to_decimal(value: float) -> Decimal:
    """Return the shortest decimal that reads back as the double `value`."""
    return Decimal(repr(float(value)))


def from_milli(value: Decimal) -> float:
    """Return a thousandth: mm to m, g to kg."""
    return float(_CONTEXT.scaleb(value, -3))


def to_milli(value: float) -> Decimal:
    """Return a thousandfold: m to mm, kg to g; `from_milli` returns the same double."""
    return _CONTEXT.scaleb(to_decimal(value), 3)


def radians(value: Decimal) -> float:
    """Return the double nearest to an angle of `value` degrees."""
    return float(_CONTEXT.divide(_CONTEXT.multiply(value, _PI), Decimal(180)))


def degrees(value: float) -> Decimal:
    """Return the shortest decimal of degrees that `radians` converts to the same double."""
    if value == 0:
        return to_decimal(value)
    exact = _CONTEXT.divide(_CONTEXT.multiply(Decimal(value), Decimal(180)), _PI)
    # 17 digits always suffice: half a unit of the 17th is less than half the distance between doubles.
    roundings = (Context(prec=digits, traps=[]).plus(exact) for digits in range(1, _DIGITS_OF_A_DOUBLE + 1))
    return next(rounded for rounded in roundings if radians(rounded) == value)


def per_radian(value: Decimal) -> float:
    """Return a quantity of `value` per degree as the nearest double per radian."""
    return float(_CONTEXT.divide(_CONTEXT.multiply(value, Decimal(180)), _PI))


def per_degree(value: float) -> Decimal:
    """Return the shortest decimal per degree that `per_radian` converts to the same double."""
    exact = _CONTEXT.divide(_CONTEXT.multiply(Decimal(value), _PI), Decimal(180))
    roundings = (Context(prec=digits, traps=[]).plus(exact) for digits in range(1, _DIGITS_OF_A_DOUBLE + 1))
    return next(rounded for rounded in roundings if per_radian(rounded) == value)
