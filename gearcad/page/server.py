"""The server of the page: at 127.0.0.1 only, unless it is opened to others with a token."""

from __future__ import annotations

import secrets
from pathlib import Path

from gearcad.page.access import Access

__all__ = ["serve"]


def serve(text: str, name: str, folder: Path, host: str | None, port: int, show: bool) -> None:
    """Serve the page of a spec until Ctrl-C."""
    from fastapi import Response
    from nicegui import app, ui

    from gearcad.page.panels.bodies import BODIES
    from gearcad.page.session import Session

    @app.get("/bodies/{key}/{_number}.glb")
    def bodies(key: str, _number: int) -> Response:
        content = BODIES.get(key)
        return Response(content or b"", 200 if content else 404, media_type="model/gltf-binary")

    def root() -> None:
        ui.add_css(Path(__file__).parent / "page.css")
        Session(text, name, folder)

    token = None if host is None else secrets.token_urlsafe(16)
    hosts = {f"{each}:{port}" for each in ("127.0.0.1", "localhost", host) if each}
    app.add_middleware(Access, hosts=hosts, token=token)
    ui.run(
        root,
        host=host or "127.0.0.1",
        port=port,
        title=f"{name} - gearcad",
        show=show,
        reload=False,
        show_welcome_message=False,
        tailwind=False,
    )
