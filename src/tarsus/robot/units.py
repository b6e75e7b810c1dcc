"""From a file's millimetres, grams and degrees to SI and back, without losing a bit.

A file's numbers are decimals. Worked out as decimals and rounded once, 68 mm is the double nearest to 0.068 m
and comes back as 68; ``68 / 1000 * 1000`` in doubles would not always.
"""

from __future__ import annotations

from decimal import Context, Decimal

__all__ = ["degrees", "from_milli", "radians", "to_decimal", "to_milli"]

# Far more digits than a double's 17, so that each conversion is rounded once, at its end; and no traps,
# whatever the decimal settings of the program that imports us.
_CONTEXT = Context(prec=60, traps=[])
_PI = Decimal("3.14159265358979323846264338327950288419716939937510582097494459")
_DIGITS_OF_A_DOUBLE = 17


def to_decimal(value: float) -> Decimal:
    """Return the shortest decimal that reads back as the double `value`."""
    return Decimal(repr(float(value)))


def from_milli(value: Decimal) -> float:
    """Return a thousandth: mm as m, g as kg."""
    return float(_CONTEXT.scaleb(value, -3))


def to_milli(value: float) -> Decimal:
    """Return a thousandfold: m as mm, kg as g; `from_milli` gives the same double back."""
    return _CONTEXT.scaleb(to_decimal(value), 3)


def radians(value: Decimal) -> float:
    """Return the double nearest to an angle of `value` degrees."""
    return float(_CONTEXT.divide(_CONTEXT.multiply(value, _PI), Decimal(180)))


def degrees(value: float) -> Decimal:
    """Return the shortest decimal of degrees that `radians` turns into the same double."""
    if value == 0:
        return to_decimal(value)
    exact = _CONTEXT.divide(_CONTEXT.multiply(Decimal(value), Decimal(180)), _PI)
    # The last of them always does: half a unit of a 17th digit is less than half the distance between doubles.
    roundings = (Context(prec=digits, traps=[]).plus(exact) for digits in range(1, _DIGITS_OF_A_DOUBLE + 1))
    return next(rounded for rounded in roundings if radians(rounded) == value)
