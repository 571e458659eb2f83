"""Who may ask the server of the page, and that texts of a browser are never files, paths or scripts."""

import re
from pathlib import Path
from typing import Any

import pytest
from support.page_server import awaited

from gearcad.core.errors import ParameterError, SpecError
from gearcad.core.runtime import PACKAGE
from gearcad.designs.reader import starter_text
from gearcad.page.run_process import design_of
from gearcad.page.server import Access, SecurityHeaders, require_token
from gearcad.page.workbench import Workbench

HERE = "127.0.0.1:8765"
TOKEN = "t" * 43


async def _app(scope: Any, _receive: Any, send: Any) -> None:
    headers = [(b"content-type", b"text/html"), (b"x-nicegui-content", b"page")]
    await send({"type": "http.response.start", "status": 200, "headers": headers})
    await send({"type": "http.response.body", "body": b"<script>1</script>", "more_body": True})
    await send({"type": "http.response.body", "body": b"<script src=a></script>"})


def ask(
    app: Any, headers: dict[str, str], *, path: str = "/", query: str = "", kind: str = "http"
) -> tuple[int, dict[str, str], str]:
    """Status (1008 for a websocket that is refused), headers and text of an answer."""
    told: list[Any] = []

    async def send(message: Any) -> None:
        told.append(message)

    async def receive() -> Any:
        return {"type": "http.request"}

    pairs = [(name.encode(), value.encode()) for name, value in headers.items()]
    awaited(app({"type": kind, "path": path, "query_string": query.encode(), "headers": pairs}, receive, send))
    if told[0]["type"] == "websocket.close":
        return told[0]["code"], {}, ""
    answered = {name.decode(): value.decode() for name, value in told[0]["headers"]}
    return told[0]["status"], answered, b"".join(each.get("body", b"") for each in told[1:]).decode()


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({"host": HERE}, 200),
        ({"host": HERE, "origin": f"http://{HERE}"}, 200),
        ({"host": "localhost:8765"}, 200),
        ({"host": HERE, "sec-fetch-site": "cross-site", "sec-fetch-mode": "navigate", "sec-fetch-dest": "document"}, 200),
        ({}, 403),
        ({"host": "127.0.0.1"}, 403),
        ({"host": "rebound.example:8765"}, 403),
        ({"host": HERE, "origin": "http://evil.example"}, 403),
        ({"host": HERE, "origin": f"https://{HERE}"}, 403),
        ({"host": HERE, "origin": f"http://evil.example@{HERE}"}, 403),
        ({"host": HERE, "origin": "http://127.0.0.1:9999"}, 403),
        ({"host": HERE, "origin": "null"}, 403),
        ({"host": HERE, "sec-fetch-site": "cross-site", "sec-fetch-mode": "no-cors", "sec-fetch-dest": "image"}, 403),
        ({"host": HERE, "sec-fetch-site": "cross-site", "sec-fetch-mode": "navigate", "sec-fetch-dest": "iframe"}, 403),
    ],
)
def test_only_the_page_itself_may_ask(headers: dict[str, str], status: int) -> None:
    app = Access(_app, {HERE, "localhost:8765"}, TOKEN)
    headers = headers | {"cookie": f"gearcad_8765={TOKEN}"}
    assert ask(app, headers)[0] == status
    assert ask(app, headers, kind="websocket")[0] == (200 if status == 200 else 1008)


def test_a_token_comes_once_in_the_address_then_as_a_cookie() -> None:
    app = Access(_app, {HERE}, TOKEN)
    host = {"host": HERE}
    assert ask(app, host)[0] == 403
    assert ask(app, host, query="token=wrong")[0] == 403
    assert ask(app, host, path="/bodies/a/1.glb", query=f"token={TOKEN}")[0] == 403
    assert ask(app, host | {"cookie": f"gearcad_8765={TOKEN[:-1]}"})[0] == 403
    assert ask(app, host | {"cookie": 'gearcad_8765="\\'})[0] == 403
    status, headers, body = ask(app, host, query=f'lang=de&token={TOKEN}&x="><script>')
    assert status == 200
    assert TOKEN not in body and "<script>" not in body and 'url=/?lang=de&amp;x=%22%3E%3Cscript%3E"' in body
    cookie, *options = headers["set-cookie"].split("; ")
    assert options == ["HttpOnly", "SameSite=Strict", "Path=/"]
    assert ask(app, host | {"cookie": cookie})[0] == 200
    assert ask(app, host | {"cookie": cookie}, kind="websocket")[0] == 200
    assert ask(app, {"host": HERE, "origin": "http://evil.example", "cookie": cookie})[0] == 403


def test_the_address_that_the_browser_is_started_with_opens_the_page_once() -> None:
    """It stands in the list of processes, as long as the browser runs."""
    app, host = Access(_app, {HERE}, TOKEN, "once" * 11), {"host": HERE}
    assert ask(app, host, path="/x", query=f"token={'once' * 11}")[0] == 403
    assert ask(app, host | {"origin": "http://evil.example"}, query=f"token={'once' * 11}")[0] == 403
    status, headers, _ = ask(app, host, query=f"token={'once' * 11}")
    assert (status, headers["set-cookie"].split(";")[0]) == (200, f"gearcad_8765={TOKEN}")
    assert ask(app, host, query=f"token={'once' * 11}")[0] == 403
    assert ask(app, host, query="token=")[0] == 403
    assert ask(app, host, query=f"token={TOKEN}")[0] == 200


