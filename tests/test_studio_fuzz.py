"""A session answers any input and keeps a valid state."""

import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sample_studio import Asked
from tarsus import load_robot
from tarsus.robot.file import robot_to_dict
from tarsus.studio.messages import client as ask
from tarsus.studio.parsing import read
from tarsus.studio.server.inbox import Inbox
from tarsus.studio.server.rate import Rate
from tarsus.studio.session import Session
from tarsus.studio.state_text import state_of, text_of

STRIDER = robot_to_dict(load_robot("strider"))

wild_numbers = st.one_of(
    st.floats(allow_nan=True, allow_infinity=True),
    st.integers(-(2**70), 2**70),
    st.sampled_from([0, -0.0, 1e-300, 1e6, 1e308, -1]),
)
wild = st.recursive(
    st.none() | st.booleans() | wild_numbers | st.text(max_size=20),
    lambda inner: st.lists(inner, max_size=5) | st.dictionaries(st.text(max_size=10), inner, max_size=5),
    max_leaves=12,
)
kinds = st.sampled_from(
    [model.model_fields["type"].annotation.__args__[0] for model in ask.ClientMessage.__args__[0].__args__]
)
keys = st.sampled_from(
    [
        "joints",
        "body",
        "walk",
        "physics",
        "loads",
        "leg",
        "position_mm",
        "preset",
        "document",
        "text",
        "state",
        "view",
        "on",
        "what",
    ]
)


@given(st.binary(max_size=300) | st.text(max_size=300))
def test_arbitrary_input_is_answered_by_an_error(text):
    session = Session()
    answers = session.receive(text)
    assert [answer.type for answer in answers] == ["error", "done"]


@given(wild)
def test_any_json_is_answered(document):
    answers = Session().receive(json.dumps(document))
    assert answers[-1].type == "done"


SESSION = Session()


@given(kinds, st.dictionaries(keys, wild, max_size=4), st.integers(0, 2**53 - 1))
@settings(max_examples=100)
def test_messages_with_arbitrary_content_are_answered(kind, content, number):
    answers = SESSION.receive(json.dumps({"type": kind, "id": number, **content}))
    assert answers[-1].type == "done"
    assert {answer.id for answer in answers} == {number}
    assert not any(answer.type == "error" and answer.kind == "internal" for answer in answers)


@pytest.mark.parametrize(
    "text",
    [
        b"",
        b"null",
        b"[" * 100_000,
        b'{"a":' * 50_000,
        b'{"type": "joints", "id": 1, "joints": {"angles_deg": [NaN]}}',
        b'{"type": "joints", "id": 1, "joints": {"angles_deg": [1e999]}}',
        b'{"type": "joints", "id": 1, "joints": {"angles_deg": ["1"]}}',
        b'{"type": "ping", "id": -1}',
        b'{"type": "ping", "id": 1.5}',
        b'{"type": "ping", "id": true}',
        b'{"type": "ping", "id": 9007199254740992}',
        b'{"type": "ping", "id": 1, "more": 1}',
        b'{"type": "ping", "id": 1}{"type": "ping", "id": 2}',
        b'{"type": "\\ud800", "id": 1}',
        b"\xff\xfe",
        b'{"type": "toml", "id": 1, "text": "' + b"a" * 300_000 + b'"}',
    ],
)
def test_malformed_messages_are_answered_by_an_error(text):
    session = Session()
    before = session.state
    error, done = session.receive(text)
    assert error.kind in ("message", "limit")
    assert len(error.text) < 1000
    assert done.type == "done"
    assert session.state == before


def test_the_size_of_a_message_is_counted_in_bytes():
    assert read("ä" * 60, most=100).kind == "limit"
    assert read("a" * 60, most=100).kind == "message"


