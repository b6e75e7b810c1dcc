"""Access control by host, origin and token of requests, and the headers of responses."""

from __future__ import annotations

import hmac
from typing import TYPE_CHECKING
from urllib.parse import parse_qs, urlsplit

from tarsus.studio.messages import CLOSED
from tarsus.studio.server.settings import Settings, is_loopback

if TYPE_CHECKING:
    from starlette.types import ASGIApp, Message, Receive, Scope, Send

__all__ = ["HEADERS", "AccessControl"]

HEADERS = {
    "content-security-policy": "; ".join(
        (
            "default-src 'none'",
            "script-src 'self' 'wasm-unsafe-eval'",
            "style-src 'self' 'unsafe-inline'",
            "img-src 'self' data: blob:",
            "font-src 'self'",
            "connect-src 'self'",
            "worker-src 'self' blob:",
            "manifest-src 'self'",
            "base-uri 'none'",
            "form-action 'none'",
            "frame-ancestors 'none'",
        )
    ),
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "permissions-policy": "camera=(), geolocation=(), microphone=()",
    "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
}
"""Headers of all responses: no external resources, no framing."""

_OPEN = frozenset({"/health"})


class AccessControl:
    """Rejects requests for unknown hosts or without the token, and sockets from other origins.

    Parameters
    ----------
    app : ASGI application
        The protected application.
    settings : Settings
        Host and token.
    """

    def __init__(self, app: ASGIApp, settings: Settings) -> None:
        self._app = app
        self._settings = settings

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Forward a request, or reject it."""
        if scope["type"] == "http":
            await self._http(scope, receive, _with_headers(send))
        elif scope["type"] == "websocket":
            await self._socket(scope, receive, send)
        else:
            await self._app(scope, receive, send)

    async def _http(self, scope: Scope, receive: Receive, send: Send) -> None:
        headers = _headers(scope)
        if not self._is_our_host(headers):
            await _answer(send, 403, "unknown host name")
        elif scope["path"] in _OPEN or self._knows_token(scope, headers):
            given = _query_token(scope)
            if given is not None and self._settings.token is not None:
                # Redirect to a URL without the token; browsers keep the fragment.
                await _answer(send, 303, "", location=scope["path"], set_cookie=self._cookie(given))
            else:
                await self._app(scope, receive, send)
        else:
            await _answer(send, 401, "a token is required: open the link that the server printed at its start")

    async def _socket(self, scope: Scope, receive: Receive, send: Send) -> None:
        headers = _headers(scope)
        if not (self._is_our_host(headers) and _same_origin(headers)):
            await receive()
            await send({"type": "websocket.close", "code": 1008})  # closed before it is accepted: HTTP 403
        elif not self._knows_token(scope, headers):
            # Accepted first, as browsers report the close code of accepted sockets only.
            await receive()
            await send({"type": "websocket.accept"})
            await send({"type": "websocket.close", "code": CLOSED["TOKEN"][0], "reason": CLOSED["TOKEN"][1]})
        else:
            await self._app(scope, receive, send)

    def _is_our_host(self, headers: dict[str, str]) -> bool:
        """Return whether the request is for a local host name; on a loopback server this prevents DNS rebinding."""
        if not self._settings.loopback:
            return True
        try:
            return is_loopback(urlsplit(f"//{headers.get('host', '')}").hostname or "")
        except ValueError:
            return False

    def _knows_token(self, scope: Scope, headers: dict[str, str]) -> bool:
        wanted = self._settings.token
        if wanted is None:
            return True
        given = (_query_token(scope), _cookie_token(headers, self._settings.cookie))
        return any(token is not None and hmac.compare_digest(token.encode(), wanted.encode()) for token in given)

    def _cookie(self, token: str) -> str:
        return f"{self._settings.cookie}={token}; Path=/; HttpOnly; SameSite=Lax"


def _headers(scope: Scope) -> dict[str, str]:
    return {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]}


def _same_origin(headers: dict[str, str]) -> bool:
    """Return whether the origin is this server, or missing: browsers always send it, other clients need not."""
    origin = headers.get("origin")
    return origin is None or urlsplit(origin).netloc.lower() == headers.get("host", "").lower()


def _query_token(scope: Scope) -> str | None:
    found = parse_qs(scope.get("query_string", b"").decode("latin-1")).get("token")
    return found[0] if found else None


def _cookie_token(headers: dict[str, str], name: str) -> str | None:
    pairs = (pair.strip().partition("=") for pair in headers.get("cookie", "").split(";"))
    return next((value for key, _, value in pairs if key == name), None)


def _with_headers(send: Send) -> Send:
    extra = [(name.encode(), value.encode()) for name, value in HEADERS.items()]

    async def sent(message: Message) -> None:
        if message["type"] == "http.response.start":
            message = {**message, "headers": [*message.get("headers", ()), *extra]}
        await send(message)

    return sent


async def _answer(send: Send, status: int, text: str, **more: str) -> None:
    headers = {"content-type": "text/plain; charset=utf-8", "cache-control": "no-store"}
    headers |= {name.replace("_", "-"): value for name, value in more.items()}
    pairs = [(name.encode(), value.encode()) for name, value in headers.items()]
    await send({"type": "http.response.start", "status": status, "headers": pairs})
    await send({"type": "http.response.body", "body": text.encode()})
