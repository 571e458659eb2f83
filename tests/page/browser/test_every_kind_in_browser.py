"""Every starter in a browser: what a fault leaves on the screen, what a link without gears shows, and what each kind offers."""

import re
from typing import Any

import pytest
from support.page_server import Tab
from support.specs import starter_specs

from gearcad.page.folder import pack

pytestmark = pytest.mark.long

STARTERS = {path.stem: path.read_text(encoding="utf-8") for path in starter_specs()}

TEXTS = [name for name, text in STARTERS.items() if re.search(r"(?m)^\[(train|\[shaft)", text)]
"""Starters whose gears are edited as text."""

NOT_DRAWN = ("train-1-stage", "train-2-stage")
"""Starters without teeth: they have no pictures."""

FAULTS = {
    "out of range": lambda text: re.sub(r"(?m)^((?:[\w.]*teeth|inertia|length)) *= *[-\d.]+", r"\1 = -2e9", text, count=1),
    "no number": lambda text: re.sub(r"(?m)^((?:[\w.]*teeth|inertia|length)) *= *[-\d.]+", r'\1 = "many"', text, count=1),
    "unknown key": lambda text: re.sub(r"(?m)^name = .*$", r"\g<0>\nnonsense = 3", text, count=1),
    "unknown table": lambda text: text + "\n[nonsense]\nteeth = 3\n",
    "broken text": lambda text: text + "\nteeth 21\n",
    "key twice": lambda text: re.sub(r"(?m)^name = .*$", r"\g<0>\n\g<0>", text, count=1),
}
"""Changes of any starter that make a fault."""

_PANES = """() => [...document.querySelectorAll(".scene, .gear-section, .gear-roll, .gear-sheet, .gear-shares")]
  .filter((pane) => pane.checkVisibility())
  .map((pane) => [pane.className.split(" ")[0], pane.dataset.stale ?? "", Number(getComputedStyle(pane).opacity)])"""

_RECORDED = """() => {
  const make = URL.createObjectURL.bind(URL);
  window.pictures = [];
  URL.createObjectURL = (blob) => (blob.text().then((text) => window.pictures.push(text)), make(blob));
}"""
"""Keeps the texts of pictures that are made from now on."""

_VERDICTS = ".gear-sheet h2:is(.passed, .failed)"

_COUNT_IN_VIEW = """() => {
  const [count, pane] = [".inputs .faults", ".left .pane"].map((each) => document.querySelector(each)?.getBoundingClientRect());
  return !!count && count.height > 0 && count.top >= pane.top - 1 && count.bottom <= pane.bottom + 1;
}"""


def _open(tab: Tab, name: str, text: str) -> None:
    tab.page.goto("about:blank")
    tab.page.goto(f"{tab.address}?lang=en&design={pack(name, text)}")
    tab.page.wait_for_selector(".gear-sheet tr, .inputs .faults", state="attached")


def _settle(tab: Tab) -> None:
    """Wait until nothing in the page has changed for a while."""
    tab.page.evaluate("""() => new Promise((done) => {
      let timer = setTimeout(done, 500);
      new MutationObserver(() => { clearTimeout(timer); timer = setTimeout(done, 500); })
        .observe(document.body, { subtree: true, childList: true, attributes: true, characterData: true });
    })""")


def _upload(tab: Tab, folder: Any, name: str, text: str) -> None:
    (spec := folder / f"{name}.toml").write_text(text, encoding="utf-8")
    tab.page.locator('.files input[type="file"]').first.set_input_files(spec)