moderate = st.floats(-2000, 2000) | st.sampled_from([0.0, 1.0, 100.0])
maybe = st.none() | st.floats(0, 500)
walks = st.fixed_dictionaries(
    {},
    optional={
        "gait": st.sampled_from([None, "tripod", "wave", "ripple", "tetrapod"])
        | st.fixed_dictionaries(
            {"duty_factor": st.floats(0, 1.2), "offsets": st.lists(st.floats(-1, 2), min_size=5, max_size=7)}
        ),
        "path": st.one_of(
            st.fixed_dictionaries({"kind": st.just("straight"), "distance_mm": moderate, "heading_deg": moderate}),
            st.fixed_dictionaries(
                {"kind": st.just("curve"), "angle_deg": moderate, "centre_mm": st.tuples(moderate, moderate)}
            ),
            st.fixed_dictionaries(
                {
                    "kind": st.just("twist"),
                    "velocity_mm_s": st.tuples(moderate, moderate),
                    "turn_deg_s": moderate,
                    "duration_s": st.floats(0, 10),
                }
            ),
        ),
        "stroke_mm": maybe,
        "speed_mm_s": maybe,
        "cycle_time_s": st.none() | st.floats(0, 20),
        "body_height_mm": st.none() | moderate,
        "swing_height_mm": maybe,
        "roll_deg": st.floats(-100, 100),
        "pitch_deg": st.floats(-30, 30),
        "foot_distance_mm": maybe,
        "rate_hz": st.floats(0, 500),
        "strict": st.booleans(),
    },
)
bodies = st.fixed_dictionaries(
    {},
    optional={
        **dict.fromkeys(("x_mm", "y_mm", "z_mm", "roll_deg", "pitch_deg", "yaw_deg"), moderate),
        "body_height_mm": st.none() | moderate,
        "knee": st.sampled_from(["up", "down"]),
        "feet_mm": st.none() | st.lists(moderate, min_size=18, max_size=18),
    },
)


def changed(document, leg, value):
    legs = [{**entry, **({"yaw_deg": value} if index == leg else {})} for index, entry in enumerate(document["legs"])]
    return {**document, "legs": legs, "leg": {**document["leg"], "femur_mm": abs(value) / 10}}


plausible = st.one_of(
    st.fixed_dictionaries({"type": st.just("walk"), "walk": walks, "commit": st.booleans()}),
    st.fixed_dictionaries({"type": st.just("body"), "body": bodies, "commit": st.booleans()}),
    st.fixed_dictionaries(
        {
            "type": st.just("joints"),
            "joints": st.fixed_dictionaries({"angles_deg": st.lists(moderate, min_size=18, max_size=18)}),
            "commit": st.booleans(),
        }
    ),
    st.fixed_dictionaries(
        {"type": st.just("drag_foot"), "leg": st.integers(0, 7), "position_mm": st.tuples(moderate, moderate, moderate)}
    ),
    st.fixed_dictionaries(
        {
            "type": st.just("loads"),
            "loads": st.fixed_dictionaries(
                {}, optional={"payload_kg": st.floats(0, 1000), "supply_v": maybe, "capacity_ah": maybe}
            ),
        }
    ),
    st.fixed_dictionaries({"type": st.just("robot"), "preset": st.sampled_from(["strider", "mithi", "ch3r", "none"])}),
    st.builds(
        lambda leg, value: {"type": "document", "document": changed(STRIDER, leg, value)},
        st.integers(0, 5),
        st.floats(-200, 200),
    ),
    st.fixed_dictionaries(
        {
            "type": st.just("view"),
            "view": st.sampled_from(["joints", "body", "walk", "drive", "loads", "robot", "sources"]),
        }
    ),
    st.fixed_dictionaries({"type": st.sampled_from(["undo", "redo", "ping"])}),
    st.fixed_dictionaries({"type": st.just("workspace"), "leg": st.integers(0, 7)}),
    st.fixed_dictionaries({"type": st.just("download"), "what": st.sampled_from(["csv", "toml", "angles"])}),
    st.fixed_dictionaries({"type": st.just("drive"), "on": st.booleans()}),
    st.fixed_dictionaries(
        {
            "type": st.just("command"),
            "velocity_mm_s": st.tuples(moderate, moderate),
            "turn_deg_s": moderate,
            "gait": st.none() | st.sampled_from(["wave", "tripod", "none"]),
            "body_height_mm": st.none() | moderate,
            "swing_height_mm": maybe,
            "cycle_time_s": maybe,
            "state": st.none() | st.sampled_from(["standing", "lying", "folded"]),
        }
    ),
)


