"""Access to the server of the page: requests of the page itself, at its own address, by a browser that has had the token."""

from __future__ import annotations

import hmac
import re
from collections.abc import Awaitable, Callable, Collection, MutableMapping
from html import escape
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qsl, urlencode

from gearcad.errors import ParameterError

__all__ = ["TOKEN", "Access", "require_token"]

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Any]]
Send = Callable[[Any], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]

TOKEN = "token"
"""Name of the token in the address."""

_PERMITTED = re.compile(r"[A-Za-z0-9_-]{16,128}")
"""Tokens that an address and a cookie hold as they are, too long to be guessed."""

_REFUSED = b"refused: open the address that gearcad printed, which has the token\n"


def require_token(token: str) -> None:
    """Raise ParameterError for a token of a user's that is short, or has other characters than addresses hold."""
    if not _PERMITTED.fullmatch(token):
        raise ParameterError("token", token, "must be 16 to 128 letters of A to Z or a to z, digits, - and _")


class Access:
    """An application that answers 403 to other hosts (a name that was made to lead here), other sites and whoever has no token.

    The token comes once in the address. The answer sets a cookie of this server, and sends the browser on to the same
    address without the token, so that neither history nor the page nor a link has it. `single_use` is a second token for one
    such request: the browser is started with it, and other accounts of the machine see how processes were started.
    """

    def __init__(self, app: App, hosts: Collection[str], token: str, single_use: str = "") -> None:
        self._app, self._hosts, self._token, self._single_use = app, frozenset(hosts), token, single_use
        self._origins = frozenset(f"http://{host}" for host in hosts)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a permitted request on, and refuse all others."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers = {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]}
        asked = dict(parse_qsl(scope.get("query_string", b"").decode("latin-1")))
        if not self._is_ours(headers):
            await _refuse(scope, send)
        elif scope["type"] == "http" and scope["path"] == "/" and self._opens(asked.pop(TOKEN, "")):
            await self._let_in(headers["host"], asked, send)
        elif not self._in_cookie(headers):
            await _refuse(scope, send)
        else:
            await self._app(scope, receive, send)

    def _is_ours(self, headers: dict[str, str]) -> bool:
        """Return whether it is for this server, from a page of it, or from whoever opens the page by a link or by hand."""
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

    def _opens(self, text: str) -> bool:
        """Return whether this is the token, or the one for a single use, which is used up then."""
        if self._single_use and _equal(text, self._single_use):
            self._single_use = ""
            return True
        return _equal(text, self._token)

    def _in_cookie(self, headers: dict[str, str]) -> bool:
        try:
            cookie = SimpleCookie(headers.get("cookie", "")).get(_cookie_of(headers.get("host", "")))
        except CookieError:
            return False
        return _equal(cookie.value if cookie else "", self._token)


def _equal(text: str, token: str) -> bool:
    """Compare in a time that tells nothing of the token."""
    return hmac.compare_digest(text.encode(), token.encode())


def _cookie_of(host: str) -> str:
    """Return the name of the cookie: a browser has one store of cookies for all ports of a host."""
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
