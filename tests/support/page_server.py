"""A server of the page, a browser without a window, a tab of it, and what a coroutine gives in a thread of its own."""

import asyncio
import os
import random
import shutil
import socket
import subprocess
import sys
from collections.abc import Coroutine, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
_ARGUMENTS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
"""Everybody is root somewhere, and machines without a graphics card draw all the same."""

SPARING = (
    *("--in-process-gpu", "--disable-gpu-compositing", "--disable-accelerated-2d-canvas", "--renderer-process-limit=1"),
    *("--disable-site-isolation-trials", "--disable-features=site-per-process,SpareRendererForSitePerProcess"),
)
"""Where the processor draws, it draws pages quickest without a graphics card's ways, and one process is quicker than many."""

_OPENED = "field => { for (let at = field.closest('details'); at; at = at.parentElement.closest('details')) at.open = true; }"

DESK = {"width": 1280, "height": 800}

TOLD = "told.txt"
"""What the server that tests share has told of errors."""

_POLL = 50
"""Milliseconds between two looks: at each frame they would keep all frames coming."""


_KEPT = range(20_000, 30_000)
"""Ports that neither the program takes by itself nor the system gives to connections that leave the machine."""


def kept_port() -> int:
    """A free port that stays free while a server of it is away: no other test's server comes upon it by itself."""
    while True:
        port = random.SystemRandom().choice(_KEPT)
        with socket.socket() as tried:
            if tried.connect_ex(("127.0.0.1", port)):
                return port


def serve(
    spec: Path, *options: str, temporary: Path | None = None, told: Path | None = None, browser: str = ""
) -> tuple[subprocess.Popen[str], str]:
    """Start a server of a spec at a port of its own; return it and the address with its token that it prints.

    Its temporary files are in a folder, errors in a file. `browser` is a command that it starts with an address for %s.
    """
    command = [sys.executable, "-m", "gearcad", "open", str(spec), *([] if browser else ["--no-browser"]), *options]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}  # NiceGUI looks
    environment["BROWSER"] = browser
    if temporary is not None:
        environment["TMPDIR"] = str(temporary)
    with (told or Path(os.devnull)).open("w", encoding="utf-8") as errors:
        server = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=errors, text=True, cwd=spec.parent, env=environment)
    assert server.stdout is not None
    address = server.stdout.readline().strip()
    assert address.startswith("http://") and "/?token=" in address, f"no address but {address!r}"
    return server, address


def without_token(address: str) -> str:
    """The address of the page for who has its cookie."""
    return address.partition("?")[0]


@contextmanager
def launched(*options: str) -> Iterator[Any]:
    """Chromium with these options, until the end."""
    from playwright.sync_api import sync_playwright

    os.environ.setdefault("NODE_OPTIONS", "--no-deprecation")
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=[*_ARGUMENTS, *options])
        yield chromium
        chromium.close()


class Tab:
    """A tab that has the page, and what went wrong in it."""

    def __init__(self, page: Any, address: str) -> None:
        self.page, self.address = page, without_token(address)
        self.errors: list[str] = []
        self._before: dict[str, str] = {}
        self.foreign: list[str] = []
        page.on("console", lambda message: self.errors.append(message.text) if message.type == "error" else None)
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on("dialog", self._refuse)
        page.on("request", lambda request: None if self._ours(request.url) else self.foreign.append(request.url))
        page.on("websocket", lambda socket: None if self._ours(socket.url) else self.foreign.append(socket.url))

    def _refuse(self, dialog: Any) -> None:
        if dialog.type == "beforeunload":  # a design that is not saved may go
            dialog.accept()
            return
        self.errors.append(f"dialog: {dialog.message}")
        dialog.dismiss()

    def _ours(self, url: str) -> bool:
        return url.startswith((self.address, self.address.replace("http", "ws", 1), "data:", "blob:"))

    def field(self, key: str) -> Any:
        """The input of a key, whose tables and groups are opened."""
        found = self.page.locator(f'[data-key="{key}"] :is(input, select)').first
        found.evaluate(_OPENED)
        return found

    def shown(self) -> str:
        """What is told from the bodies that the scene shows now."""
        return str(self.page.get_attribute(".scene", "data-shown"))

    def give(self, key: str, text: str) -> None:
        """Type into a field, and wait until the bodies are those of the design that comes of it."""
        self._before.setdefault(key, self.field(key).input_value())
        before = self.shown()
        self.field(key).fill(text)
        changed = "former => document.querySelector('.scene').dataset.shown !== former"
        self.page.wait_for_function(changed, arg=before, polling=_POLL)

    def give_back(self) -> None:
        """Every field that was given to has what it had before."""
        before, self._before = self._before, {}
        for key, text in before.items():
            if self.field(key).input_value() != text:
                self.give(key, text)
        self._before = {}


Given = TypeVar("Given")


def awaited(coroutine: Coroutine[Any, Any, Given]) -> Given:
    """The result of a coroutine."""
    with ThreadPoolExecutor(1) as other:
        return other.submit(asyncio.run, coroutine).result()
