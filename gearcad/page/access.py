"""Who may ask: only the page itself, at the address at which it was opened, and with `--host` whoever has the token."""

from __future__ import annotations

import hmac
from collections.abc import Awaitable, Callable, Collection, MutableMapping
from http.cookies import SimpleCookie
from typing import Any
from urllib.parse import parse_qs, urlsplit

__all__ = ["TOKEN", "Access"]

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Any]]
Send = Callable[[Any], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]

TOKEN = "token"
"""Its name in the address."""

_COOKIE = "gearcad_token"


class Access:
    """Answers 403 to a request for another host (a name that was made to lead here), or from another site's page.

    With a `token`, also to one without it: it comes once in the address, then as a cookie.
    """

    def __init__(self, app: App, hosts: Collection[str], token: str | None = None) -> None:
        self._app, self._hosts, self._token = app, frozenset(hosts), token

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let through what may pass."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers = {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]}
        if not self._may(headers, scope):
            await _refuse(scope, send)
            return

        async def with_cookie(message: Any) -> None:
            if self._token and message["type"] == "http.response.start" and self._in_address(scope):
                cookie = f"{_COOKIE}={self._token}; HttpOnly; SameSite=Strict; Path=/"
                message["headers"] = [*message["headers"], (b"set-cookie", cookie.encode())]
            await send(message)

        await self._app(scope, receive, with_cookie)

    def _may(self, headers: dict[str, str], scope: Scope) -> bool:
        origin = headers.get("origin")
        ours = headers.get("host", "") in self._hosts and (origin is None or urlsplit(origin).netloc in self._hosts)
        return ours and (not self._token or self._in_address(scope) or self._in_cookie(headers))

    def _in_address(self, scope: Scope) -> bool:
        return self._is_token(parse_qs(scope.get("query_string", b"").decode("latin-1")).get(TOKEN, [""])[0])

    def _in_cookie(self, headers: dict[str, str]) -> bool:
        cookie = SimpleCookie(headers.get("cookie", "")).get(_COOKIE)
        return self._is_token(cookie.value if cookie else "")

    def _is_token(self, given: str) -> bool:
        return self._token is not None and hmac.compare_digest(given.encode(), self._token.encode())


async def _refuse(scope: Scope, send: Send) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008})
        return
    headers = [(b"content-type", b"text/plain; charset=utf-8")]
    await send({"type": "http.response.start", "status": 403, "headers": headers})
    await send({"type": "http.response.body", "body": b"not from here: open the address that gearcad printed\n"})
