"""Tasks in a browser: from an empty page to a pair that holds and its drawing; measured gears, maps, and unsaved work."""

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from support.page_server import Tab

from gearcad.page.folder import pack

EMPTY = pack("new", "")
TASK = {"torque": "302", "speed": "1500", "ratio": "1.5", "life": "20000"}
NARROW = {"teeth": "20:24", "module": "2.5,3", "helix_angle": "0", "shift": "0.2:0.6:0.2", "shift_sum": "0.5"}
"""Ranges that make a search quick."""

ENOUGH = 120_000
MOST_CLICKS = 12

CUT = """() => [...document.querySelectorAll('.tasks :is(td, th, button, label, input, .unit, .task-line)')].filter(
  (each) => each.checkVisibility() && each.clientWidth > 0 && each.scrollWidth > each.clientWidth + 1
).map((each) => each.outerHTML)"""
SMALL = """() => [...document.querySelectorAll('.tasks *')].filter((each) => {
  if (!each.checkVisibility() || each.closest('svg')) return false;
  const words = [...each.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim());
  const typed = each.matches('input') && each.closest('.q-field');
  const control = typed || each.matches('button, [role=tab], [role=button], select');
  const height = (each.closest('.q-field__control') ?? each).offsetHeight;
  return (words && !each.matches('.q-icon') && parseFloat(getComputedStyle(each).fontSize) < 13) || (control && height < 28);
}).map((each) => each.outerHTML.slice(0, 200))"""


@pytest.fixture
def begun(window: Any, address: str) -> Iterator[Tab]:
    """A tab with an empty page."""
    tab = Tab(window.new_page(), address)
    tab.page.goto(f"{tab.address}?design={EMPTY}")
    tab.page.wait_for_selector(".panels.empty .task-go:visible")
    yield tab
    tab.page.close()
    assert not tab.errors
    assert not tab.foreign


def _fill(page: Any, kind: str, typed: dict[str, str]) -> None:
    for key, text in typed.items():
        page.fill(f"#task-{kind}-{key}", text)


def _choose(page: Any, kind: str, key: str, text: str) -> None:
    """Choose by typing, as the keyboard alone does."""
    page.focus(f"#task-{kind}-{key}")
    page.keyboard.type(text)
    page.wait_for_selector(f".q-menu .q-item:has-text('{text}')")
    page.keyboard.press("Enter")
    page.wait_for_function(
        "([id, text]) => document.getElementById(id).value.startsWith(text)", arg=[f"task-{kind}-{key}", text]
    )


def _begin_quick(page: Any) -> None:
    """Fill in a task with narrow ranges."""
    _fill(page, "size", TASK)
    _choose(page, "size", "material", "Eh MQ")
    page.click(".task-more .q-item >> nth=0")
    page.wait_for_selector("#task-size-teeth:visible")
    _fill(page, "size", NARROW)


def _wait_for_pairs(page: Any) -> None:
    page.wait_for_selector(".found-table .take", timeout=ENOUGH)
    page.wait_for_function("() => !document.querySelector('.task-progress').checkVisibility()", timeout=ENOUGH)


def test_from_an_empty_page_to_a_pair_that_holds_and_its_drawing(begun: Tab) -> None:
    page, began, clicks = begun.page, time.monotonic(), 0

    def click(what: str) -> None:
        nonlocal clicks
        clicks += 1
        page.click(what)

    click("#task-size-torque")
    _fill(page, "size", TASK)
    _choose(page, "size", "material", "Eh MQ")
    click(".task-go:visible")
    _wait_for_pairs(page)
    click(".found-table .take >> nth=0")
    page.wait_for_selector(".panels:not(.empty) .scene[data-shown]", timeout=ENOUGH)
    click(".right >> text=Data")
    page.wait_for_selector(".gear-sheet h2.passed", timeout=ENOUGH)
    assert page.inner_text(".gear-sheet h2.passed") == "strength passed"
    assert page.input_value('[data-key="load.torque"] input') == "302"
    assert page.input_value('[data-key="load.speed"] input') == "1500"
    click(".files > summary")
    page.wait_for_selector(".files-menu .makes button:has-text('PDF')")
    with page.expect_download(timeout=ENOUGH) as taken:
        click(".files-menu .makes button:has-text('drawing (PDF)')")
    assert taken.value.suggested_filename.endswith((".pdf", ".zip"))
    assert clicks <= MOST_CLICKS
    print(f"{clicks} clicks, {len(TASK) + 1} values, {time.monotonic() - began:.0f} s")


