"""What is on the screen is of the inputs on the screen, or says that it is not; what is typed is saved, or asked for."""

import shutil
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from support.page_server import Tab, kept_port, serve

from gearcad.page.folder import pack

TEETH = "pinion.teeth"
PANES = (".scene", ".gear-section", ".gear-roll", ".gear-sheet >> nth=0", ".gear-sheet >> nth=1")
TOKEN = "a-token-of-a-test-of-the-page"


def _fault(tab: Tab) -> None:
    tab.page.wait_for_selector(".inputs .faults")


def _clear(tab: Tab) -> None:
    tab.page.wait_for_selector(".inputs .faults", state="detached")


def _menu(tab: Tab, name: str) -> None:
    tab.page.locator(".files > summary").click()
    tab.page.get_by_role("button", name=name, exact=True).click()


def _shows_no_gears(tab: Tab) -> None:
    """That nothing of another design is there, but a band that says why."""
    tab.page.wait_for_selector(".band:visible")
    tab.page.wait_for_selector('.gear-section[data-teeth=""]', state="attached")
    assert tab.page.locator(".gear-sheet h2").count() == tab.page.locator(".gear-sheet table").count() == 0
    assert tab.page.locator(".gear-section .tools").count() == 0
    assert set(tab.page.locator(".band:visible").all_inner_texts()) == {"these inputs make no gears"}
    assert not any(tab.page.eval_on_selector_all(".inputs .field input", "all => all.map(each => each.placeholder)"))


def test_what_is_not_of_these_inputs_is_marked(tab: Tab) -> None:
    verdict = tab.page.locator(".gear-sheet h2")
    verdict.wait_for()
    assert "passed" in (verdict.get_attribute("class") or "") and not tab.page.locator(".band:visible").count()
    for wrong in ("2", "1.2.3,4"):
        tab.field(TEETH).fill(wrong)
        _fault(tab)
        for pane in PANES:
            assert tab.page.get_attribute(pane, "data-stale") == "of the last good design", pane
            assert float(tab.page.eval_on_selector(pane, "each => getComputedStyle(each).opacity")) < 0.7
        assert verdict.inner_text() == "strength passed (of the last good design)"
        assert not verdict.get_attribute("class")
        assert tab.page.locator(".band:visible").all_inner_texts() == ["of the last good design"] * 3
        assert "grey: of the last good design" in tab.page.inner_text(".inputs .find")
    tab.field(TEETH).fill("21")
    _clear(tab)
    assert tab.page.locator("[data-stale]").count() == tab.page.locator(".band:visible").count() == 0
    assert "passed" in (verdict.get_attribute("class") or "")


@pytest.fixture
def impossible(folder: Path) -> Iterator[str]:
    """A file of a pair whose centre distance is none."""
    text = (folder / "volvo-13-44.toml").read_text(encoding="utf-8")
    (spec := folder / "impossible.toml").write_text(
        "\n".join("centre_distance = 60" if line.startswith("centre_distance =") else line for line in text.splitlines()),
        encoding="utf-8",
    )
    yield spec.name
    spec.unlink()


def test_a_file_that_makes_no_gears_shows_none(tab: Tab, impossible: str) -> None:
    _menu(tab, impossible)
    _fault(tab)
    _shows_no_gears(tab)
    assert tab.field(TEETH).input_value() == "13"
    assert tab.page.inner_text(".bar .name") == "impossible"
    tab.page.keyboard.press("Escape")
    tab.page.get_by_role("button", name="undo").click()
    tab.page.wait_for_selector(".gear-sheet h2.passed")
    assert tab.page.locator(".band:visible").count() == 0
    tab.page.get_by_role("button", name="redo").click()
    _fault(tab)
    _shows_no_gears(tab)


@pytest.mark.parametrize("text", ["[pair]\nnormal_module = 2\n", "[planetary]\nplanets = 3\n[sun]\nteeth = 24\n", "no TOML"])
def test_a_link_that_makes_no_gears_shows_none(tab: Tab, text: str) -> None:
    tab.page.goto(f"{tab.address}?design={pack('linked', text)}")
    tab.page.wait_for_selector(".inputs .faults")
    _shows_no_gears(tab)
    own = [
        field for field in tab.page.eval_on_selector_all(".inputs .field input", "all => all.map(each => each.value)") if field
    ]
    assert own == {"[pair]": ["2"], "[plane": ["24", "3"]}.get(text[:6], [])


def test_a_comment_survives_its_value(tab: Tab) -> None:
    lines = tab.page.locator(".cm-line")
    tab.page.click(".left .q-tab:nth-child(2)")
    tab.page.wait_for_function("document.querySelectorAll('.cm-line').length > 5")
    before = lines.all_inner_texts()
    tab.page.click(".left .q-tab:nth-child(1)")
    field = tab.field("pinion.profile_shift")
    field.fill("")
    tab.page.wait_for_selector("button[aria-label=undo]:enabled")
    tab.page.wait_for_timeout(1200)  # a step of its own
    field.press_sequentially("0.2", delay=30)
    tab.page.click(".left .q-tab:nth-child(2)")
    same = "before => [...document.querySelectorAll('.cm-line')].map((line) => line.innerText).join('\\n') === before"
    tab.page.wait_for_function(same, arg="\n".join(before))
    assert any(line.startswith("profile_shift = 0.2 ") and "# in normal modules" in line for line in before)


