"""A visitor: a WebSocket and its session."""

from __future__ import annotations

import asyncio
import contextlib
import math
from collections.abc import Sequence
from concurrent.futures import Executor
from typing import TYPE_CHECKING

from starlette.websockets import WebSocketDisconnect

from tarsus.studio.error_messages import malformed
from tarsus.studio.messages import CLOSED
from tarsus.studio.messages import client as ask
from tarsus.studio.messages.general import Done, ErrorMessage
from tarsus.studio.parsing import read
from tarsus.studio.server.inbox import Inbox
from tarsus.studio.server.rate import Rate
from tarsus.studio.server.settings import Settings
from tarsus.studio.session import Session

if TYPE_CHECKING:
    from fastapi import WebSocket
    from pydantic import BaseModel

    from tarsus.studio.messages import ClientMessage
    from tarsus.studio.messages.machine import BringUpMessage
    from tarsus.studio.messages.motion import DriveFrame

__all__ = ["Visitor"]

# Messages that take only 1 to 2 ms and are processed in the event loop: a thread would double that time.
_QUICK = (ask.Ping, ask.SetJoints, ask.Command)

# Longest tick, however late its frame is [s]: in a longer one the robot would jump.
_LONGEST_STEP = 0.05


# Longest interval between checks whether the session is idle [s].
_LONGEST_SLEEP = 600.0


class _SessionEnd(Exception):  # noqa: N818 - not an error
    """The end of the session, with the reason for the client."""

    def __init__(self, why: str) -> None:
        super().__init__(why)
        self.code, self.reason = CLOSED[why]


class Visitor:
    """A visitor from the connection to its end.

    Parameters
    ----------
    socket : WebSocket
        The accepted connection.
    settings : Settings
        Settings of the server.
    threads : Executor
        Runs what takes longer than a few milliseconds.
    """

    def __init__(self, socket: WebSocket, settings: Settings, threads: Executor) -> None:
        self._socket = socket
        self._limits = settings.limits
        self._threads = threads
        self._session = Session(
            settings.start,
            bounds=settings.limits.bounds,
            public=settings.public,
            run=settings.run,
            hardware=settings.hardware,
            calibration=settings.calibration,
        )
        self._inbox = Inbox(settings.limits.waiting)
        self._called = asyncio.Event()
        self._sending = asyncio.Lock()
        self._strikes = 0
        self._heard = _now()

    async def stay(self) -> None:
        """Receive, process and answer messages until either side disconnects."""
        tasks = [asyncio.create_task(part()) for part in (self._read, self._work, self._end_idle)]
        try:
            done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            for task in done:
                task.result()
        except _SessionEnd as end:
            with contextlib.suppress(RuntimeError, WebSocketDisconnect):
                await self._socket.close(end.code, end.reason)
        except (WebSocketDisconnect, RuntimeError):
            pass  # the visitor has disconnected; writing to a closed socket is a RuntimeError
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
            self._session.close()

    async def _read(self) -> None:
        rate = Rate(self._limits.messages_per_s, _now())
        while True:
            received = await self._socket.receive()
            self._heard = _now()
            if received["type"] == "websocket.disconnect":
                return
            text = received.get("text")
            await self._take(received.get("bytes") or b"" if text is None else text, allowed=rate.take(_now()))

    async def _end_idle(self) -> None:
        """End the session after too long without messages; cheaper than a timeout while waiting for each message."""
        while (left := self._heard + (self._limits.idle_s or math.inf) - _now()) > 0:
            await asyncio.sleep(min(left, _LONGEST_SLEEP))
        raise _SessionEnd("IDLE")

    async def _take(self, text: str | bytes, *, allowed: bool) -> None:
        if not allowed:
            await self._refuse(
                malformed(f"more than {self._limits.messages_per_s:g} messages per second"), kind="limit"
            )
            return
        message = read(text, most=self._limits.message_bytes)
        if isinstance(message, ErrorMessage):
            await self._refuse(message, kind=message.kind)
        elif self._inbox.full:
            full = malformed(f"{len(self._inbox)} messages are queued; wait for an answer", id=message.id)
            await self._refuse(full, kind="limit")
        else:
            self._strikes = 0
            dropped = self._inbox.push(message)
            self._called.set()
            await self._send(dropped)

    async def _refuse(self, error: ErrorMessage, *, kind: str) -> None:
        self._strikes += 1
        if self._strikes > self._limits.malformed:
            raise _SessionEnd("RATE")
        await self._send([error.model_copy(update={"kind": kind}), Done(type="done", id=error.id)])

    async def _work(self) -> None:
        due = last = _now()
        while True:
            if self._session.driving:
                await self._wait(due - _now())
            else:
                await self._called.wait()
                due = last = _now()
            if len(self._inbox):
                await self._answer(self._inbox.pop())
            else:
                self._called.clear()
            if self._session.driving and _now() >= due:
                now = _now()
                frame = await self._frame(min(now - last, _LONGEST_STEP)) if now > last else None
                last, due = now, max(due + 1 / self._limits.frame_hz, now)
                await self._send([] if frame is None else [frame])

    async def _frame(self, dt: float) -> DriveFrame | BringUpMessage | ErrorMessage | None:
        """Return the next frame; a change of state is planned in a thread, so that other visitors' frames continue."""
        if not self._session.is_planning:
            return self._session.frame(dt)
        return await asyncio.get_running_loop().run_in_executor(self._threads, self._session.frame, dt)

    async def _wait(self, seconds: float) -> None:
        """Wait for a message, at most until the next frame is due."""
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(max(seconds, 0.0)):
                await self._called.wait()

    async def _answer(self, message: ClientMessage) -> None:
        if isinstance(message, _QUICK):
            texts = self._answers(message)
        else:
            texts = await asyncio.get_running_loop().run_in_executor(self._threads, self._answers, message)
        await self._send_texts(texts)

    def _answers(self, message: ClientMessage) -> list[str]:
        return [answer.model_dump_json() for answer in self._session.handle(message)]

    async def _send(self, messages: Sequence[BaseModel]) -> None:
        await self._send_texts([message.model_dump_json() for message in messages])

    async def _send_texts(self, texts: Sequence[str]) -> None:
        # Both `_read` and `_work` send; the answers to one message must not be interleaved with others.
        async with self._sending:
            for text in texts:
                await self._socket.send_text(text)


def _now() -> float:
    return asyncio.get_running_loop().time()
