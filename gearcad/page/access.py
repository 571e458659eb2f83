"""Who may ask: only the page itself, at the address at which it was opened, and with `--host` whoever has the token."""

from __future__ import annotations

import hmac
from collections.abc import Awaitable, Callable, Collection, MutableMapping
from html import escape
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qsl, urlencode

__all__ = ["TOKEN", "Access"]

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Any]]
Send = Callable[[Any], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]

TOKEN = "token"
"""Its name in the address."""

_REFUSED = b"not from here: open the address that gearcad printed\n"


class Access:
    """Answers 403 to a request for another host (a name that was made to lead here), or from another site's page.

    With a `token`, also to one without it: it comes once in the address, from there on as a cookie of this server, for which
    the browser is sent on to the same address without it, so that neither history nor the page nor a link has it.
    """

    def __init__(self, app: App, hosts: Collection[str], token: str | None = None) -> None:
        self._app, self._hosts, self._token = app, frozenset(hosts), token
        self._origins = frozenset(f"http://{host}" for host in hosts)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let through what may pass."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers = {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]}
        asked = dict(parse_qsl(scope.get("query_string", b"").decode("latin-1")))
        if not self._is_ours(headers):
            await _refuse(scope, send)
        elif self._token and scope["type"] == "http" and scope["path"] == "/" and self._is_token(asked.pop(TOKEN, "")):
            await self._let_in(headers["host"], asked, send)
        elif self._token and not self._in_cookie(headers):
            await _refuse(scope, send)
        else:
            await self._app(scope, receive, send)

    def _is_ours(self, headers: dict[str, str]) -> bool:
        """Whether it is for this server, from a page of it, or from whoever opens the page by a link or by hand."""
        origin, host = headers.get("origin"), headers.get("host", "")
        if host not in self._hosts or (origin is not None and origin not in self._origins):
            return False
        opens_page = (headers.get("sec-fetch-mode"), headers.get("sec-fetch-dest")) == ("navigate", "document")
        return headers.get("sec-fetch-site") not in ("cross-site", "same-site") or opens_page

    async def _let_in(self, host: str, asked: dict[str, str], send: Send) -> None:
        """Give the cookie. A page that leads on is of this site, wherever the link stood: a redirection would not be."""
        cookie = f"{_cookie_of(host)}={self._token}; HttpOnly; SameSite=Strict; Path=/"
        onwards = escape(f"/?{urlencode(asked)}" if asked else "/")
        body = f'<!doctype html><title>gearcad</title><meta http-equiv="refresh" content="0;url={onwards}">'
        await _answer(send, 200, "text/html", body.encode(), (b"set-cookie", cookie.encode("latin-1")))

    def _in_cookie(self, headers: dict[str, str]) -> bool:
        try:
            cookie = SimpleCookie(headers.get("cookie", "")).get(_cookie_of(headers.get("host", "")))
        except CookieError:
            return False
        return self._is_token(cookie.value if cookie else "")

    def _is_token(self, given: str) -> bool:
        return self._token is not None and hmac.compare_digest(given.encode(), self._token.encode())


def _cookie_of(host: str) -> str:
    """Its name: a browser has one store of cookies for all ports of a host."""
    return f"gearcad_{host.rpartition(':')[2]}"


async def _refuse(scope: Scope, send: Send) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008})
    else:
        await _answer(send, 403, "text/plain", _REFUSED)


async def _answer(send: Send, status: int, kind: str, body: bytes, *more: tuple[bytes, bytes]) -> None:
    headers = [(b"content-type", f"{kind}; charset=utf-8".encode()), (b"cache-control", b"no-store"), *more]
    headers += [(b"referrer-policy", b"no-referrer"), (b"x-content-type-options", b"nosniff")]
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": body})
