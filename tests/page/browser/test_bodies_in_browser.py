"""Bodies and section in a browser: they turn together, are cut and measured, and leave no memory behind."""

from __future__ import annotations

from typing import Any

from gearcad.designs.reader import starter_text
from gearcad.page.workbench import pack

CHANGES = 8

NEARER = 15
"""Steps by which the section is looked at from near: each a quarter nearer."""

QUICK = 10_000
"""Milliseconds until a picture of the page is there, on a loaded machine."""

_NO_WEBGL = """
const get = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
  return kind.startsWith("webgl") ? null : get.call(this, kind, ...rest);
};
"""


def _memory(tab: Any) -> tuple[str | None, ...]:
    tab.page.wait_for_function("() => document.querySelector('.scene').dataset.geometries > 0")
    tab.page.wait_for_timeout(300)  # until what was asked for is drawn
    return tuple(tab.page.get_attribute(".scene", f"data-{kind}") for kind in ("geometries", "textures", "programs"))


def test_the_section_follows_the_roll_angle(lent: Any) -> None:
    slider = lent.page.locator(".gear-roll input")
    slider.focus()
    lent.page.keyboard.press("ArrowRight")
    turned = float(slider.input_value())
    assert turned > 0
    lent.page.wait_for_function(
        "turn => Math.abs(document.querySelector('.gear-section canvas').dataset.turn - turn) < 1e-9", arg=turned
    )


def test_space_lets_the_gears_turn_and_stops_them(lent: Any) -> None:
    lent.page.locator(".gear-section canvas").focus()
    before = float(lent.page.get_attribute(".gear-section canvas", "data-turn") or 0)
    lent.page.keyboard.press(" ")
    turned = "before => Math.abs(document.querySelector('.gear-section canvas').dataset.turn - before) > 0.01"
    lent.page.wait_for_function(turned, arg=before)
    lent.page.keyboard.press(" ")
    assert lent.page.get_attribute(".gear-roll button", "aria-pressed") == "false"


def test_memory_stays_where_it_is_over_many_changes(lent: Any) -> None:
    before = _memory(lent)
    for change in range(CHANGES):
        lent.give("pinion.teeth", str(22 - change % 2))
    assert _memory(lent) == before


def test_bodies_are_cut_and_made_whole(lent: Any) -> None:
    before = _memory(lent)
    lent.page.select_option(".scene select", "z")
    lent.page.wait_for_function("() => document.querySelector('.scene').dataset.geometries > 4")
    assert "12.50 mm" in lent.page.inner_text(".scene .tools")
    lent.page.select_option(".scene select", "")
    lent.page.wait_for_function("before => document.querySelector('.scene').dataset.geometries === before", arg=before[0])


def test_two_points_are_measured(lent: Any) -> None:
    lent.page.get_by_role("button", name="measure").click()
    lent.page.get_by_role("button", name="front").click()
    box = lent.page.locator(".scene canvas").bounding_box()
    for share in (0.45, 0.75):  # both on the end faces, which are 25 and 24 mm high
        lent.page.mouse.click(box["x"] + share * box["width"], box["y"] + 0.62 * box["height"])
    assert "±" in lent.page.inner_text(".scene .measured")
    lent.page.get_by_role("button", name="measure").click()


def test_without_webgl_it_says_so_and_all_else_works(browser: Any, address: str) -> None:
    context = browser.new_context()
    page = context.new_page()
    page.add_init_script(_NO_WEBGL)
    page.goto(address)
    page.wait_for_selector(".gear-section[data-teeth='21 43']")
    assert "no WebGL" in page.inner_text(".scene .nothing")
    context.close()


def test_a_rack_is_drawn_at_once_however_near_one_looks(tab: Any) -> None:
    """Dashes far beyond the view once took half a minute."""
    tab.page.goto(f"{tab.address}?lang=en&design={pack('rack', starter_text('rack')[1])}")
    tab.page.wait_for_selector(".scene[data-shown]")
    canvas = tab.page.locator(".gear-section canvas")
    canvas.focus()
    for _ in range(NEARER):
        tab.page.keyboard.press("+")
    tab.page.screenshot(timeout=QUICK)
