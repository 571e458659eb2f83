"""The page by keys alone: all of it is reached by Tab, seen where it is, and left again."""

from __future__ import annotations

from typing import Any

import pytest

from gearcad.designs.reader import starter_text
from gearcad.page.workbench import pack

_BEGIN = """keep => {
  for (const table of document.querySelectorAll(".inputs .table")) table.open = table.open && keep;
  const kinds = "a[href], button, input, select, textarea, summary, [tabindex], [contenteditable]";
  const all = [...document.querySelectorAll(kinds)];
  window.all = all.filter((each) => each.tabIndex >= 0 && !each.disabled && each.checkVisibility({ visibilityProperty: true }));
  window.reached = [];
  window.unseen = [];
  document.addEventListener("focusin", ({ target }) => {
    window.reached.push(window.all.indexOf(target));
    const { outlineStyle, outlineWidth, boxShadow } = getComputedStyle(target);
    const marked = boxShadow !== "none" || (outlineStyle !== "none" && outlineWidth !== "0px");
    const { x, y, right, bottom } = target.getBoundingClientRect();
    const inside = right > 0 && bottom > 0 && x < innerWidth && y < innerHeight;
    if (!marked || !inside) window.unseen.push(target.outerHTML.slice(0, 200));
  });
  return all.length && window.all.length;
}"""
"""What Tab should reach - of the inputs only the headings of tables, unless they are kept open - and what it does reach."""


def _walk(tab: Any, keep: bool) -> None:
    """All is reached once, in the order in which it stands in the page, and is then seen and marked; then the page is left."""
    count = tab.page.evaluate(_BEGIN, keep)
    for _ in range(count + 1):
        tab.page.keyboard.press("Tab")
    reached = tab.page.evaluate("window.reached")
    assert reached[:count] == list(range(count))
    assert tab.page.evaluate("window.unseen") == []


def test_tab_reaches_everything_once(tab: Any) -> None:
    _walk(tab, keep=False)


@pytest.mark.long
@pytest.mark.parametrize("starter", ["reducer", "rack", "planetary-alm", "train-pairs"])
def test_tab_reaches_everything_of_every_kind_and_pane_once(tab: Any, starter: str) -> None:
    page, name = tab.page, starter_text(starter)[0].removesuffix(".toml")
    for left, right in ((1, 1), (3, 2), (3, 3)):
        page.goto(f"{tab.address}?lang=en&design={pack(name, starter_text(starter)[1])}")
        page.wait_for_function("name => document.querySelector('.bar .name').textContent === name", arg=name)
        page.click(f".left .q-tab:nth-child({left})")
        page.click(f".right .q-tab:nth-child({right})")
        page.mouse.click(900, 10)
        page.wait_for_timeout(8_000)  # until what takes long is found, and the page stands still
        _walk(tab, keep=True)


def _focused(tab: Any) -> str:
    return str(tab.page.evaluate("document.activeElement.className + ' ' + document.activeElement.textContent"))


def test_escape_closes_what_is_open_and_leads_back_and_out_of_the_text(tab: Any) -> None:
    page, keys = tab.page, tab.page.keyboard
    page.locator(".files > summary").focus()
    keys.press("Enter")
    page.wait_for_selector(".files-menu .makes button")
    keys.press("Tab")
    keys.press("Escape")
    page.wait_for_selector(".files:not([open])")
    assert _focused(tab).endswith("File")
    page.get_by_role("button", name="Beside").focus()
    keys.press("Enter")
    page.wait_for_selector(".q-menu :focus, .q-menu:focus")
    keys.press("Escape")
    page.wait_for_selector(".q-menu", state="detached")
    assert _focused(tab).endswith("Beside")
    keys.press("?")
    page.wait_for_selector("dialog[open]")
    keys.press("Escape")
    page.wait_for_selector("dialog:not([open])", state="attached")
    assert _focused(tab).endswith("Beside")
    page.click(".left .q-tab:nth-child(2)")
    page.focus(".cm-content")
    keys.press("Escape")
    keys.press("Tab")
    assert "cm-content" not in _focused(tab)
