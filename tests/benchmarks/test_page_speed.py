"""From a keystroke to what is seen of it, measured in a browser. To see the figures, call

    pytest -m benchmark_suite tests/benchmarks/test_page_speed.py -s

Milliseconds, medians over a thickness of teeth that is typed anew again and again: until the frame is made that has the
section, the bodies, the data sheet, the rating. That of a planetary train begins when the hand rests, and nobody waits for it.
Beside them the processor time of the server, and that of the page's own thread, for a keystroke: a loaded machine changes them
little. Chromium draws without a graphics card.
"""

import os
import statistics
from collections.abc import Iterator
from typing import Any

import psutil
import pytest
from support.page_server import CHROMIUM, launched, serve
from support.specs import TEMPLATES

pytestmark = [
    pytest.mark.benchmark_suite,
    pytest.mark.skipif(CHROMIUM is None, reason="needs Chromium: apt-get install chromium"),
]

THINNED = (
    *("spur", "volvo-13-44", "reducer-21-43", "fzg-c", "uhlir-19-23", "uhlir-19-23-simple", "ring-22-70", "rack"),
    *("double-23-81", "alm-18-161", "ground-25-41", "wire-cut"),
)
TRAINS = ("planetary-24-21-66", "planetary-alm", "planetary-alm-in-phase", "planetary-differential", "printed-planetary")
STARTERS = (*THINNED, *TRAINS, "spline")
"""All that have bodies, but those that are typed as text."""

TYPED = {"spur": ("profile_shift", 0.061), "spline": ("spline.length", 21.0)}
"""Key that is typed into, and its first value; of all others the thickness."""

CHANGES = 15

MOST = 110.0
"""ms until a keystroke is seen in the section and in the data sheet, on a machine that does nothing else."""

SOLID = 150.0
"""ms until the bodies are."""

MANY = 200.0
"""ms until the bodies of a train are: nine gears, drawn by the processor."""

SOON = 300.0
"""ms until the rating of a pair is there."""

_WATCH = """() => {
  window.seen = {};
  const after = new MessageChannel();
  const waiting = [];
  after.port1.onmessage = () => {
    for (const what of waiting.splice(0)) window.seen[what] ??= performance.now() - window.typed;
  };
  const note = (what) => requestAnimationFrame(() => { waiting.push(what); after.port2.postMessage(0); });
  const sheets = [...document.querySelectorAll(".gear-sheet")];
  const watch = (element, what, options) => element && new MutationObserver(() => note(what)).observe(element, options);
  watch(document.querySelector(".gear-section"), "section", { attributes: true, attributeFilter: ["data-teeth"] });
  watch(document.querySelector(".scene"), "bodies", { attributes: true, attributeFilter: ["data-shown"] });
  const all = { childList: true, characterData: true, subtree: true };
  watch(sheets.at(-1), "sheet", all);
  if (sheets.length > 1) watch(sheets[0], "rating", { ...all, attributes: true });
  window.addEventListener("input", () => { window.seen = {}; window.typed = performance.now(); }, true);
}"""


def _busy(meter: Any) -> float:
    """Seconds that the page's own thread has worked."""
    metrics = {each["name"]: each["value"] for each in meter.send("Performance.getMetrics")["metrics"]}
    return float(metrics["TaskDuration"])


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with launched("--disable-gpu-compositing") as chromium:  # as browsers themselves do without a graphics card
        yield chromium


@pytest.mark.parametrize("starter", STARTERS)
def test_a_keystroke_is_seen_at_once(browser: Any, starter: str) -> None:
    server, address = serve(TEMPLATES / f"{starter}.toml")
    page = browser.new_context(viewport={"width": 1280, "height": 800}).new_page()
    try:
        page.goto(address)
        page.wait_for_selector(".scene[data-shown]:not([data-shown='0'])", timeout=60_000)
        page.wait_for_timeout(2_000)
        page.evaluate(_WATCH)
        key, first = TYPED.get(starter, ("tooth_thinning", 0.061))  # none of a starter
        if starter not in TYPED:
            page.locator(".find input").first.fill(key)  # it is folded, and found
        given, any_at_all = (page.locator(f'{field}[data-key$="{key}"] input') for field in (".given", ".field"))
        field = (given if given.count() else any_at_all).first
        process, found, computed, drawn = psutil.Process(server.pid), [], 0.0, 0.0
        meter = page.context.new_cdp_session(page)
        meter.send("Performance.setTimeDomain", {"timeDomain": "threadTicks"})
        meter.send("Performance.enable")
        for change in range(CHANGES + 3):
            if change == 3:
                computed, drawn = sum(process.cpu_times()[:2]), _busy(meter)
            field.fill(f"{first + change / 1000:.3f}")
            page.wait_for_function("() => window.seen.section && window.seen.bodies && window.seen.sheet", polling=20)
            page.wait_for_timeout(500)
            found.append(page.evaluate("() => window.seen"))
        computed, drawn = (sum(process.cpu_times()[:2]) - computed) / CHANGES, (_busy(meter) - drawn) / CHANGES
        seen = {
            what: statistics.median(each[what] for each in found[3:] if what in each)
            for what in ("section", "bodies", "sheet", "rating")
            if any(what in each for each in found[3:])
        }
    finally:
        page.context.close()
        server.terminate()
        server.wait(20)
    told = "  ".join(f"{what} {seen[what]:4.0f} ms" for what in seen)
    used = f"server {1000 * computed:4.0f}, page {1000 * drawn:4.0f} ms of a processor, {os.cpu_count()} cores"
    print(f"\n{starter:22} {told}  {used}")
    assert max(seen["section"], seen["sheet"]) < MOST and seen["bodies"] < (MANY if starter in TRAINS else SOLID)
    assert starter in TRAINS or seen.get("rating", 0.0) < SOON