@pytest.fixture
def own(browser: Any, tmp_path: Path, folder: Path) -> Iterator[Tab]:
    """A page of its own, of a copy of a file of another name than its design's."""
    shutil.copy(folder / "reducer-21-43.toml", tmp_path / "mine.toml")
    server, address = serve(tmp_path / "mine.toml", "--token", TOKEN, "--port", str(kept_port()))
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    tab = Tab(context.new_page(), address)
    tab.page.remove_listener("dialog", tab._refuse)
    tab.page.goto(address)
    tab.page.wait_for_selector(".scene[data-shown]")
    tab.server = server  # type: ignore[attr-defined]
    yield tab
    context.close()
    tab.server.terminate()  # type: ignore[attr-defined]
    tab.server.wait(20)  # type: ignore[attr-defined]


def _titled(tab: Tab, title: str) -> None:
    tab.page.wait_for_function("title => document.title === title", arg=title)


def test_saving_is_of_the_file_that_is_open(own: Tab, tmp_path: Path) -> None:
    """It is the file, not the design's name; what another program has changed meanwhile is asked for."""
    spec = tmp_path / "mine.toml"
    _titled(own, "mine - gearcad")
    own.field(TEETH).fill("22")
    own.page.wait_for_selector(".files .unsaved")
    _titled(own, "● mine - gearcad")
    own.field(TEETH).press("Control+s")
    _titled(own, "mine - gearcad")
    assert "teeth = 22" in spec.read_text(encoding="utf-8")
    own.page.get_by_text("saved: mine.toml").wait_for()
    own.page.locator(".files > summary").click()
    own.page.wait_for_function("document.querySelector('.files-menu form input').value === 'mine'")
    own.page.keyboard.press("Escape")
    spec.write_text("# changed by another\n" + spec.read_text(encoding="utf-8"), encoding="utf-8")
    own.field(TEETH).fill("23")
    own.page.keyboard.press("Control+s")
    own.page.wait_for_selector(".files[open] .fault")
    assert "teeth = 22" in spec.read_text(encoding="utf-8")
    own.page.get_by_role("button", name="replace it").click()
    _titled(own, "mine - gearcad")
    assert "teeth = 23" in spec.read_text(encoding="utf-8")
    own.page.locator(".files-menu form input").fill("yours")
    own.page.locator(".files-menu form button").click()
    _titled(own, "yours - gearcad")


def test_a_design_that_is_not_saved_does_not_go_unasked(own: Tab) -> None:
    asked: list[str] = []

    def stay(dialog: Any) -> None:
        asked.append(dialog.type)
        dialog.dismiss()

    own.page.on("dialog", stay)
    own.field(TEETH).click()
    own.page.keyboard.press("ArrowUp")
    _titled(own, "● mine - gearcad")
    own.page.close(run_before_unload=True)
    own.page.wait_for_timeout(500)
    assert asked == ["beforeunload"]
    own.page.get_by_role("button", name="Deutsch").click()
    own.page.wait_for_selector("html[lang=de]")
    _titled(own, "● mine - gearcad")
    own.page.keyboard.press("Control+s")
    _titled(own, "mine - gearcad")
    assert asked == ["beforeunload"]


def _restarted(own: Tab, tmp_path: Path) -> None:
    """A server of the same file, at the address of one that has ended."""
    port = own.address.rstrip("/").rpartition(":")[2]
    own.server = serve(tmp_path / "mine.toml", "--token", TOKEN, "--port", port)[0]  # type: ignore[attr-defined]


@pytest.mark.parametrize("where", [pytest.param("field", marks=pytest.mark.long), "text"])
def test_what_is_typed_while_the_server_is_away_is_sent_when_it_is_back(own: Tab, tmp_path: Path, where: str) -> None:
    own.page.wait_for_function("window.location.search.includes('design=')")
    before = own.page.evaluate("window.location.search")
    own.field("pair.face_width").fill("26")
    own.page.wait_for_function("before => window.location.search !== before", arg=before)  # the address has the design
    if where == "text":
        own.page.click(".left .q-tab:nth-child(2)")
        own.page.wait_for_selector(".cm-line")
    server: subprocess.Popen[str] = own.server  # type: ignore[attr-defined]
    server.send_signal(signal.SIGTERM)
    server.wait(20)
    if where == "text":
        own.page.locator(".cm-line").filter(has_text="teeth = 21").click()
        own.page.keyboard.press("Home")
        own.page.keyboard.type("# ")
        own.page.keyboard.press("End")
        own.page.keyboard.type("\nteeth = 22")
    else:
        own.field(TEETH).fill("22")
    own.page.wait_for_timeout(500)
    _restarted(own, tmp_path)
    own.page.wait_for_function("document.querySelector('.gear-section')?.dataset.teeth?.startsWith('22 ')", timeout=60000)
    assert own.field(TEETH).input_value() == "22"
    assert own.field("pair.face_width").input_value() == "26"
    _titled(own, "● mine - gearcad")


def test_what_is_typed_without_a_connection_is_sent_with_the_next(tab: Tab) -> None:
    tab.page.evaluate("window.socket.disconnect()")
    tab.field(TEETH).fill("22")
    tab.page.wait_for_timeout(300)
    tab.page.evaluate("window.socket.connect()")
    tab.page.wait_for_function("document.querySelector('.gear-section').dataset.teeth.startsWith('22 ')")
