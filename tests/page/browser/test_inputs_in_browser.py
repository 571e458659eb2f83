"""Inputs in a browser: keyboard, text, shift diagram, German, a phone; what is typed is seen everywhere."""

import os
import signal
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

SHIFT = "pinion.profile_shift"

PAUSE = 1200
"""ms after which typing is another step."""


def _has(tab: Any, key: str, value: str) -> None:
    """Wait until the field of a key has a value."""
    found = '([key, value]) => document.querySelector(`[data-key="${key}"] :is(input, select)`)?.value === value'
    tab.page.wait_for_function(found, arg=[key, value])


def _focused(tab: Any) -> str:
    return str(tab.page.evaluate("document.activeElement.closest('[data-key]')?.dataset.key ?? ''"))


def test_by_the_keyboard_alone(tab: Any) -> None:
    keys = tab.page.keyboard
    keys.press("/")
    keys.type("pinion shift")
    keys.press("Enter")
    assert _focused(tab) == SHIFT
    assert SHIFT in tab.page.inner_text(".inputs .hint")
    keys.type("0.2")  # what was there is selected
    _has(tab, SHIFT, "0.2")
    for key in ("ArrowUp", "ArrowUp", "Shift+ArrowUp", "ArrowDown"):
        keys.press(key)
    _has(tab, SHIFT, "1.3")
    tab.page.wait_for_timeout(PAUSE)
    keys.press("ArrowDown")
    for key, value in (("Control+z", "1.3"), ("Control+y", "1.2"), ("Control+z", "1.3"), ("Control+Shift+z", "1.2")):
        keys.press(key)
        _has(tab, SHIFT, value)
        tab.page.wait_for_selector(f'[data-key="{SHIFT}"].changed')
    keys.press("Escape")
    assert _focused(tab) == ""


@contextmanager
def _asleep(server: subprocess.Popen[str]) -> Iterator[None]:
    """A server that answers nothing meanwhile."""
    os.kill(server.pid, signal.SIGSTOP)
    try:
        yield
    finally:
        os.kill(server.pid, signal.SIGCONT)


@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="stops the server")
def test_a_slow_server_overtakes_no_key(tab: Any, served: tuple[subprocess.Popen[str], str]) -> None:
    """Steps to undo are those of the typing, not of the answers; arrow keys go on from what an undo leaves."""
    keys, was = tab.page.keyboard, tab.field(SHIFT).input_value()
    tab.field(SHIFT).select_text()
    keys.type("0.3")
    with _asleep(served[0]):
        for key in ("ArrowUp", "ArrowUp", "Shift+ArrowUp", "ArrowDown"):
            keys.press(key)
        tab.page.wait_for_timeout(PAUSE)
        keys.press("ArrowDown")
        _has(tab, SHIFT, "1.3")
        keys.press("Control+z")
        keys.press("ArrowUp")
        keys.press("ArrowUp")
    _has(tab, SHIFT, "1.6")
    for value in ("1.4", was):
        keys.press("Control+z")
        _has(tab, SHIFT, value)


@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="stops the server")
def test_what_is_typed_comes_before_what_is_pressed_next(tab: Any, served: tuple[subprocess.Popen[str], str]) -> None:
    keys, was = tab.page.keyboard, tab.field(SHIFT).input_value()
    tab.field("pinion.teeth").fill("22")
    tab.page.wait_for_selector("button[aria-label=undo]:enabled")
    tab.field(SHIFT).select_text()
    with _asleep(served[0]):
        keys.type("0.25")
        keys.press("Tab")
        _has(tab, SHIFT, "0.25")
        keys.press("Shift+Tab")
        keys.press("ArrowUp")
        _has(tab, SHIFT, "0.26")
        tab.page.get_by_role("button", name="undo").click()
    _has(tab, SHIFT, was)
    _has(tab, "pinion.teeth", "22")


