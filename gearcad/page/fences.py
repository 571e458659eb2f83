"""What a browser is told of every answer: what a page may load and run, and who may have it in a frame."""

from __future__ import annotations

import secrets
from typing import Any

from gearcad.page.access import App, Receive, Scope, Send

__all__ = ["Fences"]

_ALWAYS = {
    b"x-content-type-options": b"nosniff",
    b"referrer-policy": b"no-referrer",
    b"x-frame-options": b"DENY",
    b"cross-origin-opener-policy": b"same-origin",
    b"cross-origin-resource-policy": b"same-origin",
}
_POLICY = (
    "default-src 'none'; script-src 'self' 'nonce-{nonce}' 'unsafe-eval'; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data: blob:; font-src 'self' data:; connect-src 'self'; form-action 'none'; base-uri 'none'; "
    "frame-ancestors 'none'; object-src 'none'"
)
"""Scripts are those of this server, and those that stand in the page as it is sent: none that gets into it later.

Components are compiled in the browser, for which Vue needs to evaluate; Quasar sets styles on elements.
"""


class Fences:
    """Adds headers, and to pages a policy: their own scripts have a word of this one answer, which nothing else knows.

    A policy that an answer brings with it stays. Paths that a proxy claims are not taken from headers.
    """

    def __init__(self, app: App) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on, with headers."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        scope["headers"] = [each for each in scope["headers"] if each[0].lower() != b"x-forwarded-prefix"]
        nonce = secrets.token_urlsafe(16)
        start: list[Any] = []
        parts: list[bytes] = []

        async def fenced(message: Any) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = _with_headers(message["headers"], nonce)
                if _is_page(message["headers"]):
                    start.append(message)
                    return
            elif start:
                parts.append(message.get("body", b""))
                if message.get("more_body"):
                    return
                body = b"".join(parts).replace(b"<script", f'<script nonce="{nonce}"'.encode())
                head = start.pop()
                head["headers"] = [each for each in head["headers"] if each[0] != b"content-length"]
                await send(head | {"headers": [*head["headers"], (b"content-length", str(len(body)).encode())]})
                message = {"type": "http.response.body", "body": body}
            await send(message)

        await self._app(scope, receive, fenced)


def _with_headers(given: Any, nonce: str) -> list[tuple[bytes, bytes]]:
    headers = [(name.lower(), value) for name, value in given]
    has = {name for name, _ in headers}
    headers += [(name, value) for name, value in _ALWAYS.items() if name not in has]
    if b"content-security-policy" not in has:
        headers.append((b"content-security-policy", _POLICY.format(nonce=nonce).encode()))
    return headers


def _is_page(headers: list[tuple[bytes, bytes]]) -> bool:
    """Whether NiceGUI has made it: what users typed stands escaped there, so that each script in it is its own."""
    return (b"x-nicegui-content", b"page") in headers
