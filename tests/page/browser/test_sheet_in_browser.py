"""Data sheet, bodies and section in a browser: what changed, notices, turning, cutting and measuring."""

from pathlib import Path
from typing import Any

import pytest

from gearcad.designs.reader import starter_text
from gearcad.page.folder import pack

LEAST_WIDTH = 100
"""Pixels in which the words of a quantity can be read."""

SHEET = '.gear-sheet[aria-label="data sheet"]'


def value(tab: Any, key: str) -> Any:
    """The cells of a row outside the first figures."""
    return tab.page.locator(f'{SHEET} tr[data-row="{key}"]').last.locator(".value")


@pytest.mark.long
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


@pytest.mark.long
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


@pytest.mark.long
def test_words_keep_their_room_beside_six_gears(tab: Any) -> None:
    tab.page.goto(f"{tab.address}?lang=en&design={pack('planetary-alm', starter_text('planetary-alm')[1])}")
    words = tab.page.locator(f'{SHEET} tr[data-row="gear.normal_module"] th').first
    words.wait_for()
    assert words.bounding_box()["width"] >= LEAST_WIDTH
    right = tab.page.locator(".right")
    assert right.evaluate("each => each.scrollWidth <= each.clientWidth")


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


@pytest.mark.long
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
    lent.page.locator(".scene .measured", has_text="±").wait_for()
    lent.page.get_by_role("button", name="measure").click()


@pytest.mark.long
def test_without_webgl_it_says_so_and_all_else_works(browser: Any, address: str) -> None:
    context = browser.new_context()
    page = context.new_page()
    page.add_init_script(_NO_WEBGL)
    page.goto(address)
    page.wait_for_selector(".gear-section[data-teeth='21 43']")
    assert "no WebGL" in page.inner_text(".scene .nothing")
    context.close()


@pytest.mark.long
def test_a_rack_is_drawn_at_once_however_near_one_looks(tab: Any) -> None:
    """Dashes far beyond the view once took half a minute."""
    tab.page.goto(f"{tab.address}?lang=en&design={pack('rack', starter_text('rack')[1])}")
    tab.page.wait_for_selector(".scene[data-shown]")
    canvas = tab.page.locator(".gear-section canvas")
    canvas.focus()
    for _ in range(NEARER):
        tab.page.keyboard.press("+")
    tab.page.screenshot(timeout=QUICK)


def test_values_of_the_mesh_stand_across_those_of_gears_under_their_gear(tab: Any) -> None:
    tab.page.wait_for_selector('[data-row="safety.scuffing.integral"], [data-row="strength.safety.scuffing.integral"]')
    places = """() => {
      const middle = (each) => { const box = each.getBoundingClientRect(); return (box.left + box.right) / 2; };
      const row = (key) => document.querySelector(`[data-row="strength.safety.${key}"]`);
      const gears = [...row("flank").querySelectorAll(".value")].map(middle);
      const mesh = row("scuffing.integral").querySelectorAll(".value");
      return [gears, [...mesh].map(middle), mesh[0].colSpan, row("flank").querySelector(".symbol").innerHTML];
    }"""
    gears, mesh, span, symbol = tab.page.evaluate(places)
    assert (len(gears), len(mesh), span) == (2, 1, 2)
    assert gears[0] < mesh[0] < gears[1]
    assert "<sub>H</sub>" in symbol
    title = tab.page.get_attribute('[data-row="pair.total_contact_ratio"]', "title")
    assert "ISO 21771, clause 5.4" in title


