"""The server of the page: at 127.0.0.1 only, unless another address is given, and for browsers that have had its token."""

from __future__ import annotations

import errno
import logging
import secrets
import socket
import sys
import threading
import webbrowser
from pathlib import Path
from typing import Any

from gearcad.errors import ParameterError
from gearcad.page.access import TOKEN, Access, require_token
from gearcad.page.ending import ending
from gearcad.page.fences import Fences
from gearcad.page.terminal import Lines

__all__ = ["LOCAL", "PORT", "serve"]

LOCAL = "127.0.0.1"
"""Address that no other machine reaches; other accounts of this one do."""

PORT = 8765
"""Where the page listens, unless that is taken: then at the next that is free."""

_TRIED = 100
"""Ports that are tried."""

_EVERYWHERE = ("0.0.0.0", "::", "")

_RECONNECT = 30.0
"""Seconds that a tab may be away, as where a laptop sleeps, and find its page as it was."""

_MOST_SESSIONS = 32
"""Tabs at a time."""

_LARGEST_MESSAGE = 1 << 20
"""Bytes that a browser may send at once over its connection: four times the largest spec."""

_WAITING = 128
"""Connections that nobody has accepted yet."""

_RANDOM = 32
"""Random bytes of a token."""

_TURN = 5e-4
"""Seconds that a thread may compute while another waits: what is found is sent at once, whatever else is being found."""

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

    from gearcad.page.aside import close_aside
    from gearcad.page.panels.strength import warm_up
    from gearcad.page.routes import add_routes
    from gearcad.page.runs import close_all_runs
    from gearcad.page.session import Session
    from gearcad.page.workbench import Workbench

    first = Workbench(text, name, folder)  # what is wrong with it is told here, not in the browser
    held = _held(host or LOCAL, port)
    port = held.getsockname()[1]
    taken: dict[str, Any] = {"fd": held.fileno()} if hasattr(socket, "AF_UNIX") else {}
    if not taken:  # Windows, where no socket can be handed on
        held.close()
    hosts = {f"{each}:{port}" for each in (host or LOCAL, "localhost")}
    address, single_use = f"http://{host or LOCAL}:{port}/?{TOKEN}=", secrets.token_urlsafe(_RANDOM) if browser else ""

    @ui.page("/")
    def page() -> Response | None:
        if len(Session.open) >= _MOST_SESSIONS:
            return Response(f"{_MOST_SESSIONS} pages are open: close one\n", 503, media_type="text/plain")
        ui.add_css(Path(__file__).parent / "page.css")
        Session.of(text, name, folder)
        return None

    lines = Lines()
    for logger in ("nicegui", "uvicorn.error", "asyncio"):
        logging.getLogger(logger).addFilter(lines)
    core.sio.eio.cors_allowed_origins = sorted(f"http://{each}" for each in hosts)
    add_routes(app)
    app.add_middleware(Fences)
    app.add_middleware(Access, hosts=hosts, token=token, single_use=single_use)
    app.on_startup(lambda: print(address + token, flush=True))
    app.on_startup(threading.Thread(target=warm_up, args=(first.design,), daemon=True).start)
    if browser:
        app.on_startup(threading.Thread(target=webbrowser.open, args=(address + single_use,), daemon=True).start)
    app.on_shutdown(Session.leave_all)
    app.on_shutdown(close_all_runs)
    app.on_shutdown(close_aside)
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


def _held(host: str, port: int | None) -> socket.socket:
    """Listening at the port that is asked for, or the first from PORT on that is free: nobody else gets it from here on.

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
