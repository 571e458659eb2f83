"""What runs have made, as the browser fetches it: reports to be read, files to be taken along."""

from __future__ import annotations

import secrets
import zipfile
from fnmatch import fnmatch
from pathlib import Path

from fastapi import FastAPI, Response
from fastapi.responses import FileResponse

from gearcad.page.run import Run, State
from gearcad.page.run_kinds import RUNS
from gearcad.page.runs import runs_of

__all__ = ["add_made", "taken_along"]

_POLICY = (
    "sandbox allow-scripts; default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; "
    "font-src data:; form-action 'none'; base-uri 'none'"
)
"""A report minds itself: it may run what stands in it, and reach nothing else, this page neither."""

_HEADERS = {"X-Content-Type-Options": "nosniff", "Referrer-Policy": "no-referrer", "Cache-Control": "no-store"}


def add_made(app: FastAPI) -> None:
    """Answer requests for them; a path is looked up among what a run has made, and never used as one."""

    @app.get("/made/{key}/{number}")
    def files(key: str, number: int) -> Response:
        run = _run(key, number)
        return _missing() if run is None else _attached(run)

    @app.get("/made/{key}/{number}/{name}")
    def report(key: str, number: int, name: str) -> Response:
        run = _run(key, number)
        if run is None or name != RUNS[run.asked.kind].report or (path := run.file(name)) is None:
            return _missing()
        return FileResponse(path, media_type="text/html", headers={**_HEADERS, "Content-Security-Policy": _POLICY})


def taken_along(run: Run) -> tuple[str, Path]:
    """Name and path of the file that holds what a run has made: the one file, or a zip of several."""
    kind = run.asked.kind
    paths = [path for name in run.files if fnmatch(name, RUNS[kind].taken) and (path := run.file(name)) is not None]
    if len(paths) == 1:
        return f"{run.name}{paths[0].suffix}", paths[0]
    packed = run.folder.with_suffix(".zip")
    if not packed.exists():
        unfinished = packed.with_suffix(f".{secrets.token_hex(4)}")
        with zipfile.ZipFile(unfinished, "w", zipfile.ZIP_DEFLATED) as archive:
            for path in paths:
                archive.write(path, path.name)
        unfinished.replace(packed)
    return f"{run.name}-{kind}.zip", packed


def _run(key: str, number: int) -> Run | None:
    """A run that has files."""
    runs = runs_of(key)
    found = runs.all[number] if runs is not None and 0 <= number < len(runs.all) else None
    return found if found is not None and found.state is State.DONE and found.files else None


def _attached(run: Run) -> Response:
    name, path = taken_along(run)
    return FileResponse(path, filename=name, media_type="application/octet-stream", headers=_HEADERS)


def _missing() -> Response:
    return Response("no such file\n", 404, media_type="text/plain")
