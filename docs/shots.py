"""Photographs reports, and the page, for the manual's pages of commands: `python docs/shots.py`, with Playwright and Chromium.

What takes minutes, and a browser, is committed in `docs/shots`; all other figures are made while the manual is built.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image

FOLDER = Path(__file__).parent / "shots"
WIDTH, HEIGHT, COLOURS = 1100, 1000, 64
SHOTS = {
    "rate": ("reducer-21-43", "rate.html", "safeties"),
    "stiffness": ("reducer-21-43", "stiffness.html", "the-methods-side-by-side"),
    "check": ("reducer-21-43", "report.html", "figures"),
    "dynamics": ("reducer-21-43", "dynamics.html", "dynamic-factor"),
    "planetary": ("planetary-24-21-66", "planetary.html", "scheme"),
}
"""By the command: the starter, the report, and where it is opened."""


def _gearcad(*arguments: str, folder: str) -> None:
    subprocess.run([sys.executable, "-m", "gearcad", *arguments, "--quiet"], cwd=folder, check=False, stdout=subprocess.DEVNULL)


def _shoot(browser: object, address: str, path: Path, wait: float = 0.5) -> None:
    page = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})  # type: ignore[attr-defined]
    page.goto(address)
    page.wait_for_timeout(1000 * wait)
    page.screenshot(path=path)
    page.close()
    Image.open(path).convert("RGB").quantize(COLOURS).save(path, optimize=True)


def main() -> None:
    from playwright.sync_api import sync_playwright

    asked = sys.argv[1:] or [*SHOTS, "open"]
    FOLDER.mkdir(exist_ok=True)
    with TemporaryDirectory() as folder, sync_playwright() as playwright:
        arguments = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox"]
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=arguments)
        for command in asked:
            starter, report, section = SHOTS.get(command, ("reducer-21-43", "", ""))
            subprocess.run([sys.executable, "-m", "gearcad", "new", starter, "--force"], cwd=folder, check=True)
            if command != "open":
                _gearcad(command, f"{starter}.toml", folder=folder)
                address = f"{(Path(folder) / 'output' / starter / report).as_uri()}#section-{section}"
                _shoot(browser, address, FOLDER / f"{command}.png")
                continue
            line = [sys.executable, "-m", "gearcad", "open", f"{starter}.toml", "--no-browser"]
            server = subprocess.Popen(line, cwd=folder, stdout=subprocess.PIPE, text=True)
            address = next(word for words in server.stdout for word in words.split() if word.startswith("http"))
            _shoot(browser, address, FOLDER / "open.png", wait=8)
            server.terminate()


if __name__ == "__main__":
    main()
