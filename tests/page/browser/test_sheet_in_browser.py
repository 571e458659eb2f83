"""The data sheet in a browser: what changed, what is folded, what is searched, and where notices lead."""

from __future__ import annotations

from typing import Any

from gearcad.designs.reader import starter_text
from gearcad.page.workbench import pack

LEAST_WIDTH = 100
"""Pixels in which the words of a quantity can be read."""

SHEET = '.gear-sheet[aria-label="data sheet"]'


def value(tab: Any, key: str) -> Any:
    """The cells of a row outside the first figures."""
    return tab.page.locator(f'{SHEET} tr[data-row="{key}"]').last.locator(".value")


def test_what_changed_stands_beside_what_it_was(tab: Any) -> None:
    before = value(tab, "pair.transverse_contact_ratio").text_content().strip()
    tab.give("pinion.profile_shift", "0.35")
    cell = value(tab, "pair.transverse_contact_ratio")
    cell.locator("del").wait_for()
    assert cell.locator("del").text_content() == before
    assert cell.locator(".whole").text_content() + cell.locator(".rest").text_content() != before
    assert "values changed" in tab.page.inner_text(f'{SHEET} [role="status"]')


def test_folding_stays_over_changes(lent: Any) -> None:
    block = lent.page.locator(f"{SHEET} details", has_text="Diameters").last
    block.locator("summary").click()
    assert block.get_attribute("open") is None
    lent.give("pinion.teeth", "22")
    assert block.get_attribute("open") is None


def test_rows_are_found_and_walked_and_pinned_by_keys(tab: Any) -> None:
    tab.page.fill(f"{SHEET} .search", "root form")
    rows = tab.page.locator(f"{SHEET} tr[data-row]")
    assert rows.count() == 1
    rows.first.focus()
    tab.page.keyboard.press("Enter")
    tab.page.fill(f"{SHEET} .search", "")
    first = tab.page.locator(f"{SHEET} details").first
    assert first.locator('tr[data-row="gear.form_diameter"]').count() == 1
    first.locator("tr[data-row]").first.focus()
    tab.page.keyboard.press("ArrowDown")
    assert tab.page.evaluate("document.activeElement.dataset.row") == first.locator("tr[data-row]").nth(1).get_attribute(
        "data-row"
    )


def test_a_notice_leads_to_its_field(lent: Any) -> None:
    lent.give("pinion.profile_shift", "-0.4")
    lent.page.locator(f"{SHEET} .notices .key", has_text="pinion.profile_shift").first.click()
    lent.page.wait_for_function("document.activeElement.closest('[data-key]')?.dataset.key === 'pinion.profile_shift'")


def test_a_kept_design_stands_beside_changes_places_and_is_let_go(tab: Any) -> None:
    page = tab.page
    page.get_by_role("button", name="Beside").click()
    page.get_by_text("keep this design").click()
    page.wait_for_selector(".beside-kept")
    tab.give("pinion.profile_shift", "0.35")
    row = page.locator(f'{SHEET} tr[data-row="gear.profile_shift"]').last
    kept = row.locator("xpath=following-sibling::tr[@class='kept']")
    kept.wait_for()
    assert "0.2000" in kept.inner_text()
    assert "(+0.1500)" in kept.inner_text()
    page.get_by_role("button", name="swap").click()
    page.wait_for_function("document.querySelector('[data-key=\"pinion.profile_shift\"] input').value === '0.2'")
    kept.get_by_text("(-0.1500)").wait_for()
    page.get_by_role("button", name="Deutsch").click()
    page.get_by_text("behalten (Unterschied)").first.wait_for()
    page.get_by_role("button", name="English").click()
    kept.get_by_text("(-0.1500)").wait_for()
    page.get_by_role("button", name="let go").click()
    page.wait_for_selector(".beside-kept", state="hidden")
    kept.wait_for(state="detached")


def test_a_hostile_name_is_shown_as_text(tab: Any) -> None:
    name = "<img src=x onerror=window.hacked=1>{{ 7*7 }}"
    tab.page.get_by_role("button", name="Beside").click()
    tab.page.get_by_text("keep this design").click()
    tab.field("material.name").fill(name)
    cell = tab.page.locator(f'{SHEET} tr[data-row="material.name"]').last
    tab.page.wait_for_function(
        "([row, name]) => document.querySelector(row)?.textContent.includes(name)",
        arg=[f'{SHEET} tr[data-row="material.name"]', name],
    )
    assert cell.locator("img").count() == 0
    assert tab.page.evaluate("window.hacked") is None


def test_words_keep_their_room_beside_six_gears(tab: Any) -> None:
    tab.page.goto(f"{tab.address}?lang=en&design={pack('planetary-alm', starter_text('planetary-alm')[1])}")
    words = tab.page.locator(f'{SHEET} tr[data-row="gear.normal_module"] th').first
    words.wait_for()
    assert words.bounding_box()["width"] >= LEAST_WIDTH
    right = tab.page.locator(".right")
    assert right.evaluate("each => each.scrollWidth <= each.clientWidth")
