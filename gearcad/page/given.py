"""Files that a browser gives to an open session: they are taken up to a size, and handed to whoever waits for them."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from fastapi import FastAPI, Request, Response

__all__ = ["Takers", "add_given", "await_files"]

Takers = Mapping[str, tuple[int, Callable[[str, bytes], None]]]
"""By what a file is: how many bytes it can have, and who takes its name and content."""

_LONGEST_NAME = 200
_WAITING: dict[str, Takers] = {}


def await_files(key: str, takers: Takers | None) -> None:
    """From here on let files come under a session's key, which nobody else knows; none any more without takers."""
    if takers is None:
        _WAITING.pop(key, None)
    else:
        _WAITING[key] = takers


def add_given(app: FastAPI) -> None:
    """Take them at this app."""

    @app.post("/given/{key}/{what}")
    async def given(key: str, what: str, name: str, request: Request) -> Response:
        if key not in _WAITING or what not in _WAITING[key]:
            return _told(404, "no such session")
        most, take = _WAITING[key][what]
        content = bytearray()
        async for part in request.stream():
            content += part
            if len(content) > most:
                return _told(413, f"more than {most // 1024} kB")
        take(name[:_LONGEST_NAME], bytes(content))
        return _told(200, "taken")


def _told(status: int, text: str) -> Response:
    return Response(text, status, media_type="text/plain")
