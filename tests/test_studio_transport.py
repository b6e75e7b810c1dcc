"""The transport under the sockets makes as few system calls as possible, and loses nothing."""

import asyncio

from tarsus.studio.server.batched_transport import BatchedTransport


class Recorded:
    """A transport that records what is asked of it."""

    def __init__(self):
        self.calls = []

    def write(self, data):
        self.calls.append(data)

    def is_closing(self):
        return False

    def __getattr__(self, name):
        return lambda: self.calls.append(name)


def calls_of(*steps):
    """What reaches the transport of some steps, each of which ends with an iteration of the event loop."""

    async def run():
        below = Recorded()
        transport = BatchedTransport(below, asyncio.get_running_loop())
        for step in steps:
            for call, *arguments in step:
                getattr(transport, call)(*arguments)
            await asyncio.sleep(0)
        return below.calls

    return asyncio.run(run())


def test_writes_of_one_iteration_are_one_write():
    assert calls_of([("write", b"pose"), ("write", b"done")], [("write", b"next")]) == [b"posedone", b"next"]


def test_what_is_written_is_sent_before_the_end():
    assert calls_of([("write", b"bye"), ("close",)]) == [b"bye", "close"]


def test_reading_is_paused_only_for_messages_that_are_not_received_at_once():
    pause, resume = ("pause_reading",), ("resume_reading",)
    assert calls_of([pause, resume], [pause, resume]) == []
    assert calls_of([pause], [resume]) == ["pause_reading", "resume_reading"]
    assert calls_of([resume]) == ["resume_reading"]