@pytest.mark.long
def test_designs_are_compared_swapped_and_let_go(tab: Any) -> None:
    for width in ("28", "30"):
        tab.page.get_by_role("button", name="Beside").click()
        tab.page.get_by_text("keep this design").click()
        tab.page.wait_for_selector(".beside-kept", state="visible")
        tab.field("pinion.face_width").fill(width)
        tab.page.wait_for_selector(f'tr[data-row="gear.face_width"] .value:has-text("{width}.0000")', state="attached")
    tab.page.get_by_role("tab", name="Compare").click()
    row = tab.page.locator('[data-compared="gear.face_width pinion"]')
    tab.page.wait_for_function(
        "document.querySelector('[data-compared=\"gear.face_width pinion\"]')?.innerText.includes('30.0000')"
    )
    assert row.locator("td").all_inner_texts() == ["30.0000", "25.0000", "28.0000"]
    assert tab.page.locator('[data-compared="mass pinion"] td').nth(1).get_attribute("class") == "best"
    assert tab.page.locator('[data-compared="pair.centre_distance"]').count() == 0
    tab.page.locator(".compare thead th").nth(1).get_by_role("button").first.click()
    tab.page.wait_for_function("document.querySelector('[data-key=\"pinion.face_width\"] input').value === ''")
    tab.page.wait_for_function(
        "document.querySelector('[data-compared=\"gear.face_width pinion\"] td')?.innerText === '25.0000'"
    )
    tab.page.wait_for_function(
        "document.querySelectorAll('[data-compared=\"gear.face_width pinion\"] td')[1]?.innerText === '30.0000'"
    )
    assert row.locator("td").all_inner_texts() == ["25.0000", "30.0000", "28.0000"]
    tab.page.locator(".compare thead th").nth(2).get_by_role("button").last.click()
    tab.page.wait_for_function("document.querySelectorAll('.compare thead th[scope=col]').length === 2")


@pytest.mark.long
def test_the_drawing_is_seen_magnified_and_taken_as_pdf(tab: Any) -> None:
    tab.page.get_by_role("tab", name="Drawing").click()
    picture = tab.page.locator(".gear-drawing .paper img")
    picture.wait_for(state="visible")
    tab.page.wait_for_function("document.querySelector('.gear-drawing .paper img').naturalWidth > 0")
    assert tab.page.locator(".sheet-tools button[aria-pressed]").all_inner_texts() == ["Assembly", "pinion", "wheel"]
    first, width = picture.get_attribute("src"), picture.bounding_box()["width"]
    tab.page.locator(".sheet-tools button").nth(1).click()
    tab.page.wait_for_function("former => document.querySelector('.gear-drawing .paper img').src !== former", arg=first)
    tab.page.locator(".gear-drawing .paper").focus()
    tab.page.keyboard.press("+")
    tab.page.wait_for_function(
        "former => document.querySelector('.gear-drawing .paper img').clientWidth > 1.2 * former", arg=width
    )
    second = picture.get_attribute("src")
    tab.field("pinion.teeth").fill("22")
    tab.page.wait_for_function("former => document.querySelector('.gear-drawing .paper img').src !== former", arg=second)
    tab.page.wait_for_selector('.gear-drawing[aria-busy="false"]')
    tab.field("pinion.teeth").fill("2")
    tab.page.wait_for_selector('.gear-drawing[data-stale="of the last good design"]')
    tab.field("pinion.teeth").fill("22")
    tab.page.wait_for_selector(".gear-drawing:not([data-stale])")
    with tab.page.expect_download() as taken:
        tab.page.get_by_role("button", name="PDF").click()
    assert taken.value.suggested_filename.endswith(".pdf")
    assert Path(taken.value.path()).read_bytes()[:5] == b"%PDF-"


@pytest.mark.long
def test_a_print_is_a_report_of_all_values(tab: Any) -> None:
    tab.page.wait_for_selector(".gear-sheet tr[data-row]", state="attached")
    folded = tab.page.locator(".gear-sheet details:not([open])").count()
    assert folded > 5
    tab.page.emulate_media(media="print")
    tab.page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    tab.page.wait_for_function("!document.querySelector('.gear-sheet details:not([open])')")
    for gone in (".left", ".middle", ".right .tabs", ".gear-sheet .search", ".files"):
        assert not tab.page.locator(gone).first.is_visible(), gone
    assert tab.page.locator(".bar .name").is_visible()
    assert "gearcad ·" in tab.page.inner_text(".bar .print-only")
    assert tab.page.locator('tr[data-row="pair.path_of_contact.A"]').is_visible()
    colours = "element => [getComputedStyle(element).color, getComputedStyle(document.body).backgroundColor]"
    tab.page.evaluate("Quasar.Dark.set(true)")
    assert tab.page.locator('.gear-sheet th[scope="row"]').first.evaluate(colours) == ["rgb(0, 0, 0)", "rgb(255, 255, 255)"]
    tab.page.evaluate("Quasar.Dark.set(false)")
    tab.page.evaluate("window.dispatchEvent(new Event('afterprint'))")
    tab.page.emulate_media(media="screen")
    tab.page.wait_for_function(
        "folded => document.querySelectorAll('.gear-sheet details:not([open])').length === folded", arg=folded
    )
