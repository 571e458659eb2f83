"""Server of the page: who may ask, security headers, messages on the terminal, and its end with all processes."""

from __future__ import annotations

import errno
import hmac
import logging
import os
import re
import secrets
import shutil
import signal
import socket
import sys
import tempfile
import threading
import time
import webbrowser
from collections.abc import Awaitable, Callable, Collection, Iterator, MutableMapping
from contextlib import contextmanager, suppress
from html import escape
from http.cookies import CookieError, SimpleCookie
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl, urlencode

from gearcad.core.errors import ParameterError, shown
from gearcad.core.output import has_mark, mark_folder

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
        """Return whether a request is for this server, and comes from one of its pages or from a user who opens the page by a
        link or by hand.
        """
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
    """Compare two tokens in a time that does not depend on them."""
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


class SecurityHeaders:
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
    """Return whether NiceGUI made the response. It escapes what users typed, so each script in it is its own."""
    return (b"x-nicegui-content", b"page") in headers


_MOST = 20
_WITHIN = 60.0
_LONGEST = 500
"""Largest number of characters in a line of the log."""

_MORE = " (what else goes wrong within a minute is not told)"


class LogLimiter(logging.Filter):
    """Filter of log records: so many within so many seconds, each as one printable line, because a browser can send anything.

    The last of them says that others are not told.
    """

    def __init__(self, most: int = _MOST, within: float = _WITHIN, clock: Callable[[], float] = time.monotonic) -> None:
        super().__init__()
        self._most, self._within, self._clock = most, within, clock
        self._begin, self._count = clock(), 0

    def filter(self, record: logging.LogRecord) -> bool:
        """Return whether the log has room for a record, which is then shortened to one line."""
        if (now := self._clock()) - self._begin >= self._within:
            self._begin, self._count = now, 0
        self._count += 1
        record.msg, record.args = _line(record) + (_MORE if self._count == self._most else ""), ()
        record.exc_info = record.exc_text = None
        return self._count <= self._most


def _line(record: logging.LogRecord) -> str:
    """Return the message of a record, or the error that it is about; of the text of a traceback only its last line."""
    error = record.msg if isinstance(record.msg, Exception) else record.exc_info[1] if record.exc_info else None
    if error is not None:
        told = f"a page failed ({type(error).__name__}: {error})"
    else:
        told = record.getMessage().strip()
        if told.startswith("Traceback "):
            told = told.splitlines()[-1]
    return shown(told, _LONGEST)


_PATIENCE = 2.0
"""Seconds that threads have to end the processes of runs."""

_RUNS = "gearcad-runs"
"""Name of the threads of runs."""

_PREFIX = "gearcad-open-"
"""Prefix of the names of the servers' folders."""

_YOUNG = 60.0
"""Time (s) within which the owner of a new folder locks it."""


@contextmanager
def ending() -> Iterator[None]:
    """Temporary files of this process and its children are in one folder, which goes at the end; the process ends then.

    Ctrl-C, SIGTERM and the terminal's end are what ends a server: its exit status is 0. What other threads still compute
    nobody wants any more. Folders of servers that were killed go at the begin of the next.
    """
    _bury_the_dead(Path(tempfile.gettempdir()))
    folder = tempfile.mkdtemp(prefix=_PREFIX)
    _hold(folder)
    mark_folder(Path(folder))
    former, tempfile.tempdir = tempfile.tempdir, folder
    os.environ["TMPDIR"] = folder
    signal.signal(signal.SIGTERM, _stop)
    if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:  # nohup has it ignored
        signal.signal(signal.SIGHUP, _hang_up)
    try:
        with suppress(KeyboardInterrupt):
            yield
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        _wait()
    finally:
        tempfile.tempdir = former
        shutil.rmtree(folder, ignore_errors=True)
    with suppress(OSError):
        sys.stdout.flush()
        sys.stderr.flush()
    os._exit(0)


def _stop(_number: int, _frame: object) -> None:
    raise KeyboardInterrupt


def _hang_up(_number: int, _frame: object) -> None:
    """Raise SIGTERM for a hang-up (SIGHUP), because the server has its own handler for SIGTERM while it serves."""
    signal.raise_signal(signal.SIGTERM)


def _hold(folder: str) -> int | None:
    """Lock a folder until this process ends. A folder without a lock belongs to a process that has ended.

    The lock, or None where somebody has it, the folder is not ours, or the system has no such locks.
    """
    try:
        import fcntl

        held = os.open(folder, os.O_RDONLY | os.O_NOFOLLOW)
    except (ImportError, OSError):
        return None
    try:
        if os.fstat(held).st_uid == os.getuid():
            fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return held
    except OSError:
        pass
    os.close(held)
    return None


def _bury_the_dead(temporary: Path) -> None:
    """Remove the folders of servers that were killed, those with our mark only."""
    for folder in filter(has_mark, temporary.glob(f"{_PREFIX}*")):
        with suppress(OSError):
            if time.time() - folder.lstat().st_mtime > _YOUNG and (held := _hold(str(folder))) is not None:
                shutil.rmtree(folder, ignore_errors=True)
                os.close(held)


def _wait() -> None:
    """Wait until no thread watches the process of a run, at most `_PATIENCE` seconds."""
    end = time.monotonic() + _PATIENCE
    for thread in threading.enumerate():
        if thread.name == _RUNS:
            thread.join(max(end - time.monotonic(), 0.0))


