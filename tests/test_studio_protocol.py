"""The front end's types are those of the messages."""

from pathlib import Path

from tarsus.studio.messages.typescript import typescript

COMMITTED = Path(__file__).parent.parent / "web" / "src" / "protocol.ts"


def test_the_committed_types_are_what_the_generator_writes():
    assert COMMITTED.read_text(encoding="utf-8") == typescript(), "run: make protocol"