def test_a_change_that_is_lost_is_sent_again(tab: Any) -> None:
    """As where a connection ends; the field waits 3 s for an answer, here less."""
    tab.page.evaluate("""() => {
        const [later, emit, lost] = [window.setTimeout, window.socket.emit.bind(window.socket), []];
        window.setTimeout = (call, ms, ...rest) => later(call, ms === 3000 ? 300 : ms, ...rest);
        window.socket.emit = (...message) => JSON.stringify(message).includes("0.31") && lost.push(1) === 1 || emit(...message);
    }""")
    tab.field(SHIFT).fill("0.31")
    tab.page.wait_for_selector(f'[data-key="{SHIFT}"].changed')
    tab.field(SHIFT).press("ArrowUp")
    tab.page.click(".left .q-tab:nth-child(2)")
    tab.page.wait_for_function("[...document.querySelectorAll('.cm-line')].some(line => /= 0.32/.test(line.textContent))")


@pytest.mark.long
def test_what_is_half_typed_stays(tab: Any) -> None:
    teeth, module = "pinion.teeth", "pair.normal_module"
    tab.field(teeth).press("Control+a")
    tab.page.keyboard.type("2", delay=20)
    tab.page.wait_for_selector(f'[data-key="{teeth}"] .fault')
    tab.page.keyboard.type("4", delay=20)
    tab.page.wait_for_selector(f'[data-key="{teeth}"] .fault', state="detached")
    tab.field(module).fill("1.234,5")
    tab.page.wait_for_selector(f'[data-key="{module}"] .fault')
    tab.field(teeth).focus()
    assert tab.field(module).input_value() == "1.234,5"
    tab.field(module).fill("3,5")
    tab.page.wait_for_selector(f'[data-key="{module}"] .fault', state="detached")
    tab.field(teeth).focus()
    _has(tab, module, "3.5")


@pytest.mark.long
def test_a_key_is_taken_out_and_what_is_used_stands_there(tab: Any) -> None:
    tab.field("pinion.face_width").fill("31")
    _has(tab, "pinion.face_width", "31")
    tab.page.locator('[data-key="pinion.face_width"] .out').click()
    _has(tab, "pinion.face_width", "")
    used = tab.field("pinion.face_width").get_attribute("placeholder")
    assert used == tab.field("pair.face_width").input_value()


def test_the_text_follows_and_is_followed(tab: Any) -> None:
    tab.field("pinion.teeth").fill("22")
    tab.page.click(".left .q-tab:nth-child(2)")
    lines = tab.page.locator(".cm-line")
    tab.page.wait_for_function("[...document.querySelectorAll('.cm-line')].some(line => /^teeth = 22/.test(line.textContent))")
    place = next(at for at, line in enumerate(lines.all_inner_texts()) if line.startswith("teeth = 22"))
    lines.nth(place).click()
    tab.page.keyboard.press("Home")
    tab.page.keyboard.type("teeth = # ")
    tab.page.wait_for_selector(".cm-line.wrong-line")
    fault = tab.page.inner_text(".spec-fault")
    assert f".toml line {place + 1}, column" in fault
    tab.page.keyboard.press("Control+z")
    tab.page.wait_for_function("document.querySelector('.spec-fault').textContent === ''")
    lines.nth(place).click()
    tab.page.keyboard.press("Home")
    for _ in "teeth = 2":
        tab.page.keyboard.press("ArrowRight")
    tab.page.keyboard.press("Delete")
    tab.page.keyboard.type("3")
    tab.page.click(".left .q-tab:nth-child(1)")
    _has(tab, "pinion.teeth", "23")


@pytest.mark.long
@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="stops the server")
def test_a_slow_server_overtakes_no_key_of_the_text(tab: Any, served: tuple[subprocess.Popen[str], str]) -> None:
    """What is wrong is told while one types on, and an undo leaves what is typed after it."""
    keys = tab.page.keyboard
    tab.page.click(".left .q-tab:nth-child(2)")
    line = tab.page.locator(".cm-line").filter(has_text="teeth = 21")
    line.click()
    keys.press("Home")
    with _asleep(served[0]):
        keys.type("? ab")
    for letter in "cdefghijklmnopqrstuvwxyz":
        keys.type(letter)
        tab.page.wait_for_timeout(5)
    tab.page.wait_for_selector(".cm-line.wrong-line")
    assert line.inner_text().startswith("? abcdefghijklmnopqrstuvwxyzteeth = 21")
    with _asleep(served[0]):
        keys.press("Control+z")
        keys.type("   ")
    tab.page.wait_for_selector(".cm-line.wrong-line", state="detached")
    assert line.text_content().startswith("   teeth = 21")