@pytest.mark.long
def test_the_keyboard_alone_takes_a_pair_and_nothing_is_lost(begun: Tab) -> None:
    """One candidate after the other is taken at once; work on one of them is asked about; undo brings the empty page back."""
    page = begun.page
    _begin_quick(page)
    page.focus("#task-size-torque")
    page.keyboard.press("Enter")
    _wait_for_pairs(page)
    for wrong in ("9999", "-1", "null", "'<img>'", "1e308", "{}"):
        page.evaluate(f"() => getElement(document.querySelector('.found-table').id.slice(1)).$emit('take', {wrong})")
    for place in (1, 0):
        name = page.inner_text(f".found-table .take >> nth={place}")
        page.focus(f".found-table .take >> nth={place}")
        page.keyboard.press("Enter")
        page.wait_for_function("name => document.querySelector('.bar .name').textContent === name", arg=name)
    page.wait_for_selector(".files .unsaved")
    page.wait_for_selector(".scene[data-shown]", timeout=ENOUGH)
    begun.give("pinion.profile_shift", "0.31")
    shift = '[data-key="pinion.profile_shift"] input >> nth=0'
    page.click(".found-table .take >> nth=1")
    page.click(".question >> text=keep it")
    page.wait_for_selector(".question", state="detached")
    assert page.input_value(shift) == "0.31"
    page.click(".files > summary")
    page.click(".files-menu >> text=new design")
    page.click(".question >> text=keep it")
    page.wait_for_selector(".question", state="detached")
    assert page.input_value(shift) == "0.31"
    page.click(".found-table .take >> nth=1")
    page.click(".question >> text=replace it")
    page.wait_for_function("() => document.querySelector('[data-key=\"pinion.profile_shift\"] input').value !== '0.31'")
    for _ in range(4):
        page.click(".bar button[aria-label=undo]")
    page.wait_for_selector(".panels.empty")
    assert page.locator(".found-table .take:visible").count() > 1


def test_what_is_missing_or_wrong_stands_at_its_field(begun: Tab) -> None:
    page = begun.page
    page.fill("#task-size-ratio", "55")
    page.click(".task-go:visible")
    page.wait_for_selector(".task-field:has(#task-size-torque) >> text=must be given")
    assert page.locator(".tasks .q-field__messages:has-text('must be given')").count() == 3
    _fill(page, "size", TASK | {"ratio": "55"})
    _choose(page, "size", "material", "Eh MQ")
    page.click(".task-go:visible")
    page.wait_for_selector(".task-field:has(#task-size-ratio) >> text=at most 20")
    assert not page.locator(".found-table").count()


@pytest.mark.long
def test_a_measured_gear_becomes_the_design(begun: Tab) -> None:
    page = begun.page
    page.click(".task-tabs >> text=from a measured gear")
    _fill(page, "identify", {"teeth": "24", "tip_diameter": "52.02", "root_diameter": "43.01", "span": "3:15.40; 4:21.30"})
    page.fill("#task-identify-helix_angle", "0")
    page.keyboard.press("Enter")
    page.click(".found-table .take >> nth=0", timeout=ENOUGH)
    page.wait_for_selector(".panels:not(.empty) .scene[data-shown]", timeout=ENOUGH)
    assert page.input_value('[data-key="gear.normal_module"] input >> nth=0') == "2"


