"""Folder and links of the page: what is found by name, and designs that links hold whole."""

import base64
import zlib
from pathlib import Path

import pytest
from support.page_server import awaited
from support.specs import starter_specs

from gearcad.core.errors import GearcadError, ParameterError, SpecError
from gearcad.core.runtime import templates
from gearcad.designs.design import LONGEST_NAME
from gearcad.designs.reader import starter_text, starters
from gearcad.page.folder import LARGEST_SPEC, LARGEST_TEXT, LONGEST, SPECS, TABLES, Folder, TakenError, pack, text_of, unpack
from gearcad.page.runs import add_given, await_files
from gearcad.page.workbench import linked_bench

PAIR = starter_text("fzg-c")[1]
NO_NAMES = [
    *("../secret.toml", "..", "", ".", "/etc/passwd", "sub/inner.toml", "sub\\inner.toml", ".hidden.toml", "led-out.toml"),
    *("a\0b.toml", "mine.toml/", "MINE.toml ", "folder.toml", "notes.txt", "<b>.toml", "~/mine.toml", "C:\\mine.toml"),
]


@pytest.fixture
def folder(tmp_path: Path) -> Folder:
    place = tmp_path / "inside"
    (place / "sub").mkdir(parents=True)
    (place / "folder.toml").mkdir()
    (tmp_path / "secret.toml").write_text("secret", encoding="utf-8")
    for name in ("mine.toml", "notes.txt", "results.csv", ".hidden.toml", "sub/inner.toml"):
        (place / name).write_text(PAIR, encoding="utf-8")
    (place / "led-out.toml").symlink_to(tmp_path / "secret.toml")
    (place / "led-in.toml").symlink_to(place / "sub/inner.toml")
    return Folder(place)


def test_only_specs_are_offered_among_other_toml() -> None:
    offered = Folder(templates()).specs()
    assert {"spur.toml", "fzg-c.toml", "rack.toml", "train-pairs.toml", "planetary-alm.toml"} <= set(offered)
    gearboxes = ["ravigneaux.toml", "simpson.toml"]  # refused in one line when they are opened
    assert offered == sorted([*(path.name for path in starter_specs()), *gearboxes])


@pytest.mark.parametrize(
    ("text", "is_spec"),
    [
        ("# of ours\n[pair]", True),
        (' [ gear ]  # and "no end', True),
        ('planetary.name = "x"', True),
        ("[project]\nname = 'gearcad'", False),
        ('gear = "Zahnrad"\n[gearbox]', False),
        ('[data]\nrack = { en = "rack" }', False),
        ("# [gear]", False),
    ],
)
def test_a_spec_is_known_by_what_it_is_of(tmp_path: Path, text: str, is_spec: bool) -> None:
    (tmp_path / "it.toml").write_text(text, encoding="utf-8")
    assert Folder(tmp_path).specs() == ["it.toml"] * is_spec


def test_specs_and_tables_are_listed_and_read(folder: Folder) -> None:
    assert folder.names(SPECS) == ["led-in.toml", "mine.toml"]
    assert folder.names(TABLES) == ["results.csv"]
    assert folder.spec("mine.toml") == PAIR
    (folder.path / "large.toml").write_bytes(b"#" * (LARGEST_SPEC + 1))
    with pytest.raises(ParameterError, match="must be smaller"):
        folder.spec("large.toml")
    assert Folder(folder.path / "nowhere").names(SPECS) == []


@pytest.mark.parametrize("name", NO_NAMES)
def test_nothing_else_is_read(folder: Folder, name: str) -> None:
    with pytest.raises(ParameterError, match="must be one of those in the folder"):
        folder.spec(name)


@pytest.mark.parametrize("name", [*NO_NAMES[:8], "a" * 300, "a" * LONGEST_NAME, "a.", "con", "x/../y", "a:b", "a\nb", "-rf"])
def test_nothing_is_written_elsewhere(folder: Folder, name: str) -> None:
    before = sorted(folder.path.parent.rglob("*"))
    with pytest.raises(GearcadError):
        folder.save(name, "text", replace=False)
    assert sorted(folder.path.parent.rglob("*")) == before


def test_saving_asks_before_it_replaces(folder: Folder) -> None:
    text = "# ä\r\n[gear]\r\n"
    assert folder.save("other", text, replace=False) == "other.toml"
    assert (folder.path / "other.toml").read_bytes() == text.encode()
    for name in ("mine", "mine.toml", "MINE", " mine "):
        with pytest.raises(TakenError, match="is there"):
            folder.save(name, text, replace=False)
    assert folder.save("mine.toml", text, replace=True) == "mine.toml"
    assert folder.spec("mine.toml") == text


