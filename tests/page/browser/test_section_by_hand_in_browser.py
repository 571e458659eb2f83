"""By hand in the section: a handle is dragged, a tooth is measured, the tool rolls."""

from typing import Any

import pytest

ENOUGH = 60_000  # ms


def _mode(page: Any, mode: str) -> None:
    page.select_option(".section-tools select >> nth=0", mode)
    page.wait_for_selector(f".section-tools[data-mode={mode}]", timeout=ENOUGH)


def _value(page: Any, key: str) -> float:
    return float(page.input_value(f"[data-handle='{key}']"))


def _handle(page: Any, number: int) -> tuple[float, float]:
    """Where the section drew the square of a handle, in pixels of the page."""
    page.wait_for_function("() => document.querySelector('.section-tools').dataset.places")
    x, y = page.get_attribute(".section-tools", "data-places").split()[number].split(",")
    box = page.locator(".gear-section canvas").bounding_box()
    return box["x"] + float(x), box["y"] + float(y)


@pytest.mark.long
def test_handles_measures_and_the_tool(tab: Any) -> None:
    page = tab.page
    _mode(page, "draw")
    page.wait_for_selector("[data-handle='pair.centre_distance']")
    before = _value(page, "pinion.tip_diameter")
    x, y = _handle(page, 0)
    page.mouse.move(x, y)
    page.mouse.down()
    for step in range(1, 6):
        page.mouse.move(x + step, y)  # a little outwards: the gears still mesh
    page.wait_for_function(
        "before => Number(document.querySelector(\"[data-handle='pinion.tip_diameter']\").value) !== before",
        arg=before,
        timeout=ENOUGH,
    )
    page.mouse.up()
    page.wait_for_timeout(500)
    page.click(".bar button[title=undo]")
    page.wait_for_function(
        "before => Number(document.querySelector(\"[data-handle='pinion.tip_diameter']\").value) === before",
        arg=before,
        timeout=ENOUGH,
    )
    assert not page.locator(".bar button[title=undo]").is_enabled(), "one step"
    _mode(page, "thickness")
    page.fill(".section-tools .size", "64.2")
    page.keyboard.press("Enter")
    page.wait_for_selector(".section-tools p:has-text('4.7109 mm')")
    _mode(page, "tool")
    page.wait_for_selector(".section-tools input[type=range]")
    page.fill(".section-tools input[type=range]", "0")
    page.click(".section-tools .row button")
    page.wait_for_function("() => document.querySelector('.section-tools input[type=range]').value > 3")
    page.click(".section-tools .row button")
    _mode(page, "look")