@pytest.mark.parametrize("name", STARTERS)
def test_a_fault_in_the_text_dims_all_that_is_shown(tab: Tab, name: str) -> None:
    """As it is typed in the text of the spec: the last good design is dimmed, and no verdict is a verdict."""
    _open(tab, name, STARTERS[name])
    _settle(tab)
    tab.page.locator(".left .q-tab").nth(1).click()
    tab.page.wait_for_selector(".cm-line")
    tab.page.locator(".cm-content").click()
    for what, faulty in FAULTS.items():
        assert faulty(STARTERS[name]) != STARTERS[name], what
        tab.page.keyboard.press("Control+a")
        tab.page.keyboard.insert_text(faulty(STARTERS[name]))
        tab.page.wait_for_function("document.querySelector('.spec-fault').textContent !== ''")
        panes = tab.page.evaluate(_PANES)
        assert len(panes) >= 2
        assert [pane for pane in panes if pane[1] != "of the last good design" or pane[2] > 0.7] == [], what
        assert tab.page.locator(_VERDICTS).count() == 0, what
        assert set(tab.page.locator(".band:visible").all_inner_texts()) == {"of the last good design"}, what
        tab.page.keyboard.press("Control+z")
        tab.page.wait_for_function("document.querySelector('.spec-fault').textContent === ''")
        assert tab.page.locator("[data-stale]").count() == tab.page.locator(".band:visible").count() == 0, what


@pytest.mark.parametrize("name", [name for name in STARTERS if name not in TEXTS])
def test_a_fault_in_a_field_dims_all_and_is_counted_in_view(tab: Tab, name: str) -> None:
    _open(tab, name, STARTERS[name])
    _settle(tab)
    keys = tab.page.eval_on_selector_all(
        ".inputs .ranked [data-key]", "all => all.filter((each) => each.querySelector('input')).map((each) => each.dataset.key)"
    )
    numbers = [key for key in keys if not key.startswith("material.")]  # a material may have any name
    assert numbers
    for key in numbers:
        field = tab.field(key)
        was = field.input_value()
        field.fill("1.2.3")
        tab.page.wait_for_selector(".inputs .field .fault")  # of a load without torque the fault is that of the torque
        panes = tab.page.evaluate(_PANES)
        assert [pane for pane in panes if pane[1] != "of the last good design" or pane[2] > 0.7] == [], key
        assert tab.page.locator(_VERDICTS).count() == 0, key
        assert tab.page.evaluate(_COUNT_IN_VIEW), key
        field.fill(was)
        tab.page.wait_for_selector(".inputs .faults", state="detached")
        assert tab.page.locator("[data-stale]").count() == 0, key


@pytest.mark.parametrize("name", STARTERS)
def test_what_makes_no_gears_shows_none(tab: Tab, name: str, tmp_path: Any) -> None:
    """A link first, then files that are opened in a page that shows the gears of another design."""
    for number, (what, faulty) in enumerate(FAULTS.items()):
        text = faulty(STARTERS[name])
        if number:
            _open(tab, "reducer-21-43", STARTERS["reducer-21-43"])
            tab.page.wait_for_selector(".gear-sheet h2.passed")
            _upload(tab, tmp_path, f"{name}-{number}", text)
            tab.page.wait_for_function(
                "name => document.querySelector('.bar .name').textContent === name", arg=f"{name}-{number}"
            )
        else:
            _open(tab, name, text)
        tab.page.wait_for_selector(".inputs .faults, .spec-fault:not(:empty)")
        tab.page.wait_for_selector(".band:visible")
        _settle(tab)
        assert set(tab.page.locator(".band:visible").all_inner_texts()) == {"these inputs make no gears"}, what
        assert tab.page.locator(".gear-sheet h2").count() == tab.page.locator(".gear-sheet table").count() == 0, what
        assert tab.page.get_attribute(".gear-section", "data-teeth") == "", what
        assert not any(tab.page.eval_on_selector_all(".inputs .field input", "all => all.map(each => each.placeholder)")), what


