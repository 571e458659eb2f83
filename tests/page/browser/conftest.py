"""One server and one browser for all tests of the page; without Chromium they are skipped."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
_ARGUMENTS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
"""Everybody is root somewhere, and machines without a graphics card draw all the same."""


def serve(spec: Path, *options: str) -> tuple[subprocess.Popen[str], str]:
    """A server of a spec at a port of its own, and its address."""
    command = [sys.executable, "-m", "gearcad", "open", str(spec), "--no-browser", *options]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}  # NiceGUI looks
    server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=spec.parent, env=environment)
    assert server.stdout is not None
    address = server.stdout.readline().strip()
    assert address.startswith("http://"), f"no address but {address!r}"
    return server, address


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
    if CHROMIUM is None:
        pytest.skip("needs Chromium: apt-get install chromium")
    server, at = serve(folder / "reducer-21-43.toml")
    yield at
    server.terminate()
    server.wait(20)


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """Chromium without a window."""
    if CHROMIUM is None:
        pytest.skip("needs Chromium: apt-get install chromium")
    from playwright.sync_api import sync_playwright

    os.environ.setdefault("NODE_OPTIONS", "--no-deprecation")
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=_ARGUMENTS)
        yield chromium
        chromium.close()


class Tab:
    """A tab that has the page, and what went wrong in it."""

    def __init__(self, page: Any, address: str) -> None:
        self.page, self.address = page, address
        self.errors: list[str] = []
        self.foreign: list[str] = []
        page.on("console", lambda message: self.errors.append(message.text) if message.type == "error" else None)
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on("request", lambda request: None if self._ours(request.url) else self.foreign.append(request.url))

    def _ours(self, url: str) -> bool:
        return url.startswith((self.address, self.address.replace("http", "ws", 1), "data:", "blob:"))

    def field(self, key: str) -> Any:
        """The input of a key."""
        return self.page.locator(f'[data-key="{key}"] :is(input, select)').first

    def shown(self) -> str:
        """What is told from the bodies that the scene shows now."""
        return str(self.page.get_attribute(".scene", "data-shown"))

    def give(self, key: str, text: str) -> None:
        """Type into a field, and wait until the bodies are those of the design that comes of it."""
        before = self.shown()
        self.field(key).fill(text)
        self.page.wait_for_function("former => document.querySelector('.scene').dataset.shown !== former", arg=before)


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