@pytest.mark.long
def test_the_design_is_moved_in_its_shift_diagram(tab: Any) -> None:
    was = tab.field(SHIFT).input_value()
    tab.page.click(".left .q-tab:nth-child(3)")
    tab.page.wait_for_selector(".limits .limit.undercut path")
    diagram = tab.page.locator(".limits > svg")
    box = diagram.bounding_box()
    x, y = box["x"] + box["width"] * 0.6, box["y"] + box["height"] * 0.8
    tab.page.mouse.move(x, y)
    tab.page.mouse.down()
    tab.page.mouse.move(x + 10, y)
    tab.page.mouse.up()
    moved = tab.page.locator(".limits .slide output").first.inner_text()
    tab.page.wait_for_function(
        '([key, was]) => document.querySelector(`[data-key="${key}"] input`).value !== was', arg=[SHIFT, was]
    )
    _has(tab, SHIFT, moved.rstrip("0"))
    diagram.focus()
    tab.page.keyboard.press("ArrowRight")
    _has(tab, SHIFT, f"{float(moved) + 0.01:.2f}".rstrip("0"))


def test_german_by_the_switch_with_the_design_that_stands(tab: Any) -> None:
    tab.field("pinion.teeth").fill("22")
    _has(tab, "pinion.teeth", "22")
    tab.page.get_by_role("button", name="Deutsch").click()
    tab.page.wait_for_function("document.querySelector('.inputs')?.textContent.includes('Zähnezahl')")
    _has(tab, "pinion.teeth", "22")
    assert tab.page.get_attribute("html", "lang") == "de"


@pytest.mark.long
def test_a_phone_reads_only(tab: Any) -> None:
    tab.page.set_viewport_size({"width": 390, "height": 844})
    tab.page.wait_for_function("document.querySelector('[data-key=\"pinion.teeth\"] input').readOnly")
    assert tab.field("rating.standard").is_disabled()


def test_teeth_are_followed_by_all_panels(lent: Any) -> None:
    outline = lent.page.get_attribute(".gear-section", "data-teeth")
    lent.give("pinion.teeth", "22")
    assert lent.page.get_attribute(".gear-section", "data-teeth") != outline
    lent.page.keyboard.press("Escape")
    lent.give("pinion.teeth", "21")
    assert lent.page.get_attribute(".gear-section", "data-teeth") == outline


def test_wrong_input_is_told_at_its_field_and_the_last_good_design_stays(tab: Any) -> None:
    before = tab.shown()
    tab.field("pinion.teeth").fill("2")
    tab.page.wait_for_selector('[data-key="pinion.teeth"] .fault')
    line = tab.page.inner_text('[data-key="pinion.teeth"] .fault')
    assert "pinion.teeth = 2: must be a whole number from 3 to 2000" in line
    outline = tab.page.get_attribute(".gear-section", "data-teeth")
    assert outline and tab.shown() == before


def test_steps_survive_a_reload(tab: Any) -> None:
    was = tab.field(SHIFT).input_value()
    tab.field(SHIFT).fill("0.31")
    tab.page.wait_for_timeout(PAUSE)
    tab.field(SHIFT).fill("0.32")
    tab.page.reload()  # before the address has the design
    tab.page.wait_for_selector(".scene[data-shown]")
    _has(tab, SHIFT, "0.32")
    for value in ("0.31", was):
        tab.page.get_by_role("button", name="undo").click()
        _has(tab, SHIFT, value)
    tab.page.get_by_role("button", name="redo").click()
    _has(tab, SHIFT, "0.31")


