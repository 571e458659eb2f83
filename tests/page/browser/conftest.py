"""One server and one browser for all tests of the page; without Chromium they are skipped."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from support.page_server import CHROMIUM, Tab, launched, serve


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of starters in which the server runs."""
    place = tmp_path_factory.mktemp("page")
    for starter in (Path(__file__).parents[3] / "templates").glob("*.toml"):
        if not starter.name.startswith("drawing_"):
            shutil.copy(starter, place)
    return place


@pytest.fixture(scope="session")
def address(folder: Path) -> Iterator[str]:
    """Of the page of a pair that holds."""
    server, at = serve(folder / "reducer-21-43.toml")
    yield at
    server.terminate()
    server.wait(20)


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """Chromium without a window."""
    if CHROMIUM is None:
        pytest.skip("needs Chromium: apt-get install chromium")
    with launched() as chromium:
        yield chromium


@pytest.fixture
def tab(browser: Any, address: str) -> Iterator[Tab]:
    """A tab of its own with the page in it; that nothing went wrong and nothing foreign was asked for is part of each test."""
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    found = Tab(context.new_page(), address)
    found.page.goto(address)
    found.page.wait_for_selector(".scene[data-shown]")
    yield found
    context.close()
    assert not found.errors
    assert not found.foreign