@pytest.mark.no_cover
@given(st.lists(plausible, min_size=1, max_size=8), st.floats(0.001, 0.2))
@settings(max_examples=14)
def test_a_session_survives_any_messages_and_can_be_restored(messages, dt):
    asked = Asked()
    for message in messages:
        kind = message.pop("type")
        answers = asked.all(kind, **message)
        for answer in answers:
            assert answer.get("kind") != "internal", answer
            assert_finite(answer)
        asked.session.frame(dt)
    state = asked.session.state
    assert state_of(text_of(state)) == state
    resumed = Asked().all("hello", state=text_of(state))
    assert resumed[2]["state"] == json.loads(state.model_dump_json())


def assert_finite(value):
    if isinstance(value, dict):
        for item in value.values():
            assert_finite(item)
    elif isinstance(value, list):
        if value and isinstance(value[0], float):
            assert np.isfinite([number for number in value if number is not None]).all()
        else:
            for item in value:
                assert_finite(item)
    elif isinstance(value, float):
        assert math.isfinite(value)


def message(kind, number, **more):
    found = read(json.dumps({"type": kind, "id": number, **more}), most=10_000)
    assert found.type == kind
    return found


def joints(number, *, commit=False):
    return message("joints", number, joints={"angles_deg": [float(number)] * 18}, commit=commit)


def waiting(inbox):
    return [inbox.pop() for _ in range(len(inbox))]


def test_the_newest_message_of_a_type_replaces_older_ones():
    inbox = Inbox(32)
    dropped = [inbox.push(m) for m in (joints(1), message("workspace", 2, leg=0), joints(3), joints(4))]
    assert [[done.id for done in each] for each in dropped] == [[], [], [1], [3]]
    assert all(done.dropped for each in dropped for done in each)
    assert [m.id for m in waiting(inbox)] == [2, 4]


def test_a_replaced_commit_is_kept():
    inbox = Inbox(32)
    inbox.push(joints(1, commit=True))
    inbox.push(joints(2))
    (kept,) = waiting(inbox)
    assert (kept.id, kept.commit, kept.joints.angles_deg[0]) == (2, True, 2.0)


@pytest.mark.parametrize(
    "between", [message("undo", 2), message("robot", 2, preset="mithi"), message("view", 2, view="walk")]
)
def test_ordered_messages_are_not_overtaken(between):
    inbox = Inbox(32)
    for m in (joints(1), between, joints(3)):
        assert inbox.push(m) == []
    assert [m.id for m in waiting(inbox)] == [1, 2, 3]


def test_drags_of_different_feet_are_kept():
    inbox = Inbox(32)
    for number, leg in enumerate((0, 1, 0)):
        inbox.push(message("drag_foot", number, leg=leg, position_mm=[0, 0, number]))
    assert [m.id for m in waiting(inbox)] == [1, 2]


@given(st.lists(plausible, max_size=40))
def test_every_message_is_returned_once_or_dropped(messages):
    inbox, dropped = Inbox(1000), []
    for number, content in enumerate(messages):
        found = read(json.dumps({**content, "id": number}), most=100_000)
        if found.type != "error":
            dropped += [done.id for done in inbox.push(found)]
        else:
            dropped.append(number)
    assert sorted(dropped + [m.id for m in waiting(inbox)]) == list(range(len(messages)))


@given(st.lists(st.floats(0, 0.5), min_size=1, max_size=200), st.floats(1, 100))
def test_a_rate_limit_is_not_exceeded(pauses, per_s):
    rate, now, passed = Rate(per_s, 0.0), 0.0, 0
    for pause in pauses:
        now += pause
        passed += rate.take(now)
    assert passed <= 2 * per_s + per_s * now + 1e-6
    slow = Rate(per_s, 0.0)
    assert all(slow.take(number / per_s * 1.001) for number in range(1, 300))
