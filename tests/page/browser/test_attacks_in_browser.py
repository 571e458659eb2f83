"""What hostile designs, hasty hands, other tabs, programs and sites do to a page and may ask its server: nothing."""

import http.client
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from urllib.parse import parse_qs, urlsplit

import psutil
import pytest
from support.page_server import DESK, TOLD, Tab, serve, without_token
from support.processes import wait_until

from gearcad.designs.reader import starter_text
from gearcad.page.fields import fields_of
from gearcad.page.folder import pack
from gearcad.page.session import Session
from gearcad.page.workbench import Workbench

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
    page.wait_for_selector(".gear-sheet table:visible")
    for place in ("left", "right"):
        for title in (2, 3, 1):
            tab_of_kind = page.locator(f".{place} .q-tab:nth-child({title})").first
            if tab_of_kind.is_visible():  # some kinds of designs have fewer
                tab_of_kind.click()
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


@pytest.mark.long
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


@pytest.mark.long
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


def _show_a_result(tab: Tab) -> None:
    """Check the design, and show all that the page draws of it and of its flanks."""
    tab.page.click(".right >> text=Runs")
    tab.page.click(".run-kinds button:has-text('check in the plane')")
    tab.page.wait_for_selector(".gear-results[data-drawn]", timeout=120_000)
    tab.page.select_option(".section-tools select >> nth=0", "draw")


@pytest.mark.long
@pytest.mark.parametrize("shows_result", [False, True])
def test_memory_is_flat_over_a_thousand_changes(browser: Any, folder: Path, shows_result: bool) -> None:
    server, address = serve(folder / "reducer-21-43.toml")
    context = browser.new_context(viewport=DESK)
    tab = Tab(context.new_page(), address)
    try:
        tab.page.goto(address)
        tab.page.wait_for_selector(".scene[data-shown]")
        if shows_result:
            _show_a_result(tab)
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


SOCKET = "/_nicegui_ws/socket.io/?EIO=4"
UPGRADE = {
    "Connection": "Upgrade",
    "Upgrade": "websocket",
    "Sec-WebSocket-Version": "13",
    "Sec-WebSocket-Key": "x3JJHMbDL1EzLkh9GBhXDw==",
}
EVIL = "http://evil.example"
ELSEWHERE = "127.0.0.2"
"""An address of this machine that is not where the page is by itself."""


TOO_BIG = 1009
"""What a connection is closed with whose message is too large (RFC 6455, 7.4.1)."""

LARGE = b"4" + b"x" * (1 << 21)


def ask(address: str, path: str = "/", method: str = "GET", body: bytes | None = None, **headers: str) -> tuple[int, str, str]:
    """Status, cookie and text of an answer; a keyword is a header. With the token of the address as a cookie, if it has one."""
    connection = http.client.HTTPConnection(urlsplit(address).netloc, timeout=30)
    sent = cookie_of(address) | {name.replace("_", "-"): value for name, value in headers.items()}
    connection.request(method, path, body, sent)
    answer = connection.getresponse()
    text = "" if answer.status == 101 else answer.read().decode("utf-8", "replace")
    connection.close()
    return answer.status, answer.getheader("Set-Cookie", ""), text


def cookie_of(address: str) -> dict[str, str]:
    """The header by which a browser shows the token of an address."""
    parts = urlsplit(address)
    tokens = parse_qs(parts.query).get("token")
    return {"Cookie": f"gearcad_{parts.port}={tokens[0]}"} if tokens else {}


@pytest.mark.parametrize(
    "headers", [{"Origin": EVIL}, {"Origin": "null"}, {"Host": "rebound.example:8765"}, {"Sec-Fetch-Site": "cross-site"}]
)
def test_other_sites_reach_neither_page_nor_connection(address: str, headers: dict[str, str]) -> None:
    assert ask(address, **headers)[0] == 403
    assert ask(address, f"{SOCKET}&transport=polling", **headers)[0] == 403
    assert ask(address, f"{SOCKET}&transport=polling&sid=x", "POST", b"40", **headers)[0] == 403
    assert ask(address, f"{SOCKET}&transport=websocket", **(UPGRADE | headers))[0] == 403


@pytest.mark.parametrize("path", ["/", "/nothing", "/bodies/x/y", f"{SOCKET}&transport=polling"])
def test_every_answer_says_what_may_be_done_with_it(address: str, path: str) -> None:
    connection = http.client.HTTPConnection(urlsplit(address).netloc, timeout=30)
    connection.request("GET", path, headers=cookie_of(address))
    answer = connection.getresponse()
    assert answer.getheader("X-Frame-Options") == "DENY" and answer.getheader("X-Content-Type-Options") == "nosniff"
    assert "default-src 'none'" in answer.getheader("Content-Security-Policy", "")
    connection.close()


