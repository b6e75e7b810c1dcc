"""The front end's types are those of the messages."""

from pathlib import Path

import pytest

from tarsus.studio.messages.general import ErrorMessage
from tarsus.studio.messages.typescript import typescript
from tarsus.studio.parsing import read

COMMITTED = Path(__file__).parent.parent / "web" / "src" / "protocol.ts"


def test_the_committed_types_are_what_the_generator_writes():
    assert COMMITTED.read_text(encoding="utf-8") == typescript(), "run: make protocol"


MALFORMED = {
    '{"type": "ping", "id": 1': "not valid JSON: EOF while parsing an object at line 1 column 24",
    "[1, 2]": "the message is [1, 2]: must be a table of keys",
    "{}": "type: missing",
    '{"type": "jonts"}': "type = \"jonts\": did you mean 'joints'?",
    '{"type": "view", "id": 1, "view": "x"}': "view = \"x\": must be 'joints', 'body', 'walk', 'drive', 'loads', "
    "'robot' or 'sources'",
    '{"type": "ping", "id": 1.5}': "id = 1.5: must be a whole number",
    '{"type": "ping", "id": -1}': "id = -1: must be at least 0",
    '{"type": "joints", "id": 1}': "joints: missing",
    '{"type": "joints", "id": 1, "joints": 3}': "joints = 3: must be a table of keys",
    '{"type": "joints", "id": 1, "joints": {"angles_deg": "x"}}': 'joints.angles_deg = "x": must be a list',
    '{"type": "joints", "id": 1, "joints": {"angles_deg": ["a", 1e9, NaN]}}': 'joints.angles_deg[0] = "a": must be a '
    "number; joints.angles_deg[1] = 1000000000.0: must be at most 3600; joints.angles_deg[2] = nan: must be a finite "
    "number",
    '{"type": "joints", "id": 1, "joints": {"angle_deg": []}}': "joints.angle_deg: unknown key; did you mean "
    "'angles_deg'?",
    '{"type": "joints", "id": 1, "joints": {}, "commit": "yes"}': 'commit = "yes": must be true or false',
    '{"type": "walk", "id": 1, "walk": {"gait": 3}}': "walk.gait = 3: must be text; walk.gait = 3: must be a table "
    "of keys",
    '{"type": "walk", "id": 1, "walk": {"gait": {"duty_factor": -1, "offsets": []}}}': "walk.gait: must be text; "
    "walk.gait.duty_factor = -1: must be at least 0",
    '{"type": "walk", "id": 1, "walk": {"path": {"kind": "strait"}}}': 'walk.path.kind = "strait": did you mean '
    "'straight'?",
    '{"type": "walk", "id": 1, "walk": {"path": {"kind": "curve", "centre_mm": [1]}}}': "walk.path.angle_deg: missing; "
    "negative is clockwise; walk.path.centre_mm[1]: missing",
    '{"type": "body", "id": 1, "body": {"x_mm": null}}': "body.x_mm = null: must be a number",
    '{"type": "workspace", "id": 1, "leg": 100}': "leg = 100: must be less than 100",
    '{"type": "document", "id": 1, "document": []}': "document = []: must be a table of keys",
}


@pytest.mark.parametrize("text", MALFORMED)
def test_a_malformed_message_is_answered_in_the_words_of_robot_files(text):
    error = read(text, most=1000)
    assert isinstance(error, ErrorMessage)
    assert error.text == f"malformed message: {MALFORMED[text]}"


def test_a_text_that_is_too_long_is_answered_with_its_length():
    error = read('{"type": "toml", "id": 1, "text": "' + "a" * 200_001 + '"}', most=10**6)
    assert error.text.endswith("a...: has 200001 characters; at most 200000")