@pytest.mark.parametrize("token", ["", "short", "with a blank, and long enough", "ünderstood-everywhere", "x" * 129, "a;b" * 9])
def test_tokens_that_are_short_or_no_part_of_an_address_are_refused(token: str) -> None:
    with pytest.raises(ParameterError, match=r"token = .*: must be 16 to 128 letters"):
        require_token(token)


def test_pages_run_their_own_scripts_only() -> None:
    status, headers, body = ask(SecurityHeaders(_app), {"host": HERE})
    policy = dict(each.split(" ", 1) for each in headers["content-security-policy"].split("; "))
    nonce = policy["script-src"].split("'nonce-")[1].split("'")[0]
    assert status == 200 and body.count(f'<script nonce="{nonce}"') == 2 == body.count("<script")
    assert int(headers["content-length"]) == len(body)
    assert "unsafe-inline" not in policy["script-src"]
    assert policy["connect-src"] == "'self'" and policy["frame-ancestors"] == policy["default-src"] == "'none'"
    assert headers["referrer-policy"] == "no-referrer" and headers["x-content-type-options"] == "nosniff"
    assert headers["x-frame-options"] == "DENY"
    assert headers["cross-origin-opener-policy"] == headers["cross-origin-resource-policy"] == "same-origin"
    assert nonce not in ask(SecurityHeaders(_app), {"host": HERE})[2]


def test_no_path_is_taken_from_a_header() -> None:
    """NiceGUI would have the page load its scripts from there."""
    told: list[Any] = []

    async def app(scope: Any, _receive: Any, _send: Any) -> None:
        told.extend(name for name, _ in scope["headers"])

    awaited(
        SecurityHeaders(app)(
            {"type": "http", "headers": [(b"X-Forwarded-Prefix", b"//evil.example"), (b"host", b"x")]}, _none, _none
        )
    )
    assert told == [b"host"]


async def _none(*_: Any) -> Any:
    """Nothing is received, nothing sent."""


PAIR = starter_text("fzg-c")[1]
_HEAD, _, _REST = starter_text("train-pairs")[1].partition("# pair = ")
TRAIN = f'{_HEAD}pair = "NAMED"\n\n[[train.mesh]]{_REST.partition("[[train.mesh]]")[2]}'
MATING = "[pair]\nnormal_module = 2.0\nface_width = 24.0\n[pinion]\nteeth = 18\n[wheel]\nteeth = 54\n"
REFUSED = "must be a file in the folder of the page"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "secret.toml").write_text(PAIR, encoding="utf-8")
    inside = tmp_path / "inside"
    inside.mkdir()
    (inside / "led-out.toml").symlink_to(tmp_path / "secret.toml")
    return inside


@pytest.mark.parametrize("name", ["../secret.toml", "sub/../../secret.toml", "/etc/passwd", "led-out.toml", "../no"])
def test_files_outside_are_refused_whether_they_are_there_or_not(folder: Path, name: str) -> None:
    drawn = f'{PAIR}\n[drawing]\ntemplate = "{name}"\n'
    with pytest.raises(SpecError, match=REFUSED) as told:
        design_of(drawn, "mine", folder)
    assert told.value.key == "drawing.template"
    meshed = TRAIN.replace("NAMED", name)
    with pytest.raises(SpecError, match=REFUSED):
        design_of(meshed, "mine", folder)


def test_files_inside_are_found_and_theirs_must_be_inside_too(folder: Path) -> None:
    (folder / "fzg-c.toml").write_text(MATING, encoding="utf-8")
    train = TRAIN.replace("NAMED", "fzg-c.toml")
    assert len(design_of(train, "mine", folder).train.meshes) == 2  # type: ignore[attr-defined]
    assert design_of(PAIR + '\n[drawing]\ntemplate = "mine.toml"\n', "mine", folder).drawing.template == str(
        folder / "mine.toml"
    )
    bad = MATING + '\n[drawing]\ntemplate = "../secret.toml"\n'
    (folder / "fzg-c.toml").write_text(bad, encoding="utf-8")
    with pytest.raises(SpecError, match=REFUSED):
        design_of(train, "mine", folder)


def test_the_workbench_refuses_them_as_a_fault_and_keeps_the_last_design(folder: Path) -> None:
    bench = Workbench(PAIR, "mine", folder)
    design = bench.design
    bench.write(PAIR + '\n[drawing]\ntemplate = "/etc/passwd"\n')
    assert bench.fault is not None and REFUSED in bench.fault.line and bench.fault.key == "drawing.template"
    assert bench.design is design


_UNSAFE = re.compile(
    r"v-html|innerHTML|outerHTML|insertAdjacentHTML|document\.write|\beval\(|new Function|javascript:"
    r"|ui\.html|ui\.markdown|run_javascript|add_head_html|add_body_html|content_html"
)


def test_no_component_takes_a_text_for_html_or_script() -> None:
    sources = [path for path in (PACKAGE / "page").rglob("*") if path.suffix in (".py", ".js")]
    assert len(sources) > 30
    assert [path.name for path in sources if _UNSAFE.search(path.read_text(encoding="utf-8"))] == []