def test_no_message_over_the_connection_is_larger_than_permitted(address: str) -> None:
    from websockets.exceptions import ConnectionClosed
    from websockets.sync.client import connect

    at = f"{without_token(address).replace('http', 'ws', 1).rstrip('/')}{SOCKET}&transport=websocket"
    with connect(at, additional_headers=cookie_of(address)) as socket:
        socket.send(LARGE)
        with pytest.raises(ConnectionClosed) as closed:
            while True:
                socket.recv(timeout=20)
    assert closed.value.rcvd is not None and closed.value.rcvd.code == TOO_BIG


def test_the_page_itself_reaches_its_connection(address: str) -> None:
    ours = {"Origin": without_token(address).rstrip("/")}
    assert ask(address, f"{SOCKET}&transport=polling", **ours)[0] == 200
    assert ask(address, f"{SOCKET}&transport=websocket", **(UPGRADE | ours))[0] == 101


@pytest.mark.parametrize(
    "path",
    [
        "/../../etc/passwd",
        "/bodies/x/../../../etc/passwd",
        "/bodies/%2e%2e/%2fetc%2fpasswd",
        "/made/x/0/..%2f..%2freducer-21-43.toml",
        "/made/x/0/reducer-21-43.toml",
        "/_nicegui/3.0.0/static/..%2f..%2f..%2fpyproject.toml",
        "/_nicegui/3.0.0/components/..%2f..%2f/etc/passwd",
        "/reducer-21-43.toml",
        "/made/x/0/%252e%252e%252freducer-21-43.toml",
        "/made/x/0/..%5c..%5creducer-21-43.toml",
        "/made/x/99999999999999999999999999/reducer-21-43.toml",
        "/bodies/x/reducer-21-43.toml%00.glb",
        "/_nicegui/3.0.0/static/%252e%252e/%252e%252e/pyproject.toml",
        "//etc/passwd",
    ],
)
def test_no_path_leads_to_a_file(address: str, path: str) -> None:
    status, _, text = ask(address, path)
    assert status in (400, 404, 422)
    assert "root:" not in text and "normal_module" not in text and "[project]" not in text


def test_script_in_a_design_is_no_part_of_the_page(address: str) -> None:
    text = starter_text("train-pairs")[1].replace('"motor"', f'"{SCRIPT}"').replace("motor = 40.0", f'"{SCRIPT}" = 40.0')
    text = text.replace("helical stage", "stage of this design alone")  # the page tells of its starters too
    status, _, sent = ask(address, f"/?design={pack('hostile', text)}")
    assert status == 200
    assert not any(
        each in sent for each in ("onerror", "<script>alert", "stage of this design")
    )  # texts come by the connection


def test_what_is_too_large_is_refused_and_the_page_goes_on(address: str) -> None:
    opened = ask(address, f"{SOCKET}&transport=polling")[2]
    sid = opened.split('"sid":"')[1].split('"')[0]
    with ThreadPoolExecutor(1) as polling:
        polling.submit(ask, address, f"{SOCKET}&transport=polling&sid={sid}")  # who is refused is told so there, too
        time.sleep(0.5)  # until it waits there
        assert ask(address, f"{SOCKET}&transport=polling&sid={sid}", "POST", LARGE)[0] == 400
    assert ask(address, "/given/nobody/spec?name=a.toml", "POST", LARGE)[0] == 404
    assert ask(address, f"/?design={'A' * 20_000}")[0] == 200
    assert ask(address)[0] == 200


def test_who_has_no_token_reaches_nothing(address: str) -> None:
    """Other accounts of the machine reach the port."""
    bare = without_token(address)
    for path in ("/", "/?token=wrong", "/?token=", "/nothing", "/_nicegui/3.0.0/static/a", f"{SOCKET}&transport=polling"):
        assert ask(bare, path)[0] == 403
    assert ask(bare, f"{SOCKET}&transport=websocket", **UPGRADE)[0] == 403
    assert ask(bare, "/given/nobody/spec?name=a.toml", "POST", b"[gear]")[0] == 403


def test_scripts_give_a_token_of_their_own(folder: Path) -> None:
    server, printed = serve(folder / "spur.toml", "--token", "a-script-has-made-it")
    try:
        assert printed.endswith("/?token=a-script-has-made-it")
        assert ask(printed)[0] == 200 and ask(without_token(printed))[0] == 403
    finally:
        server.terminate()
        server.wait(20)


