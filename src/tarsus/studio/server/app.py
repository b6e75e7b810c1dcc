"""The ASGI application: page, static files, sockets, and health check."""

from __future__ import annotations

from collections.abc import AsyncIterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

from fastapi import FastAPI, Request, Response, WebSocket

from tarsus import __version__
from tarsus.studio.messages import CLOSED, SOCKET
from tarsus.studio.server.access import AccessControl
from tarsus.studio.server.pages import Pages
from tarsus.studio.server.settings import Settings
from tarsus.studio.server.visitor import Visitor

if TYPE_CHECKING:
    from starlette.types import ASGIApp

__all__ = ["studio_app"]


def studio_app(settings: Settings, *, pages: Pages | None = None) -> ASGIApp:
    """Return the studio as an ASGI application.

    Parameters
    ----------
    settings : Settings
        Access and limits.
    pages : Pages, optional
        The front end; that of the package where left out.
    """
    threads = ThreadPoolExecutor(settings.limits.threads, thread_name_prefix="studio")
    front = Pages() if pages is None else pages
    sockets: set[WebSocket] = set()

    @asynccontextmanager
    async def lifespan(_app: FastAPI) -> AsyncIterator[None]:
        yield
        threads.shutdown(wait=False, cancel_futures=True)

    # The built-in documentation pages of FastAPI load external scripts.
    app = FastAPI(lifespan=lifespan, docs_url=None, redoc_url=None, openapi_url=None)

    @app.get("/health")
    async def health() -> dict[str, object]:
        return {"status": "ok", "version": __version__, "sessions": len(sockets), "pages": front.built}

    @app.get("/{name:path}")
    async def page(request: Request, name: str) -> Response:
        return front.answer(request, name)

    @app.websocket(SOCKET)
    async def session(socket: WebSocket) -> None:
        await socket.accept()
        if len(sockets) >= settings.limits.sessions:
            await socket.close(*CLOSED["FULL"])
            return
        sockets.add(socket)
        try:
            await Visitor(socket, settings, threads).stay()
        finally:
            sockets.discard(socket)

    return AccessControl(app, settings)
