"""Scenarios in which feet once came down, or lifted, faster than the joints can: each was found by driving."""

import pytest

from tarsus.scenario.file import scenario_from_text
from tarsus.scenario.runner import run_scenario

FOUND = (
    "at 0 s: walk 40 mm/s; ground RF -3 mm",
    "at 0 s: walk 40 mm/s; ground RF 3 mm",
    (
        "at 0 s: walk 40 mm/s; gait wave; ground RF 3 mm; "
        "at 3 s: tilt roll 1 deg; stance_width 3 mm; swing_height 15 mm; body_height 85 mm; at 6 s: stop"
    ),
)


@pytest.mark.lengthy
@pytest.mark.parametrize("timeline", FOUND)
@pytest.mark.parametrize("levelling", ["level", "follow"])
def test_the_guard_has_nothing_to_do(timeline, levelling):
    recording = run_scenario(scenario_from_text(timeline, duration=8.0, levelling=levelling), robot="strider")
    assert recording.ok, recording.problems
    assert not recording.interventions
