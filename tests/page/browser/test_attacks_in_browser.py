"""What a hostile design, a hasty hand and other tabs do to a page: nothing."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import psutil
import pytest
from support.page_server import DESK, TOLD, Tab, serve, without_token

from gearcad.designs.reader import starter_text
from gearcad.page.fields import fields_of
from gearcad.page.workbench import Workbench, pack

SCRIPT = "<img src=x onerror=alert(1)><script>alert(1)</script>"
TEETH = "pinion.teeth"

WRONG = {
    **{"id": 10**9, "listener_id": "x", "args": ['{"what": "../../x", "name": ["a"], "key": 1}', "not JSON"]},
    **{"request_id": "x", "result": 1, "next_message_id": "x", "level": "x", "message": "\x1b[2J", "tab_id": 1},
}
"""What no page sends: elements and listeners that are not there, and values of other kinds."""

SPEC = f"""# {SCRIPT}
[pair]
name = "hostile"
normal_module = 3.0
centre_distance = 97.0
face_width = 25.0
[pinion]
name = "{SCRIPT}"
teeth = 21
profile_shift = 0.2
[wheel]
name = "{SCRIPT}"
teeth = 43
[material]
name = "{SCRIPT}"
[drawing]
title = "{SCRIPT}"
number = "{SCRIPT}"
owner = "{SCRIPT}"
"""

GROWTH = 40.0
"""MB that a server may grow by over 1,000 changes: caches of results fill up to their bounds."""

HEAP = 10.0
"""MB that a page may grow by over them."""


def _waits_for_teeth(tab: Tab, teeth: int) -> None:
    tab.page.wait_for_function(
        "teeth => document.querySelector('.gear-section').dataset.teeth.startsWith(`${teeth} `)", arg=teeth, timeout=120_000
    )


_HURRY = """async ([key, changes]) => {
  const field = document.querySelector(`[data-key="${key}"] input`);
  for (let change = 0; change <= changes; change += 1) {
    field.value = change < changes ? String(23 + (change % 5)) : "22";
    field.dispatchEvent(new Event("input", { bubbles: true }));
    await new Promise((resolve) => setTimeout(resolve, 30));
  }
}"""


def _hurry(tab: Tab, changes: int) -> None:
    """Type numbers of teeth one after the other, faster than a hand; the last are 22."""
    tab.page.evaluate(_HURRY, [TEETH, changes])


def test_script_in_a_design_is_only_words(tab: Tab) -> None:
    page = tab.page
    page.goto(f"{tab.address}?design={pack('hostile', SPEC)}")
    page.wait_for_selector(".scene[data-shown]")
    for place in ("left", "right"):
        for title in (2, 3, 1):
            page.click(f".{place} .q-tab:nth-child({title})")
    page.wait_for_function("script => document.body.textContent.includes(script)", arg=SCRIPT)
    assert page.locator("img[src=x]").count() == 0


@pytest.mark.long
@pytest.mark.parametrize("starter", ["spur", "reducer", "rack", "ring", "double", "planetary-alm", "train-pairs"])
def test_script_in_every_text_of_a_design_of_any_kind_is_only_words(tab: Tab, starter: str) -> None:
    page = tab.page
    page.goto(f"{tab.address}?design={pack('hostile', _hostile(starter))}")
    page.wait_for_selector(".gear-sheet table")
    for place in ("left", "right"):
        for title in (2, 3, 1):
            page.click(f".{place} .q-tab:nth-child({title})")
    page.wait_for_function("script => document.body.textContent.includes(script)", arg=SCRIPT)
    page.wait_for_timeout(5_000)  # until what takes long is found, too
    assert page.locator("img[src=x]").count() == 0


def _hostile(starter: str) -> str:
    """A design with script wherever it may have words."""
    text = starter_text(starter)[1].replace('"motor"', f'"{SCRIPT}"').replace("motor = 40.0", f'"{SCRIPT}" = 40.0')
    bench = Workbench(f"# {SCRIPT}\n{text}", "hostile", Path())
    groups = [group for table in fields_of(bench.design, bench.tables) for group in table["groups"]]
    for field in (field for group in groups for field in group["fields"] if not field["number"] and not field["choices"]):
        if bench.change({field["key"]: SCRIPT}) and bench.fault is not None:
            bench.undo()
    assert bench.fault is None and bench.text.count(SCRIPT) > 2
    return bench.text


@pytest.mark.long
def test_script_in_any_field_that_takes_text_is_only_words(tab: Tab) -> None:
    bench = Workbench(starter_text("reducer")[1], "reducer", Path())
    groups = [group for table in fields_of(bench.design, bench.tables) for group in table["groups"]]
    keys = [field["key"] for group in groups for field in group["fields"] if not field["number"] and not field["choices"]]
    assert len(keys) > 50
    tab.page.evaluate("document.querySelectorAll('.inputs details').forEach(each => { each.open = true; })")
    for key in keys:
        was = tab.field(key).input_value()
        tab.field(key).fill(SCRIPT)
        tab.page.wait_for_selector(f'[data-key="{key}"]:is(.changed, :has(.fault))')
        assert tab.page.locator("img[src=x]").count() == 0
        tab.field(key).fill(was)
        tab.page.wait_for_selector(f'[data-key="{key}"] .fault', state="detached")


def test_messages_that_are_none_harm_nobody(tab: Tab, folder: Path) -> None:
    """What no page sends, and what its own elements never do: each is a line on the terminal, and all goes on."""
    tab.page.evaluate(
        """async ({ messages, wrong }) => {
          const names = ["event", "handshake", "javascript_response", "ack", "log", "unknown"];
          for (const message of messages) for (const name of names) socket.emit(name, message);
          const { elements } = document.querySelector("#app").__vue_app__._container._vnode.component.proxy;
          for (const [id, { events }] of Object.entries(elements))
            for (const { type, listener_id } of events ?? [])
              for (const args of type === "click" ? [] : wrong)
                socket.emit("event", { id: Number(id), client_id: clientId, listener_id, args: [args] });
          await new Promise(done => setTimeout(done, 500));
        }""",
        {
            "messages": [None, 1, "x", [], {}, *(WRONG | {"client_id": each} for each in ("nobody", 1, None))],
            "wrong": [
                "not JSON",
                None,
                "1",
                '"x"',
                "{}",
                "[1e308, null]",
                '{"key": 1, "text": {}, "forth": [], "number": "x"}',
            ],
        },
    )
    tab.page.goto(tab.address)  # who writes such may have hidden panels from himself
    tab.page.wait_for_selector(".scene[data-shown]")
    tab.give(TEETH, "22")
    assert str(tab.page.get_attribute(".gear-section", "data-teeth")).startswith("22 ")
    told = (folder / TOLD).read_text(encoding="utf-8")
    assert "a page failed" in told
    assert "Traceback" not in told and "\x1b" not in told


def test_script_in_a_field_is_told_as_it_is(tab: Tab) -> None:
    tab.field("pair.normal_module").fill(SCRIPT)
    tab.page.wait_for_selector('[data-key="pair.normal_module"] .fault')
    assert SCRIPT in tab.page.inner_text('[data-key="pair.normal_module"] .fault')
    assert tab.page.locator("img[src=x]").count() == 0


def test_no_script_that_gets_into_the_page_is_run(tab: Tab) -> None:
    """The policy of the page holds where everything else has failed."""
    tab.page.evaluate("script => document.querySelector('.right').insertAdjacentHTML('beforeend', script)", SCRIPT)
    tab.page.evaluate(
        "() => { const one = document.createElement('script'); one.textContent = 'window.ran = 1'; document.body.append(one); }"
    )
    tab.page.wait_for_timeout(300)
    assert tab.page.evaluate("window.ran") is None
    assert len(tab.errors) >= 2 and all("Content Security Policy" in error or "404" in error for error in tab.errors)
    tab.errors.clear()


def test_the_last_of_rapid_changes_is_shown(tab: Tab) -> None:
    _hurry(tab, 20)
    _waits_for_teeth(tab, 22)
    assert tab.field(TEETH).input_value() == "22"


def test_two_tabs_do_not_see_each_other(lent: Tab, browser: Any, address: str) -> None:
    context = browser.new_context()
    other = Tab(context.new_page(), address)
    other.page.goto(address)
    other.page.wait_for_selector(".scene[data-shown]")
    lent.give(TEETH, "22")
    assert other.field(TEETH).input_value() == "21"
    assert str(other.page.get_attribute(".gear-section", "data-teeth")).startswith("21 ")
    context.close()
    assert not other.errors


def test_the_token_is_not_in_history(browser: Any, address: str) -> None:
    context = browser.new_context()
    page = context.new_page()
    page.goto(address)
    page.wait_for_selector(".scene[data-shown]")
    assert page.url.startswith(without_token(address)) and "token=" not in page.url
    assert "token" not in page.evaluate("document.referrer + document.cookie") + page.content()
    context.close()


@pytest.mark.long
def test_memory_is_flat_over_a_thousand_changes(browser: Any, folder: Path) -> None:
    server, address = serve(folder / "reducer-21-43.toml")
    context = browser.new_context(viewport=DESK)
    tab = Tab(context.new_page(), address)
    try:
        tab.page.goto(address)
        tab.page.wait_for_selector(".scene[data-shown]")
        measured = context.new_cdp_session(tab.page)
        memory = []
        for changes in (200, 1000):
            _hurry(tab, changes)
            _waits_for_teeth(tab, 22)
            tab.page.wait_for_timeout(3000)  # until what takes long is found, too
            measured.send("HeapProfiler.collectGarbage")
            heap = measured.send("Runtime.getHeapUsage")["usedSize"] / 1e6
            memory.append((psutil.Process(server.pid).memory_info().rss / 1e6, heap))
    finally:
        context.close()
        server.terminate()
        server.wait(20)
    (server_before, heap_before), (server_after, heap_after) = memory
    print(f"server {server_before:.0f} -> {server_after:.0f} MB, page {heap_before:.1f} -> {heap_after:.1f} MB")
    assert server_after - server_before < GROWTH
    assert heap_after - heap_before < HEAP
    assert not tab.errors
