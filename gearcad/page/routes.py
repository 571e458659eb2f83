"""What the page fetches besides what NiceGUI sends."""

from __future__ import annotations

from fastapi import FastAPI, Request, Response

from gearcad.page.given import add_given
from gearcad.page.made import add_made

__all__ = ["add_routes"]


def add_routes(app: FastAPI) -> None:
    """Answer them at this app, and what is not there, or goes wrong, by a line."""
    add_made(app)
    add_given(app)
    app.add_exception_handler(404, _missing)
    app.add_exception_handler(Exception, _broken)


def _missing(_request: Request, _error: Exception) -> Response:
    return Response("no such page\n", 404, media_type="text/plain")


def _broken(_request: Request, error: Exception) -> Response:
    return Response(f"failed ({type(error).__name__})\n", 500, media_type="text/plain")