@pytest.mark.long
def test_a_starter_and_a_new_design(begun: Tab) -> None:
    page = begun.page
    page.click(".task-tabs >> text=from a starter")
    page.click(".task-starters button:has-text('reducer-21-43')")
    page.wait_for_selector(".panels:not(.empty) .scene[data-shown]", timeout=ENOUGH)
    page.click(".files > summary")
    page.click(".files-menu >> text=new design")
    page.wait_for_selector(".panels.empty")


@pytest.mark.long
def test_a_chart_is_fetched_when_it_is_drawn_and_a_cell_of_a_map_is_taken(tab: Tab, folder: Path) -> None:
    page, fetched = tab.page, list[str]()
    page.on("request", lambda request: fetched.append(request.url) if "echart" in request.url else None)
    assert not page.evaluate("performance.getEntriesByType('resource').some((each) => each.name.includes('echart'))")
    page.click(".right >> text=Tasks")
    page.click(".task-tabs >> text=map")
    page.wait_for_function("() => document.getElementById('task-study-across-first')?.value === '0.14'")
    _fill(page, "study", {"across-count": "3", "up-count": "3"})
    page.click(".task-go:visible")
    page.wait_for_selector(".task-chart canvas:visible", timeout=ENOUGH)
    assert fetched
    page.wait_for_function("() => ![...document.querySelectorAll('.task-progress')].some((each) => each.checkVisibility())")
    chart = page.locator(".task-chart:visible").bounding_box()
    page.mouse.click(chart["x"] + 90, chart["y"] + 60)
    page.wait_for_function("() => document.querySelector('[data-key=\"pinion.profile_shift\"] input').value === '0.14'")
    assert page.input_value('[data-key="pair.face_width"] input >> nth=0') == "33"
    page.click(".bar button[aria-label=undo]")
    page.wait_for_function("() => document.querySelector('[data-key=\"pinion.profile_shift\"] input').value === '0.2'")
    assert page.input_value('[data-key="pair.face_width"] input >> nth=0') == "25"
    page.focus(".task-chart:visible")
    for key in ("ArrowLeft", "ArrowRight", "ArrowUp"):  # the first only goes to the cell of the design, in the middle
        page.keyboard.press(key)
    page.wait_for_selector(".task-hint:has-text('= 0.26 ·'):has-text('= 33 ·')")
    page.keyboard.press("Enter")
    page.wait_for_function("() => document.querySelector('[data-key=\"pinion.profile_shift\"] input').value === '0.26'")
    assert page.input_value('[data-key="pair.face_width"] input >> nth=0') == "33"


@pytest.mark.long
@pytest.mark.parametrize("language", [pytest.param("en", marks=pytest.mark.long), "de"])
def test_no_number_is_cut_and_nothing_is_small(begun: Tab, language: str) -> None:
    page = begun.page
    page.goto(f"{begun.address}?design={EMPTY}&lang={language}")
    page.wait_for_selector(".panels.empty .task-go:visible")
    for size in ((1280, 800), (1440, 900), (1920, 1080), (390, 844)):
        page.set_viewport_size({"width": size[0], "height": size[1]})
        for tab in range(3):
            page.locator(".task-tabs [role=tab]").nth(tab).click()
            assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), (size, tab)
            assert page.evaluate(SMALL) == [], (size, tab)
            assert page.evaluate(CUT) == [], (size, tab)
    if language == "en":
        return
    page.locator(".task-tabs [role=tab]").nth(0).click()
    _fill(page, "size", TASK | {"ratio": "1,5"})
    _choose(page, "size", "material", "Eh MQ")
    page.click(".task-more .q-item >> nth=0")
    _fill(page, "size", {key: text.replace(",", "; ").replace(".", ",") for key, text in NARROW.items()})
    page.click(".task-go:visible")
    _wait_for_pairs(page)
    for size in ((1280, 800), (1440, 900), (1920, 1080), (390, 844)):
        page.set_viewport_size({"width": size[0], "height": size[1]})
        assert page.evaluate(SMALL) == [], size
        assert page.evaluate(CUT) == [], size
    assert "," in page.inner_text(".found-table tbody td >> nth=1")