def test_the_browser_is_started_with_an_address_for_one_use(folder: Path, tmp_path: Path) -> None:
    started = tmp_path / "started"
    started.write_text(f'#!/bin/sh\necho "$1" > {tmp_path}/new && mv {tmp_path}/new {tmp_path}/address\n')
    started.chmod(0o700)
    server, printed = serve(folder / "spur.toml", browser=f"{started} %s")
    try:
        wait_until((tmp_path / "address").exists, "the browser")
        address, token = (tmp_path / "address").read_text().strip().split("?token=")
        assert address == without_token(printed) and token not in printed
        statuses = [ask(address, f"/?token={token}") for _ in range(2)]
        assert [status for status, _, _ in statuses] == [200, 403]
        assert statuses[0][1].split(";")[0] == cookie_of(printed)["Cookie"]
    finally:
        server.terminate()
        server.wait(20)


def test_others_need_the_token_and_ctrl_c_leaves_nothing(folder: Path, tmp_path: Path) -> None:
    server, printed = serve(folder / "reducer-21-43.toml", "--host", ELSEWHERE, temporary=tmp_path)
    try:
        address, token = printed.split("?token=")
        assert ask(address)[0] == ask(address, "/?token=wrong")[0] == ask(address, f"{SOCKET}&transport=polling")[0] == 403
        status, cookie, text = ask(address, f"/?token={token}")
        assert status == 200 and token not in text
        assert ask(address, Cookie=cookie.split(";")[0])[0] == 200
        assert ask(address, Cookie=cookie.split("=")[0] + "=" + "x" * len(token))[0] == 403
        assert list(tmp_path.glob("gearcad-*"))
    finally:
        server.send_signal(signal.SIGINT)
        status = server.wait(20)
    assert status == 0
    assert not list(tmp_path.iterdir())


@pytest.mark.long
def test_sigterm_ends_a_run_with_all_that_was_its_own(browser: object, folder: Path, tmp_path: Path) -> None:
    server, address = serve(folder / "reducer-21-43.toml", temporary=tmp_path)
    page = browser.new_page()  # type: ignore[attr-defined]
    page.goto(address)
    page.wait_for_selector(".scene[data-shown]")
    page.click(".right >> text=Runs")
    page.click(".run-kinds button:has-text('solid bodies')")
    page.wait_for_function("() => /\\w/.test(document.querySelector('.run-list .step')?.textContent ?? '')", timeout=60_000)
    children = _children(server.pid)
    assert children
    server.terminate()
    assert server.wait(20) == 0
    page.close()
    deadline = time.monotonic() + 10
    while time.monotonic() < deadline and any(map(_runs, children)):
        time.sleep(0.1)
    assert not any(map(_runs, children))
    assert not list(tmp_path.iterdir())


@pytest.mark.long
def test_pages_that_no_browser_shows_keep_nobody_out(browser: Any, folder: Path) -> None:
    server, address = serve(folder / "spur.toml")
    try:
        context = browser.new_context()
        tab = Tab(context.new_page(), address)
        tab.page.goto(address)
        tab.page.wait_for_selector(".scene[data-shown]")
        statuses = [ask(address)[0] for _ in range(40)]
        tab.give("gear.teeth", "31")
        other = context.new_page()
        other.goto(without_token(address))
        other.wait_for_selector(".scene[data-shown]")
        context.close()
    finally:
        server.terminate()
        server.wait(20)
    assert statuses == [200] * 40


def test_pages_that_browsers_show_are_not_dropped(monkeypatch: pytest.MonkeyPatch) -> None:
    dropped: list[float] = []
    pages = [
        SimpleNamespace(_has_browser=shown, _client=SimpleNamespace(created=created, delete=partial(dropped.append, created)))
        for created, shown in ((1.0, True), (3.0, False), (2.0, False))
    ]
    monkeypatch.setattr(Session, "open", pages)
    assert Session.drop_abandoned()
    assert dropped == [2.0]
    monkeypatch.setattr(Session, "open", pages[:1])
    assert not Session.drop_abandoned()


def _children(process: int) -> list[int]:
    """Processes that it has started, and that these have."""
    listed = subprocess.run(["ps", "-e", "-o", "pid=,ppid="], capture_output=True, text=True, check=True).stdout
    parents = {int(line.split()[0]): int(line.split()[1]) for line in listed.splitlines()}
    direct = [each for each, parent in parents.items() if parent == process]
    return direct + [each for child in direct for each in _children(child)]


def _runs(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return sys.platform != "linux" or "\nState:\tZ" not in Path(f"/proc/{process}/status").read_text(encoding="utf-8")
