"""Limitations as values and as text."""

import math

import pytest

from tarsus.control.limitation import Cause, Limitation, LimitationKind


@pytest.mark.parametrize(
    ("values", "text"),
    [
        (
            {"kind": LimitationKind.TWIST, "cause": "workspace", "leg": "rear left", "asked": 1.0, "granted": 0.714},
            "twist: 71 % of the command; rear left: workspace",
        ),
        (
            {"kind": LimitationKind.BODY_HEIGHT, "cause": "end of reach", "asked": 0.4, "granted": 0.2763},
            "body_height: 276.3 mm instead of 400 mm; end of reach",
        ),
        (
            {"kind": LimitationKind.CYCLE_TIME, "cause": "too short", "asked": 0.2, "granted": 0.8125},
            "cycle_time: 0.8125 s instead of 0.2 s; too short",
        ),
        (
            {
                "kind": LimitationKind.ATTITUDE,
                "cause": "tilt",
                "asked": 0.0,
                "granted": math.pi / 4,
                "bound": math.pi / 9,
            },
            "attitude: 45 deg instead of 0 deg, bound 20 deg; tilt",
        ),
        ({"kind": LimitationKind.CYCLE_TIME, "cause": "x", "granted": 2.0}, "cycle_time: 2 s; x"),
        ({"kind": LimitationKind.GAIT, "cause": "", "leg": "LF", "joint": "coxa"}, "gait: LF coxa"),
        ({"kind": LimitationKind.READINGS, "cause": "too old"}, "readings: too old"),
    ],
)
def test_the_text_has_the_numbers_in_their_units(values, text):
    assert Limitation(**values).text() == text


@pytest.mark.parametrize(
    ("margin", "least", "text"),
    [
        (-0.039, 0.01, "support, 39 mm outside its support polygon (at least 10 mm inside needed)"),
        (0.004, math.nan, "support, 4 mm inside its support polygon"),
        (-math.inf, 0.01, "support, without a support polygon"),
        (math.nan, math.nan, "support"),
    ],
)
def test_a_stability_margin_is_described_by_its_side(margin, least, text):
    cause = Cause("support", margin=margin, least_margin=least)
    assert cause.text() == text
    limitation = cause.limitation(LimitationKind.FOOT_TARGET, asked=1.0, granted=0.0)
    assert limitation.text() == f"foot_target: 0 % of the command; {text}"


def test_the_key_is_all_but_the_numbers():
    first = Limitation(kind=LimitationKind.TWIST, cause="workspace", leg="rear left", asked=1.0, granted=0.7)
    second = Limitation(kind=LimitationKind.TWIST, cause="workspace", leg="rear left", asked=1.0, granted=0.6)
    assert first != second
    assert first.key == second.key == ("twist", "workspace", "rear left", "")