@pytest.mark.parametrize("name", STARTERS)
def test_tabs_are_those_of_the_kind(tab: Tab, name: str) -> None:
    _open(tab, name, STARTERS[name])
    _settle(tab)
    titles = set(tab.page.locator(".q-tab:visible").all_inner_texts())
    is_train, is_set, is_spline = name in TEXTS, "planetary" in name, name == "spline"
    is_pair = not (is_train or is_set or is_spline or name in ("rack", "spur", "wire-cut"))
    assert ("Flanks" in titles) is is_pair
    assert ("Limits" in titles) is not (is_train or is_set or is_spline)
    assert ("Drawing" in titles) is not is_train
    assert {"Inputs", "Text", "Data", "Tasks", "Runs", "Compare", "Table"} <= titles
    if name not in NOT_DRAWN:
        assert tab.page.get_attribute(".gear-section", "data-teeth")
        assert "0" != tab.page.get_attribute(".scene", "data-shown")


def test_a_hidden_tab_leads_back_to_the_first(tab: Tab, tmp_path: Any) -> None:
    tab.page.get_by_role("tab", name="Limits").click()
    tab.page.get_by_role("tab", name="Drawing").click()
    _upload(tab, tmp_path, "train-pairs", STARTERS["train-pairs"])
    tab.page.wait_for_function("document.querySelector('.bar .name').textContent === 'train-pairs'")
    chosen = tab.page.locator(".q-tab--active:visible")
    assert set(chosen.all_inner_texts()) == {"Inputs", "Data"}


def test_a_drawing_has_a_language_of_its_own(tab: Tab) -> None:
    """The German page says in which language the sheets are, and writes another one into the spec."""
    tab.page.goto(f"{tab.address}?lang=de")
    tab.page.wait_for_selector(".scene[data-shown]")
    tab.page.evaluate(_RECORDED)
    tab.page.get_by_role("tab", name="Zeichnung").click()
    tab.page.wait_for_selector(".gear-drawing img")
    tab.page.wait_for_function("window.pictures.some((text) => text.includes('Centre distance'))", polling=500)
    languages = tab.page.locator(".gear-drawing .of-sheets")
    assert languages.inner_text().startswith("Sprache der Blätter")
    chosen = languages.locator("select")
    assert (chosen.input_value(), chosen.locator("option").all_inner_texts()) == ("en", ["Englisch", "Deutsch", "Schwedisch"])
    chosen.select_option("de")
    tab.page.wait_for_function("window.pictures.some((text) => text.includes('Achsabstand'))", polling=500)
    tab.page.locator(".left .q-tab").nth(1).click()
    tab.page.wait_for_selector(".cm-line:has-text('language = \"de\"')")


def test_gears_of_a_train_of_pairs_turn_and_are_measured(tab: Tab) -> None:
    _open(tab, "train-pairs", STARTERS["train-pairs"])
    tab.page.wait_for_function("document.querySelector('.gear-section').dataset.teeth === '18 54 18 48'")
    tab.page.wait_for_selector(".scene[data-shown]:not([data-shown='0'])")
    tab.page.locator(".section-tools select").first.select_option("thickness")
    tab.page.wait_for_selector(".section-tools select >> nth=1")
    gears = tab.page.locator(".section-tools select").nth(1).locator("option").all_inner_texts()
    assert gears == ["pinion 1", "wheel 1", "pinion 2", "wheel 2"]


def test_each_module_has_its_own_diametral_pitch(tab: Tab) -> None:
    """P_nd = 25.4 mm/m_n: of 2.8 and 2.6 mm."""
    tab.page.goto("about:blank")
    tab.page.goto(f"{tab.address}?lang=en&units=in&design={pack('planetary-alm', STARTERS['planetary-alm'])}")
    tab.page.wait_for_selector(".inputs .used.pitch >> nth=3")
    told = [each.replace("\n", "").partition("= ")[2] for each in tab.page.locator(".inputs .used.pitch").all_inner_texts()]
    assert told == ["9.0714", "9.0714", "9.7692", "9.7692"]
    tab.field("planetary.centre_distance").fill("0.1")
    fault = tab.page.locator(".inputs .field .fault")
    fault.wait_for()
    assert fault.inner_text().endswith("must be below -2.486118 in, where the base circles touch")