LOCAL = "127.0.0.1"
"""Address that no other machine reaches; other accounts of this one do."""

PORT = 8765
"""Port of the page; if it is taken, the next free one is used."""

_TRIED = 100
"""Number of ports that are tried."""

_EVERYWHERE = ("0.0.0.0", "::", "")

_RECONNECT = 30.0
"""Time (s) after which a tab without a connection loses its page: a laptop may sleep."""

_MOST_SESSIONS = 32
"""Largest number of tabs at a time."""

_LARGEST_MESSAGE = 1 << 20
"""Bytes that a browser may send at once over its connection: four times the largest spec."""

_WAITING = 128
"""Largest number of connections that wait to be accepted."""

_RANDOM = 32
"""Number of random bytes in a token."""

_TURN = 5e-4
"""Time (s) that a thread may compute while another one waits, so that results are sent at once."""

_GRACE = 1
"""Seconds that answers have to end when the server does."""


def serve(
    text: str, name: str, folder: Path, *, host: str | None, port: int | None, browser: bool, token: str | None = None
) -> None:
    """Serve the page of a spec's text until Ctrl-C; files that it names are seen from `folder`.

    The page is for who has the `token` (None: a new one) in the address that is printed, also from other machines at `host`.
    Raises ParameterError for a token that is too short, where nothing can listen, or NiceGUI is missing, SpecError for a text
    that makes nothing. The process ends with the server.
    """
    token = secrets.token_urlsafe(_RANDOM) if token is None else token
    require_token(token)
    try:
        from nicegui import app, core, ui
    except ImportError as error:
        raise ParameterError("open", name, 'needs NiceGUI: pip install "gearcad[page]"') from error
    from fastapi import Response

    from gearcad.page.panels.sheet_content import warm_up
    from gearcad.page.run_process import stop_process
    from gearcad.page.runs import add_routes, close_all_runs
    from gearcad.page.session import Session
    from gearcad.page.workbench import Workbench

    first = Workbench(text, name, folder)  # what is wrong with it is told here, not in the browser
    held = _listening_socket(host or LOCAL, port)
    port = held.getsockname()[1]
    taken: dict[str, Any] = {"fd": held.fileno()} if hasattr(socket, "AF_UNIX") else {}
    if not taken:  # Windows, where no socket can be handed on
        held.close()
    hosts = {f"{each}:{port}" for each in (host or LOCAL, "localhost")}
    address, single_use = f"http://{host or LOCAL}:{port}/?{TOKEN}=", secrets.token_urlsafe(_RANDOM) if browser else ""

    @ui.page("/")
    def page() -> Response | None:
        if len(Session.open) >= _MOST_SESSIONS and not Session.drop_abandoned():
            return Response(f"{_MOST_SESSIONS} pages are open: close one\n", 503, media_type="text/plain")
        ui.add_css(Path(__file__).parent / "page.css")
        Session.of(text, name, folder)
        return None

    lines = LogLimiter()
    for logger in ("nicegui", "uvicorn.error", "asyncio"):
        logging.getLogger(logger).addFilter(lines)
    core.sio.eio.cors_allowed_origins = sorted(f"http://{each}" for each in hosts)
    add_routes(app)
    app.add_middleware(SecurityHeaders)
    app.add_middleware(Access, hosts=hosts, token=token, single_use=single_use)
    app.on_startup(lambda: print(address + token, flush=True))
    app.on_startup(threading.Thread(target=warm_up, args=(first.design,), daemon=True).start)
    if browser:
        app.on_startup(threading.Thread(target=webbrowser.open, args=(address + single_use,), daemon=True).start)
    app.on_shutdown(Session.leave_all)
    app.on_shutdown(close_all_runs)
    app.on_shutdown(stop_process)
    sys.setswitchinterval(_TURN)
    with ending():
        ui.run(
            host=host or LOCAL,
            port=port,
            title=f"{name} - gearcad",
            show=False,
            dark=None,
            favicon="⚙",
            reload=False,
            reconnect_timeout=_RECONNECT,
            show_welcome_message=False,
            tailwind=False,
            server_header=False,
            ws_max_size=_LARGEST_MESSAGE,
            ws_per_message_deflate=host is not None,  # nothing is gained on the way to the same machine
            timeout_graceful_shutdown=_GRACE,
            **taken,
        )


def _listening_socket(host: str, port: int | None) -> socket.socket:
    """Return a socket that listens at the requested port, or at the first free one from PORT on.

    Raises ParameterError.
    """
    if host in _EVERYWHERE:
        raise ParameterError("host", host, "must be the one address at which others find this machine")
    for each in range(PORT, PORT + _TRIED) if port is None else (port,):
        try:
            return _listening(host, each)
        except OSError as error:
            if error.errno == errno.EADDRINUSE and port is None:
                continue
            if error.errno in (errno.EADDRINUSE, errno.EACCES):
                raise ParameterError("port", each, f"must be free at {host}, and permitted to you") from error
            raise ParameterError("host", host, "must be an address of this machine") from error
    raise ParameterError("port", PORT, f"must be free at {host}, or one of the {_TRIED} behind it")


def _listening(host: str, port: int) -> socket.socket:
    held = socket.socket()
    try:
        held.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        held.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)  # connections inherit it: small answers go at once
        held.bind((host, port))
        held.listen(_WAITING)
    except OSError:
        held.close()
        raise
    return held