def test_main_inputs_come_first_and_the_rest_is_found(tab: Any) -> None:
    visible = "all => all.filter(each => each.checkVisibility()).map(each => each.dataset.key)"
    keys = tab.page.eval_on_selector_all(".inputs .field", "all => all.map(each => each.dataset.key)")
    assert len(keys) == len(set(keys))
    shown = tab.page.eval_on_selector_all(
        ".inputs .field :is(input, select)", visible.replace("each.dataset", "each.closest('.field').dataset")
    )
    assert shown[:3] == ["pinion.teeth", "wheel.teeth", "pair.normal_module"]
    assert len(shown) == 13
    for words, key in (
        ("rating.life", "rating.life"),
        ("tip alteration wheel", "wheel.tip_alteration"),
        ("Rz", "pair.flank_roughness"),
    ):
        tab.page.fill(".inputs .search", words)
        tab.page.locator(f'[data-key="{key}"] input').wait_for(state="visible")
        assert tab.page.locator(".inputs .ranked").count() == 0
    tab.page.fill(".inputs .search", "")
    tab.page.wait_for_selector(".inputs .ranked")
    assert tab.page.locator(".inputs .ranked sub").count() > 2


@pytest.mark.long
def test_switches_hold_by_the_keyboard_and_say_what_follows(tab: Any) -> None:
    hold = tab.page.locator(".inputs .holds button")
    wheel = tab.page.locator('[data-key="wheel.profile_shift"]')
    assert hold.evaluate_all("all => all.map(each => each.ariaPressed)") == ["true", "false", "false"]
    assert wheel.locator(".used").inner_text() == "0.145986"
    assert wheel.locator(".box").get_attribute("title") == "follows from the centre distance"
    hold.nth(1).focus()
    tab.page.keyboard.press("Enter")
    tab.page.wait_for_selector('.inputs .holds button[aria-pressed="true"]:nth-of-type(2)')
    _has(tab, "pair.centre_distance", "")
    assert tab.field("pair.centre_distance").get_attribute("placeholder") == "97"
    assert tab.page.inner_text(".inputs .holds small") == "The centre distance follows."
    hold.nth(2).click()
    tab.page.wait_for_selector('.inputs .holds button[aria-pressed="true"]:nth-of-type(3)')
    tab.field("pinion.teeth").fill("25")
    _has(tab, "wheel.teeth", "51")
    tab.page.keyboard.press("Escape")
    for key, value in (("wheel.teeth", "43"), ("pair.centre_distance", "97")):
        tab.page.get_by_role("button", name="undo").click()
        _has(tab, key, value)


@pytest.mark.long
def test_inches_are_shown_and_typed_and_the_spec_stays_in_mm(tab: Any) -> None:
    tab.page.get_by_role("button", name="inches and pounds").click()
    tab.page.wait_for_function("document.querySelector('[data-key=\"pair.centre_distance\"] input')?.value === '3.818898'")
    tab.page.wait_for_selector(".scene[data-shown]")
    assert tab.page.inner_text('.row:has([data-key="pair.centre_distance"]) > .unit') == "in"
    assert "Pnd = 8.4667 1/inch" in tab.page.inner_text(".inputs .ranked").replace("\n", "")
    tab.field("pair.face_width")  # opened
    tab.field("pinion.face_width").fill("1.25")
    tab.page.wait_for_selector('[data-key="pinion.face_width"].changed')
    distance = tab.field("pair.centre_distance")
    for _ in range(3):
        distance.fill("")
        distance.fill("3.818898")  # as it was shown
        tab.page.keyboard.press("Tab")
    tab.page.click(".left .q-tab:nth-child(2)")
    tab.page.wait_for_function("document.querySelector('.cm-content')?.textContent.includes('face_width = 31.75')")
    assert "centre_distance = 97.0" in tab.page.inner_text(".cm-content")
    tab.page.wait_for_function("window.location.search.includes('units=in')")
    tab.page.reload()
    tab.page.wait_for_selector(".scene[data-shown]")
    _has(tab, "pinion.face_width", "1.25")
    tab.page.get_by_role("button", name="millimetres and newtons").click()
    _has(tab, "pinion.face_width", "31.75")
