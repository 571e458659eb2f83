"""What the pages of the manual show is what comes out: their commands, their output, their Python."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"
sys.path.insert(0, str(DOCS))

from manual.blocks import blocks_of, is_long  # noqa: E402
from manual.running import run_page  # noqa: E402

OTHERS = {"README.md", "papers.md", "overview.md"}
"""How the manual is made, which is no page of it; and what `test_papers_page.py` and `test_readme_commands.py` run."""

PAGES = [page for page in sorted(DOCS.rglob("*.md")) if page.relative_to(DOCS).as_posix() not in OTHERS]


def _runs(page: Path) -> bool:
    return any(block.language in ("console", "python") for block in blocks_of(page.read_text(encoding="utf-8")))


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(
            page, id=page.relative_to(DOCS).with_suffix("").as_posix(), marks=[pytest.mark.long] if is_long(page) else []
        )
        for page in PAGES
        if _runs(page)
    ],
)
def test_page_shows_what_comes_out(page: Path, tmp_path: Path) -> None:
    faults = list(run_page(page, tmp_path))
    assert not faults, "\n".join(f"{page}: {fault}" for fault in faults)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(DOCS).as_posix())
def test_commands_stand_where_they_are_run(page: Path) -> None:
    """But `gearcad open`, which lasts until Ctrl-C."""
    for block in blocks_of(page.read_text(encoding="utf-8")):
        if block.language not in ("console", "python", "toml", "csv"):
            assert not re.search(r"^(?:\$ )?gearcad (?!open)", block.text, re.MULTILINE), f"{page}, line {block.line}: not run"
