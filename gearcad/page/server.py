"""The server of the page: at 127.0.0.1 only, unless it is opened to others with a token."""

from __future__ import annotations

import errno
import secrets
import socket
import threading
from pathlib import Path

from gearcad.errors import ParameterError
from gearcad.page.access import TOKEN, Access

__all__ = ["LOCAL", "PORT", "serve"]

LOCAL = "127.0.0.1"
"""Where nobody else can ask."""

PORT = 8765
"""Where the page listens, unless that is taken: then at the next that is free."""

_TRIED = 100
"""Ports that are tried."""

_RECONNECT = 30.0
"""Seconds that a tab may be away, as where a laptop sleeps, and find its page as it was."""


def serve(text: str, name: str, folder: Path, *, host: str | None, port: int | None, browser: bool) -> None:
    """Serve the page of a spec's text until Ctrl-C; files that it names are seen from `folder`.

    At `host` others may ask, who have the token in the address that is printed. Raises ParameterError where nothing can listen,
    or NiceGUI is missing, SpecError for a text that makes nothing.
    """
    try:
        from nicegui import app, ui
    except ImportError as error:
        raise ParameterError("open", name, 'needs NiceGUI: pip install "gearcad[page]"') from error
    from gearcad.page.panels.strength import warm_up
    from gearcad.page.routes import add_routes
    from gearcad.page.runs import close_all_runs
    from gearcad.page.session import Session
    from gearcad.page.workbench import Workbench

    first = Workbench(text, name, folder)  # what is wrong with it is told here, not in the browser
    port = _free_port(host or LOCAL, port)
    token = None if host is None else secrets.token_urlsafe(16)
    address = f"http://{host or LOCAL}:{port}/{f'?{TOKEN}={token}' if token else ''}"

    def root() -> None:
        ui.add_css(Path(__file__).parent / "page.css")
        Session.of(text, name, folder)

    add_routes(app)
    app.add_middleware(Access, hosts={f"{each}:{port}" for each in (LOCAL, "localhost", host) if each}, token=token)
    app.on_shutdown(close_all_runs)
    app.on_startup(lambda: print(address, flush=True))
    app.on_shutdown(close_all_runs)
    app.on_startup(threading.Thread(target=warm_up, args=(first.design,), daemon=True).start)
    ui.run(
        root,
        host=host or LOCAL,
        port=port,
        title=f"{name} - gearcad",
        show=address if browser else False,
        dark=None,
        favicon="⚙",
        reload=False,
        reconnect_timeout=_RECONNECT,
        show_welcome_message=False,
        tailwind=False,
    )


def _free_port(host: str, port: int | None) -> int:
    """The port that is asked for, or the first from PORT on at which nobody listens. Raises ParameterError."""
    for each in range(PORT, PORT + _TRIED) if port is None else (port,):
        with socket.socket() as tried:
            tried.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                tried.bind((host, each))
            except OSError as error:
                if error.errno == errno.EADDRINUSE and port is None:
                    continue
                if error.errno in (errno.EADDRINUSE, errno.EACCES):
                    raise ParameterError("port", each, f"must be free at {host}, and permitted to you") from error
                raise ParameterError("host", host, "must be an address of this machine") from error
            return each
    raise ParameterError("port", PORT, f"must be free at {host}, or one of the {_TRIED} behind it")
