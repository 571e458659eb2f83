"""Every name that users import stands in the manual; and the whole manual is built without a warning, without the network."""

from __future__ import annotations

import re
import socket
import sys
from pathlib import Path
from types import ModuleType

import pytest

import gearcad

DOCS = Path(__file__).parents[2] / "docs"

CALLED_OTHERWISE = {"read": "read_spec"}
"""Names of the entrance whose documentation stands under that of their home."""


def test_every_public_name_is_documented() -> None:
    pages = "".join(page.read_text(encoding="utf-8") for page in (DOCS / "api").glob("*.md"))
    directives = re.findall(r"^\.\. auto(\w+):: (\S+)", pages, re.MULTILINE)
    whole = [name.rpartition(".")[2] for kind, name in directives if kind == "module"]
    documented = {name.rpartition(".")[2] for _, name in directives}
    rooms = {room: found for room in dir(gearcad) if isinstance(found := getattr(gearcad, room), ModuleType)}
    public = {CALLED_OTHERWISE.get(name, name) for name in gearcad.__all__ if not name.startswith("__")}
    for room, module in rooms.items():
        if room not in whole:
            public |= set(getattr(module, "__all__", ()))
    assert not public - documented
    for _, name in directives:
        assert name.startswith("gearcad.")


@pytest.mark.long
def test_manual_is_built_without_a_warning_and_offline(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    build = pytest.importorskip("sphinx.cmd.build", reason="the extra docs is not installed")

    def refuse(*address: object) -> None:
        raise AssertionError(f"the network is asked for: {address}")

    monkeypatch.setattr(socket.socket, "connect", refuse)
    monkeypatch.setattr(sys, "path", [*sys.path])
    assert build.main(["-W", "-q", "-d", str(tmp_path / "trees"), str(DOCS), str(tmp_path / "manual")]) == 0
    for page in (tmp_path / "manual").rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        assert not re.findall(r"<(?:script|link|img|iframe)[^>]*(?:src|href)=\"(?:https?:)?//[^\"]*", text), page
    for sheet in (tmp_path / "manual").rglob("*.css"):
        assert not re.findall(r"url\([\"']?(?:https?:)?//[^)]*", sheet.read_text(encoding="utf-8")), sheet
    index = (tmp_path / "manual" / "searchindex.js").read_text(encoding="utf-8")
    assert '"commands/build"' in index
