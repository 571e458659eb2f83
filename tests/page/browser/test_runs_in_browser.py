"""Runs, files and tables in a browser, and the page by keys alone."""

from pathlib import Path
from typing import Any

import pytest

from gearcad.designs.reader import starter_text
from gearcad.page.folder import pack

VOLVO = starter_text("volvo-13-44")
RESULTS = (
    "name,status,gear.teeth,gear.normal_module,gear.face_width,gear.reference_diameter,<img src=x onerror=alert(1)>\n"
    "small,ok,20,2,20,40.0,1\nlarge,ok,30,2,20,60.0,2\n<img src=x onerror=alert(1)>,ok,40,2,20,80.0,3\n"
)


def _open(tab: Any, kind: str, path: Path) -> None:
    """Give a file to the menu: that of a spec, or of a table."""
    tab.page.click(".files > summary")
    tab.page.wait_for_selector(".files-menu .makes button")
    tab.page.set_input_files(f".files-menu input[type=file] >> nth={('spec', 'table').index(kind)}", path)


def _wait_for_name(tab: Any, name: str) -> None:
    tab.page.wait_for_function("name => document.querySelector('.bar .name').textContent === name", arg=name)


def test_a_run_is_followed_its_figures_stay_and_its_report_can_do_nothing(tab: Any) -> None:
    page = tab.page
    page.click(".right >> text=Runs")
    page.click(".run-kinds button:has-text('rating') >> nth=0")
    page.wait_for_selector(".run-list li.done")
    assert page.inner_text(".run-list .line") == "reducer-21-43 at 200 N·m, 1450 rpm: strength passed"
    tab.give("pinion.teeth", "22")
    page.wait_for_selector(".run-list li.done.stale")
    page.click(".run-kinds button:has-text('rating') >> nth=0")
    page.wait_for_selector(".run-list li.done:not(.stale)")
    assert page.inner_text(".run-table thead small") == "pinion.teeth 21 → 22"
    assert page.locator(".run-table tr.differs").count() > 3
    with page.context.expect_page() as opened:
        page.click(".run-list a >> nth=0")
    report = opened.value
    assert report.inner_text("h1").startswith("reducer-21-43")
    assert report.evaluate("self.origin") == "null"


def test_a_check_is_cancelled_at_once(tab: Any) -> None:
    page = tab.page
    page.click(".right >> text=Runs")
    page.click(".run-kinds button:has-text('solid bodies')")
    page.wait_for_function("() => /\\w/.test(document.querySelector('.run-list .step')?.textContent ?? '')", timeout=60_000)
    page.click(".run-list button")
    page.wait_for_selector(".run-list li.cancelled", timeout=5_000)


def test_a_spec_goes_round_with_its_comments_and_the_address_holds_it(tab: Any, folder: Path) -> None:
    page = tab.page
    (folder / "given").mkdir(exist_ok=True)
    (folder / "given" / VOLVO[0]).write_text(VOLVO[1], encoding="utf-8")
    _open(tab, "spec", folder / "given" / VOLVO[0])
    _wait_for_name(tab, "volvo-13-44")
    page.wait_for_selector(".files:not([open])")  # what was opened is seen
    page.click(".files > summary")
    with page.expect_download() as taken:
        page.click("text=download the spec")
    assert taken.value.suggested_filename == "volvo-13-44.toml"
    assert Path(taken.value.path()).read_text(encoding="utf-8") == VOLVO[1]
    page.fill(".files-menu form input", "mine")
    page.click(".files-menu form button")
    page.wait_for_selector("text=mine.toml")
    assert (folder / "mine.toml").read_text(encoding="utf-8") == VOLVO[1]
    page.click(".files-menu form button")
    page.wait_for_selector(".files-menu .fault:has-text('is there')")
    page.reload()
    _wait_for_name(tab, "volvo-13-44")


@pytest.mark.long
def test_files_are_taken_along(tab: Any) -> None:
    page = tab.page
    page.click(".files > summary")
    with page.expect_download() as taken:
        page.click(".makes button:has-text('data')")
    assert taken.value.suggested_filename == "reducer-21-43.json"


@pytest.mark.long
def test_names_that_are_none_are_told(tab: Any) -> None:
    page = tab.page
    page.click(".files > summary")
    page.wait_for_selector(".files-menu .makes button")
    for name in ("<img src=x onerror=alert(1)>", "../../up", "con"):
        page.fill(".files-menu form input", name)
        page.click(".files-menu form button")
        page.wait_for_selector(f".files-menu .fault:has-text('{name}')")
        assert "must be a plain file name" in page.inner_text(".files-menu .fault")


@pytest.mark.long
def test_a_row_of_results_is_opened_and_its_words_are_only_words(tab: Any, tmp_path: Path) -> None:
    page = tab.page
    (tmp_path / "results.csv").write_text(RESULTS, encoding="utf-8")
    _open(tab, "table", tmp_path / "results.csv")
    page.wait_for_selector(".results tbody tr >> nth=2")
    page.fill(".results .axes label:last-child input", "<img src=x onerror=alert(1)>")
    page.keyboard.press("Enter")
    page.wait_for_selector(".results thead th:nth-child(4)")
    chart = page.locator(".chart canvas").bounding_box()
    left, right, top, bottom = 64, 16, 64, 48  # around the axes, in whose middle is the second row
    x, y = chart["x"] + (chart["width"] + left - right) / 2, chart["y"] + (chart["height"] + top - bottom) / 2
    for n in range(100):  # a chart that is drawn meanwhile has not seen the pointer
        page.mouse.move(x + n % 2, y)
        if page.locator(".chart >> text=<img src=x").count():
            break
        page.wait_for_timeout(50)
    page.wait_for_selector(".chart >> text=<img src=x", timeout=1_000)
    page.click(".results tbody tr >> nth=1")
    _wait_for_name(tab, "large")
    page.wait_for_selector('[data-key="gear.teeth"] input')
    page.wait_for_function("""() => document.querySelector('[data-key="gear.teeth"] input').value === '30'""")
    page.click(".results tbody tr >> nth=2")
    page.wait_for_selector(".results .fault:has-text('must be a plain file name')")


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
