"""One server and one browser for all tests of the page; without Chromium they are skipped."""

import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from support.page_server import CHROMIUM, DESK, SPARING, TOLD, Tab, launched, serve, without_token
from support.specs import starter_specs


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of starters in which the server runs."""
    place = tmp_path_factory.mktemp("page")
    for starter in starter_specs():
        shutil.copy(starter, place)
    return place


@pytest.fixture(scope="session")
def served(folder: Path) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """The server of the page of a pair that holds, and its address."""
    server, at = serve(folder / "reducer-21-43.toml", told=folder / TOLD)
    yield server, at
    server.terminate()
    server.wait(20)


@pytest.fixture(scope="session")
def address(served: tuple[subprocess.Popen[str], str]) -> str:
    """The address of the page, with its token."""
    return served[1]


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """Chromium without a window."""
    if CHROMIUM is None:
        pytest.skip("needs Chromium: apt-get install chromium")
    with launched(*SPARING) as chromium:
        yield chromium


@pytest.fixture(scope="session")
def window(browser: Any, address: str) -> Any:
    """What tabs have in common: what was fetched once, and a process that has compiled it."""
    context = browser.new_context(viewport=DESK)
    context.request.get(address)
    context.new_page().goto(f"{without_token(address)}nothing")
    return context


def _loaded(window: Any, address: str) -> Tab:
    """A tab with the page in it."""
    found = Tab(window.new_page(), address)
    found.page.goto(address)
    found.page.wait_for_selector(".scene[data-shown]")
    return found


@pytest.fixture
def tab(window: Any, address: str) -> Iterator[Tab]:
    """A tab of its own with the page in it; that nothing went wrong and nothing foreign was asked for is part of each test."""
    first, *others = window.pages
    found = _loaded(window, address)
    yield found
    for page in window.pages[1:]:
        if page not in others:
            page.close()
    first.evaluate("localStorage.clear()")
    assert not found.errors
    assert not found.foreign


@pytest.fixture(scope="session")
def loaded(window: Any, address: str) -> Tab:
    """The tab that is lent."""
    return _loaded(window, address)


@pytest.fixture
def lent(loaded: Tab) -> Iterator[Tab]:
    """A tab for tests that leave the page as they find it, but for what they give; that goes back."""
    loaded.page.bring_to_front()
    yield loaded
    loaded.give_back()
    assert not loaded.errors
    assert not loaded.foreign
