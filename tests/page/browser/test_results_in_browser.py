"""Results on the teeth in a browser: curves and colours of the run, of these inputs or marked as of earlier ones."""

from typing import Any

import pytest

ENOUGH = 120_000  # ms

_PIXELS = """() => {
  const canvas = document.querySelector(".gear-section canvas");
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let count = 0; // of the red at the end of the scale of stresses, and the blue at its beginning
  for (let n = 0; n < data.length; n += 4) {
    const [red, green, blue] = data.slice(n, n + 3);
    if (Math.abs(red - 190) < 6 && green < 30 && blue < 50) count += 1;
    if (red < 66 && Math.abs(green - 76) < 20 && blue > 185) count += 1;
  }
  return count;
}"""

_PACKAGES = "() => performance.getEntriesByType('resource').filter(({ name }) => name.includes('/esm/')).length"


def _check(tab: Any) -> None:
    page = tab.page
    page.click(".right >> text=Runs")
    page.click(".run-kinds button:has-text('check in the plane')")
    page.wait_for_selector(".gear-results[data-drawn]", timeout=ENOUGH)


def _turned(page: Any, angle: float) -> None:
    page.evaluate("turn => window.dispatchEvent(new CustomEvent('gear-turn', { detail: { turn } }))", angle)


@pytest.mark.long
def test_a_check_is_seen_on_the_teeth_until_inputs_move_on(tab: Any) -> None:
    page = tab.page
    before = page.evaluate(_PACKAGES)
    assert not page.is_visible(".gear-results")
    assert page.evaluate(_PIXELS) == 0
    _check(tab)
    assert page.evaluate(_PACKAGES) > before, "the package of charts is loaded with the first of them"
    told = page.inner_text(".results-body .told")
    assert "MPa" in told and "µm" in told
    page.wait_for_selector(".gear-legend:has-text('MPa')")
    assert page.evaluate(_PIXELS) > 0
    _turned(page, 0.0)
    page.wait_for_function("() => /°/.test(document.querySelector('.results-body .now')?.textContent ?? '')")
    first = page.inner_text(".results-body .now")
    _turned(page, 0.08)
    page.wait_for_function("first => document.querySelector('.results-body .now')?.innerText !== first", arg=first)
    assert not page.is_visible(".stale-band")
    tab.give("pinion.teeth", "22")
    page.wait_for_selector(".stale-band:has-text('of earlier inputs')")
    page.wait_for_function(f"() => ({_PIXELS})() === 0")
    assert not page.is_visible(".results-body .now") and not page.is_visible(".view:last-of-type .gear-legend:has-text('MPa')")
    page.click(".bar button[title=undo]")
    page.wait_for_selector(".stale-band", state="hidden")
    page.wait_for_function(f"() => ({_PIXELS})() > 0")
    page.click(".results-bar button:has-text('pattern of contact')")
    page.wait_for_function("() => document.querySelector('.gear-results').dataset.drawn.endsWith('flank')")
