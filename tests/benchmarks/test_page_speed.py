"""From a keystroke to what is seen of it, measured in a browser. To see the figures, call

    pytest -m benchmark_suite tests/benchmarks/test_page_speed.py -s

Milliseconds, medians over a thickness of teeth that is typed anew again and again: until the section is drawn, the bodies are,
the data sheet is, and the rating is. Chromium draws bodies without a graphics card here, which is most of their time.
"""

from __future__ import annotations

import os
import statistics
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from support.page_server import CHROMIUM, launched, serve

pytestmark = [
    pytest.mark.benchmark_suite,
    pytest.mark.skipif(CHROMIUM is None, reason="needs Chromium: apt-get install chromium"),
]

TEMPLATES = Path(__file__).parents[2] / "templates"
STARTERS = ("spur", "volvo-13-44", "reducer-21-43", "ring-22-70", "rack", "double-23-81", "alm-18-161", "planetary-alm")
CHANGES = 15

MOST = 150.0
"""ms until a keystroke is seen in section and bodies of a pair, on a machine that does nothing else."""

_WATCH = """() => {
  window.seen = {};
  const note = (what) => requestAnimationFrame(() => { window.seen[what] = performance.now() - window.typed; });
  const sheets = [...document.querySelectorAll(".gear-sheet")];
  const watch = (element, what, options) => element && new MutationObserver(() => note(what)).observe(element, options);
  watch(document.querySelector(".gear-section"), "section", { attributes: true, attributeFilter: ["data-teeth"] });
  watch(document.querySelector(".scene"), "bodies", { attributes: true, attributeFilter: ["data-shown"] });
  const all = { childList: true, characterData: true, subtree: true };
  watch(sheets.at(-1), "sheet", all);
  if (sheets.length > 1) watch(sheets[0], "rating", { ...all, attributes: true });
  window.addEventListener("input", () => { window.seen = {}; window.typed = performance.now(); }, true);
}"""


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with launched() as chromium:
        yield chromium


def _memory(pid: int) -> float:
    """MB that a process has."""
    return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


@pytest.mark.parametrize("starter", STARTERS)
def test_a_keystroke_is_seen_at_once(browser: Any, starter: str) -> None:
    server, address = serve(TEMPLATES / f"{starter}.toml")
    page = browser.new_context(viewport={"width": 1280, "height": 800}).new_page()
    try:
        page.goto(address)
        page.wait_for_selector(".scene[data-shown]:not([data-shown='0'])", timeout=60_000)
        page.wait_for_timeout(2_000)
        page.evaluate(_WATCH)
        given, any_at_all = (page.locator(f'{field}[data-key$="tooth_thinning"] input') for field in (".given", ".field"))
        field = (given if given.count() else any_at_all).first
        found, before = [], 0.0
        for change in range(CHANGES + 3):
            field.fill(f"{0.05 + change / 1000:.3f}")
            page.wait_for_function("() => window.seen.section && window.seen.bodies && window.seen.sheet", timeout=20_000)
            page.wait_for_timeout(500)
            found.append(page.evaluate("() => window.seen"))
            before = before or _memory(server.pid)
        seen = {
            what: statistics.median(each[what] for each in found[3:] if what in each)
            for what in ("section", "bodies", "sheet", "rating")
            if any(what in each for each in found[3:])
        }
        grown = _memory(server.pid) - before
    finally:
        page.context.close()
        server.terminate()
        server.wait(20)
    print(
        f"\n{starter:16}",
        *(f"{what} {seen[what]:5.0f} ms" for what in seen),
        f"memory {grown:+.1f} MB",
        os.cpu_count(),
        "cores",
    )
    assert max(seen["section"], seen["bodies"]) < MOST
