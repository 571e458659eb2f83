"""Layout in a browser: no value is cut off at any width, the first fault is in view, text and controls are large enough."""

from typing import Any

import pytest
from support.page_server import DESK
from support.specs import starter_specs

from gearcad.page.folder import pack

SIZES = ((1280, 800), (1440, 900), (1920, 1080), (390, 844))
"""Widths and heights (px) of windows."""

SLACK = 1
"""Pixels that a browser rounds to."""

SMALLEST_TEXT, LOWEST_CONTROL = 13, 28
"""Pixels."""

_ALL_LAID_OUT = """() => {
  const sheet = new CSSStyleSheet();
  sheet.replaceSync("* { content-visibility: visible !important }");
  document.adoptedStyleSheets.push(sheet);
  for (const details of document.querySelectorAll(".gear-sheet details, .inputs details")) details.open = true;
}"""

_CUT = """slack => {
  const cut = [];
  const inputs = ".inputs :is(input, select, .unit, label)";
  const values = `.gear-sheet :is(td, th), ${inputs}, .gear-shares .share > *, output, .run-table td`;
  for (const value of document.querySelectorAll(values)) {
    const said = (value.value || value.placeholder || value.textContent || "").trim(), box = value.getBoundingClientRect();
    if (!said || !box.width || !value.checkVisibility({ visibilityProperty: true })) continue;
    const told = `${value.closest("[data-row], [data-key]")?.outerHTML.slice(0, 60)}: ${said.slice(0, 30)}`;
    if (value.scrollWidth > value.clientWidth + slack && getComputedStyle(value).display !== "inline") cut.push(told);
    for (let around = value.parentElement; around; around = around.parentElement) {
      if (getComputedStyle(around).overflowX === "visible") continue;
      const left = around.getBoundingClientRect().left + around.clientLeft;
      if (box.left < left - slack || box.right > left + around.clientWidth + slack) cut.push(`outside: ${told}`);
    }
    if (box.right > innerWidth + slack) cut.push(`beyond the window: ${told}`);
  }
  return cut;
}"""

_SMALL = """([text, control]) => {
  const small = [];
  const seen = (each) => each.checkVisibility({ visibilityProperty: true }) && each.getBoundingClientRect().width > 1;
  for (const each of document.querySelectorAll("body *")) {
    const own = [...each.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim());
    if (own && seen(each) && !each.closest("svg, script, style") && parseFloat(getComputedStyle(each).fontSize) < text)
      small.push(`text: ${each.outerHTML.slice(0, 80)}`);
  }
  for (const each of document.querySelectorAll("button, select, summary, input:not([type=file]), [role=tab]"))
    if (seen(each) && each.offsetHeight < control) small.push(`control: ${each.outerHTML.slice(0, 80)}`);
  return small;
}"""

_IN_VIEW = """key => {
  const fault = document.querySelector(`[data-key="${key}"] .fault`)?.getBoundingClientRect();
  const [find, hint] = [".inputs .find", ".inputs .hint"].map((each) => document.querySelector(each).getBoundingClientRect());
  const pane = document.querySelector(".left .pane").getBoundingClientRect();
  const within = fault && fault.top >= find.bottom - 1 && fault.bottom <= hint.top + 1;
  return !!within && find.top >= pane.top - 1 && hint.bottom <= pane.bottom + 1;
}"""

_FRAMES = """async () => { for (let n = 0; n < 4; n += 1) await new Promise((seen) => requestAnimationFrame(seen)); }"""
"""Frames in which a page of another size is laid out: observers of sizes are told in one, what they change is in the next."""

STARTERS = [each.stem for each in starter_specs()]

WRONG = {
    **{
        f"pinion.{key}": "-9999"
        for key in ("teeth", "normal_module", "face_width", "helix_angle", "profile_shift", "tip_alteration")
    },
    **{f"wheel.{key}": "-9999" for key in ("normal_module", "face_width", "profile_shift", "tooth_thinning", "accuracy_grade")},
    **{f"pair.{key}": "-9999" for key in ("centre_distance", "face_width", "flank_roughness")},
    "load.application_factor": "-9999",
    **{f"rating.{key}": "-9999" for key in ("dynamic_factor", "face_load_factor", "shaft_diameter", "bearing_span")},
    "rating.scuffing_stage": "-9999",
}
"""What no design has, at 20 fields of a pair."""

EACH = 4
"""Of these fields the default tests take each fourth."""


def _open(tab: Any, name: str) -> None:
    text = next(each for each in starter_specs() if each.stem == name).read_text(encoding="utf-8")
    tab.page.set_viewport_size(DESK)
    tab.page.goto(f"{tab.address}?lang=en&design={pack(name, text)}")
    tab.page.wait_for_selector(".gear-sheet tr[data-row]", state="attached")
    tab.page.evaluate(_ALL_LAID_OUT)


def _keep_and_change(tab: Any) -> None:
    tab.page.get_by_role("button", name="Beside").click()
    tab.page.get_by_text("keep this design").click()
    tab.page.wait_for_selector(".beside-kept")
    for name, factor in (("normal_module", 1.03), ("face_width", 1.1)):
        for table in ("pair", "gear", "planet", "pinion"):
            field = tab.page.locator(f'[data-key="{table}.{name}"] input')
            if field.count() and (value := field.input_value()):
                field.fill(str(round(float(value) * factor, 4)))
                tab.page.wait_for_selector(".gear-sheet tr.kept, .inputs .fault", state="attached")
                if tab.page.locator(".inputs .fault").count() == 0:
                    return
                field.fill(value)
                tab.page.wait_for_selector(".inputs .fault", state="detached")
                break