def test_a_link_that_leads_out_is_replaced_and_not_followed(folder: Folder) -> None:
    folder.save("led-out", "mine", replace=True)
    assert (folder.path.parent / "secret.toml").read_text() == "secret"
    assert folder.spec("led-out.toml") == "mine"
    assert not [each for each in folder.path.iterdir() if each.name.startswith(".unfinished")]


def test_what_a_browser_sends_as_a_spec_is_text_of_a_size() -> None:
    assert text_of("\ufeff# ä".encode(), "a.toml") == "# ä"
    with pytest.raises(SpecError, match="not UTF-8"):
        text_of(b"\xff\xfe", "a.toml")
    with pytest.raises(SpecError, match="more than 256 kB"):
        text_of(b"#" * (LARGEST_SPEC + 1), "a.toml")


def test_files_come_to_the_session_that_waits_for_them_up_to_a_size() -> None:
    httpx, fastapi = pytest.importorskip("httpx"), pytest.importorskip("fastapi")
    app, taken = fastapi.FastAPI(), []
    add_given(app)
    await_files("mine", {"spec": (10, lambda name, content: taken.append((name, content)))})

    async def post(path: str, content: bytes) -> int:
        async with httpx.AsyncClient(transport=httpx.ASGITransport(app), base_url="http://127.0.0.1") as asking:
            status: int = (await asking.post(path, content=content)).status_code
            return status

    async def all_posts() -> list[int]:
        asked = [("mine/spec", b"0123456789"), ("mine/spec", b"0123456789+"), ("mine/other", b""), ("yours/spec", b"")]
        found = [await post(f"/given/{path}?name=../a.toml", content) for path, content in asked]
        found.append(await post(f"/given/mine/spec?name={'a' * 1000}", b""))
        await_files("mine", None)
        return [*found, await post("/given/mine/spec?name=a", b"")]

    assert awaited(all_posts()) == [200, 413, 404, 404, 200, 404]
    assert taken == [("../a.toml", b"0123456789"), ("a" * 200, b"")]


def _packed(content: bytes) -> str:
    return base64.urlsafe_b64encode(zlib.compress(content, 9)).decode().rstrip("=")


LONG = "".join(f"# {zlib.crc32(str(each).encode())}\n" for each in range(3000))
"""What no link can hold."""


def test_a_link_gives_the_text_back_to_its_last_comment() -> None:
    for name in starters():
        text = starter_text(name)[1]
        assert unpack(pack(name, text)) == (name, text)
    odd = "# ä→ '\"<script>\r\n\t[gear]\r\nteeth = 20"
    assert unpack(pack("Größe 2", odd)) == ("Größe 2", odd)


def test_a_text_that_no_address_holds_is_refused() -> None:
    with pytest.raises(ParameterError, match=f"{LONGEST} characters"):
        pack("long", LONG)


@pytest.mark.parametrize(
    "packed",
    [
        "",
        "x",
        "ä",
        "../../etc/passwd",
        "<script>",
        pack("a", PAIR)[:-3],
        pack("a", PAIR) + "AAAA",
        pack("a", PAIR) * 40,
        _packed(f"a\0{LONG}{PAIR}".encode()),
        _packed(b"no name"),
        _packed(b"a\0\xff"),
        _packed(b"a\0" + bytes(2 * LARGEST_TEXT)),
        _packed(b"a\0" + bytes(1 << 26)),
        _packed(b"../a\0" + PAIR.encode()),
        _packed(b"\0" + PAIR.encode()),
    ],
)
def test_what_is_no_link_is_refused(packed: str) -> None:
    with pytest.raises(ParameterError):
        unpack(packed)
    if packed:
        bench = linked_bench(packed, PAIR, "mine", Path())
        assert bench.text == PAIR and bench.fault is not None


def test_a_link_is_opened_and_what_is_wrong_with_its_design_told(tmp_path: Path) -> None:
    other = PAIR.replace('name = "fzg-c"', 'name = "linked"')
    assert linked_bench(pack("of-link", other), PAIR, "mine", tmp_path).design.name == "linked"
    assert linked_bench("", PAIR, "mine", tmp_path).text == PAIR
    outside = PAIR + '\n[drawing]\ntemplate = "/etc/passwd"\n'
    for wrong in (PAIR.replace("[wheel]", "[whell]"), "[", outside):
        bench = linked_bench(pack("of-link", wrong), PAIR, "mine", tmp_path)
        assert (bench.text, bench.design.name) == (wrong, "fzg-c")
        assert bench.fault is not None and bench.fault.line.startswith("of-link.toml")
