"""The state as the text of a link, and undo compared with a list of states."""

import base64
import re
import zlib

import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from tarsus import InputError, list_robots, load_robot
from tarsus.robot.file import robot_to_dict
from tarsus.studio.history import History
from tarsus.studio.messages.physics import PhysicsOptions, TerrainChoice
from tarsus.studio.messages.state import (
    BodyState,
    Curve,
    JointsState,
    LoadOptions,
    OwnGait,
    Picture,
    RobotChoice,
    SourceChoice,
    Straight,
    StudioState,
    Twist,
    WalkOptions,
)
from tarsus.studio.state_text import state_of, text_of

numbers = st.floats(-1000, 1000)
states = st.builds(
    StudioState,
    view=st.sampled_from(["joints", "body", "walk", "drive", "loads", "robot", "sources"]),
    robot=st.sampled_from([RobotChoice(preset=name) for name in list_robots()])
    | st.just(RobotChoice(preset=None, document=robot_to_dict(load_robot("strider")))),
    joints=st.builds(JointsState, angles_deg=st.none() | st.tuples(*[numbers] * 18)),
    body=st.builds(BodyState, x_mm=numbers, yaw_deg=numbers, knee=st.sampled_from(["up", "down"])),
    physics=st.builds(
        PhysicsOptions,
        on=st.booleans(),
        terrain=st.builds(TerrainChoice, kind=st.sampled_from(["flat", "blocks"]), values=st.just({"rise": 20.5})),
    ),
    walk=st.builds(
        WalkOptions,
        gait=st.sampled_from([None, "wave", OwnGait(duty_factor=0.6, offsets=(0.1,) * 6)]),
        path=st.builds(Straight, kind=st.just("straight"), distance_mm=numbers)
        | st.builds(Curve, kind=st.just("curve"), angle_deg=numbers)
        | st.builds(
            Twist,
            kind=st.just("twist"),
            velocity_mm_s=st.tuples(numbers, numbers),
            turn_deg_s=numbers,
            duration_s=st.floats(0, 10),
        ),
        stroke_mm=st.none() | st.floats(0, 100),
    ),
    loads=st.builds(LoadOptions, payload_kg=st.floats(0, 5), supply_v=st.none() | st.floats(0, 20)),
    source=st.builds(SourceChoice, number=st.sampled_from(["000", "004"]), leg=st.integers(0, 5)),
    picture=st.builds(Picture, eye_mm=st.none() | st.tuples(numbers, numbers, numbers)),
)


@given(states)
def test_a_state_is_restored_exactly_from_its_text(state):
    text = text_of(state)
    assert re.fullmatch(r"1\.[A-Za-z0-9_-]+", text)
    assert state_of(text) == state


def test_the_text_of_a_default_state_is_short():
    assert len(text_of(StudioState())) < 12
    posed = StudioState(view="joints", joints=JointsState(angles_deg=(0.0, 36.137594, -123.231111) * 6))
    assert len(text_of(posed)) < 150
    own = StudioState(robot=RobotChoice(preset=None, document=robot_to_dict(load_robot("phantomx"))))
    assert len(text_of(own)) < 2500


def packed(document):
    packer = zlib.compressobj(wbits=-15)
    return "1." + base64.urlsafe_b64encode(packer.compress(document) + packer.flush()).decode().rstrip("=")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "no state"),
        ("nonsense", "no state"),
        ("2.q64FAA", "version '2'"),
        ("1.", "truncated"),
        ("1.q64F", "truncated"),
        ("1.%%%", "damaged"),
        ("1.AAAA", "truncated"),
        ("1.____", "damaged"),
        (packed(b"[1, 2]"), "damaged: the state is [1, 2]: must be a table of keys"),
        (packed(b'{"view": "cellar"}'), "damaged: view = \"cellar\": must be 'joints', 'body', 'walk'"),
        (packed(b'{"view": "walk", "more": 1}'), "damaged: more"),
        (packed(b'{"joints": {"angles_deg": [1e999]}}'), "damaged: joints.angles_deg"),
        (packed(b" " * 2**21), "too large"),
    ],
)
def test_an_invalid_text_is_rejected(text, words):
    with pytest.raises(InputError, match=re.escape(words)):
        state_of(text)


@given(st.text(max_size=200))
def test_any_invalid_text_is_rejected_by_an_input_error(text):
    with pytest.raises(InputError, match="link"):
        state_of(text.replace(".", ","))
    try:
        found = state_of(f"1.{text}")
    except InputError:
        return
    assert isinstance(found, StudioState)


def at(x):
    return StudioState(body=BodyState(x_mm=float(x)))


class Histories(RuleBasedStateMachine):
    """`History` against lists of the states before and after."""

    def __init__(self):
        super().__init__()
        self.history = History(at(0))
        self.past, self.committed, self.future, self.present = [], 0, [], 0

    @rule(x=st.integers(0, 3), commit=st.booleans())
    def change(self, x, commit):
        self.history.change(at(x).model_copy(update={"picture": self.history.present.picture}), commit=commit)
        self.present = x
        if x != self.committed:
            self.future = []
            if commit:
                self.past.append(self.committed)
                self.committed = x

    @rule(time=st.floats(0, 5))
    def look(self, time):
        self.history.look("walk", Picture(time_s=time))
        self.looked = time

    def _settle(self):
        """What was not committed is one step to take back."""
        if self.present != self.committed:
            self.past.append(self.committed)
            self.committed = self.present

    @precondition(lambda self: self.past or self.present != self.committed)
    @rule()
    def undo(self):
        self._settle()
        self.future.append(self.committed)
        self.committed = self.present = self.past.pop()
        assert self.history.undo().body.x_mm == self.present

    @precondition(lambda self: self.future and self.present == self.committed)
    @rule()
    def redo(self):
        self.past.append(self.committed)
        self.committed = self.present = self.future.pop()
        assert self.history.redo().body.x_mm == self.present

    @invariant()
    def same(self):
        assert self.history.present.body.x_mm == self.present
        assert self.history.can_redo == bool(self.future)
        assert self.history.can_undo == (bool(self.past) or self.present != self.committed)
        if hasattr(self, "looked"):
            assert self.history.present.picture.time_s == self.looked


TestHistories = Histories.TestCase


def test_the_number_of_undo_steps_is_limited():
    history = History(at(0))
    for x in range(1, 500):
        history.change(at(x), commit=True)
    undone = 0
    while history.can_undo:
        history.undo()
        undone += 1
    assert undone == 100
    with pytest.raises(InputError, match="nothing to undo"):
        history.undo()
