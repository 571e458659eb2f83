"""Flanks are modified by the mouse and by keys; the transmission error follows, and a drag is one step."""

from typing import Any

import pytest

ENOUGH = 60_000  # ms


def _peak(page: Any) -> str:
    return str(page.get_attribute(".gear-modifications", "data-peak"))


def _changed(page: Any, before: str) -> None:
    page.wait_for_function(
        "before => document.querySelector('.gear-modifications').dataset.peak !== before", arg=before, timeout=ENOUGH
    )


@pytest.mark.long
def test_a_handle_is_dragged_and_moved_by_keys(tab: Any) -> None:
    page = tab.page
    page.click(".left >> text=Flanks")
    page.wait_for_function("() => document.querySelector('.gear-modifications')?.dataset.peak > 0", timeout=ENOUGH)
    before, amount = _peak(page), page.input_value("[data-field=tip_relief]")
    dot = page.locator("[data-handle=tip_relief] .dot")
    dot.scroll_into_view_if_needed()
    box = dot.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    for step in range(1, 7):
        page.mouse.move(x, y + 4 * step)
    _changed(page, before)
    assert str(page.locator(".gear-modifications svg .beside").text_content()).endswith("µm")
    page.mouse.up()
    page.wait_for_selector(".gear-modifications svg .beside", state="detached")
    page.wait_for_selector(".gear-modifications .former")
    farther = "amount => document.querySelector('[data-field=tip_relief]').value > amount + 5"
    page.wait_for_function(farther, arg=float(amount), timeout=ENOUGH)
    page.click(".bar button[title=undo]")
    page.wait_for_function(
        "amount => document.querySelector('[data-field=tip_relief]').value === amount", arg=amount, timeout=ENOUGH
    )
    assert not page.locator(".bar button[title=undo]").is_enabled(), "one step"
    page.focus("[data-handle=profile_crowning]")
    page.keyboard.press("ArrowUp")
    page.keyboard.press("Shift+ArrowUp")
    page.wait_for_function("() => document.querySelector('[data-field=profile_crowning]').value === '11.0'", timeout=ENOUGH)
    page.click(".bar button[title=undo]")
    page.wait_for_function("() => document.querySelector('[data-field=profile_crowning]').value === '0.0'", timeout=ENOUGH)