def _cut(tab: Any) -> dict[int, list[str]]:
    cut = {}
    for width, height in SIZES:
        tab.page.set_viewport_size({"width": width, "height": height})
        tab.page.evaluate(_FRAMES)
        cut[width] = tab.page.evaluate(_CUT, SLACK)
    tab.page.set_viewport_size(DESK)
    return cut


@pytest.mark.parametrize(
    "name",
    [pytest.param(each, marks=[] if each == "reducer-21-43" else pytest.mark.long) for each in STARTERS],
)
def test_no_value_is_cut_off_alone_or_beside_a_kept_design(tab: Any, name: str) -> None:
    _open(tab, name)
    assert _cut(tab) == {width: [] for width, _ in SIZES}
    _keep_and_change(tab)
    tab.page.evaluate(_ALL_LAID_OUT)
    assert _cut(tab) == {width: [] for width, _ in SIZES}


def test_text_and_controls_are_large_enough(tab: Any) -> None:
    for width, height in SIZES:
        tab.page.set_viewport_size({"width": width, "height": height})
        assert tab.page.evaluate(_SMALL, [SMALLEST_TEXT, LOWEST_CONTROL]) == [], width
    tab.page.set_viewport_size(DESK)


@pytest.mark.parametrize("step", [EACH, pytest.param(1, marks=pytest.mark.long)])
def test_a_fault_is_in_view_wherever_its_field_is(tab: Any, step: int) -> None:
    tab.page.evaluate("for (const details of document.querySelectorAll('.inputs details')) details.open = true")
    hidden = []
    for key, text in list(WRONG.items())[::step]:
        field = tab.field(key)
        was = field.input_value()
        field.evaluate("field => field.focus({ preventScroll: true })")
        tab.page.keyboard.press("Control+a")
        tab.page.keyboard.insert_text(text)
        tab.page.wait_for_selector(f'[data-key="{key}"] .fault', state="attached")
        tab.page.wait_for_timeout(100)
        if not tab.page.evaluate(_IN_VIEW, key) or tab.page.inner_text(".inputs .faults") != "1 fault":
            hidden.append(key)
        field.fill(was)
        tab.page.wait_for_selector(f'[data-key="{key}"] .fault', state="detached")
    assert hidden == []


def test_faults_are_counted_and_each_stands_at_its_field(tab: Any) -> None:
    for key in ("pinion.teeth", "wheel.profile_shift", "rating.dynamic_factor"):
        tab.field(key).fill("-9999")
        tab.page.wait_for_selector(f'[data-key="{key}"] .fault', state="attached")
    assert tab.page.inner_text(".inputs .faults") == "3 faults"
    assert tab.page.locator(".field .fault").count() == 3


def test_enter_goes_on_from_a_list(tab: Any) -> None:
    tab.field("rating.standard").focus()
    tab.page.keyboard.press("Enter")
    assert tab.page.evaluate("document.activeElement.closest('[data-key]')?.dataset.key") not in ("rating.standard", None)


@pytest.mark.long
def test_numbers_of_the_german_page_have_commas(tab: Any) -> None:
    tab.page.goto(f"{tab.address}?lang=de")
    tab.page.wait_for_selector(".scene[data-shown]")
    tab.page.wait_for_selector(".gear-sheet .value", state="attached")
    with_point = r"""() => {
      const values = [...document.querySelectorAll(".gear-sheet .value, output")].map((value) => value.textContent);
      const inputs = [...document.querySelectorAll(".inputs .field input")].flatMap((each) => [each.value, each.placeholder]);
      return [...values, ...inputs].filter((text) => /^\s*-?\d+[.]\d+\D*$/.test(text));
    }"""
    assert tab.page.evaluate(with_point) == []
    shift = tab.field("pinion.profile_shift")
    assert shift.input_value() == "0,2"
    shift.focus()
    tab.page.keyboard.press("ArrowUp")
    assert shift.input_value() == "0,3"
    tab.page.wait_for_function("document.querySelector('[data-key=\"pinion.profile_shift\"]').classList.contains('changed')")
    tab.page.keyboard.press("Escape")
    assert shift.input_value() == "0,3"


@pytest.mark.long
def test_a_finger_scrolls_a_phone_past_the_pictures(browser: Any, address: str) -> None:
    context = browser.new_context(viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True)
    page = context.new_page()
    page.goto(address)
    page.wait_for_selector(".scene[data-shown]")
    for canvas in (".scene canvas", ".gear-section canvas"):
        assert page.locator(canvas).evaluate("canvas => getComputedStyle(canvas).touchAction") == "pan-y"
    touch = context.new_cdp_session(page)
    box = page.locator(".scene canvas").bounding_box()
    finger = {"x": box["x"] + box["width"] / 2, "y": box["y"] + box["height"] - 20}
    touch.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [finger]})
    for step in range(1, 21):
        moved = finger | {"y": finger["y"] - 10 * step}
        touch.send("Input.dispatchTouchEvent", {"type": "touchMove", "touchPoints": [moved]})
    touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    page.wait_for_function("window.scrollY > 100")
    context.close()
