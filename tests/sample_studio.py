"""What the tests of the studio share: a session that is asked and answers."""

from __future__ import annotations

import json

import numpy as np

from tarsus.studio.session import Session


class Asked:
    """A session, and shorthand for asking it."""

    def __init__(self, session: Session | None = None) -> None:
        self.session = Session() if session is None else session
        self.count = 0

    def all(self, kind: str, **more: object) -> list:
        """All answers to a message, as the documents that go over the wire; the last is `done`."""
        self.count += 1
        answers = self.session.receive(json.dumps({"type": kind, "id": self.count, **more}))
        documents = [json.loads(answer.model_dump_json()) for answer in answers]
        assert {document["id"] for document in documents} == {self.count}
        assert [document["type"] for document in documents].index("done") == len(documents) - 1
        return documents

    def __call__(self, kind: str, wanted: str, **more: object) -> dict:
        """The one answer of a type."""
        found = [document for document in self.all(kind, **more) if document["type"] == wanted]
        assert len(found) == 1, found
        return found[0]

    def types(self, kind: str, **more: object) -> list[str]:
        """The types of all answers."""
        return [document["type"] for document in self.all(kind, **more)]

    def error(self, kind: str, **more: object) -> dict:
        """The error that a message is answered by; the state stays what it was."""
        before = self.session.state
        found = self(kind, "error", **more)
        assert self.session.state == before
        return found


def table(values: list[float], *tail: int) -> np.ndarray:
    """A flat list of the wire as an array."""
    return np.array(values, dtype=float).reshape(-1, *tail)
