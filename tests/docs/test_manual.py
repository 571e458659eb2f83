"""The manual: what its pages show is what comes out; every command, public name, key and quantity has its place in it."""

import re
import runpy
import socket
import sys
from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path
from types import ModuleType

import pytest
from click import Context
from manual.blocks import blocks_of, commands_of, is_long
from manual.field_words import default, permitted
from manual.key_tables import key_tables
from manual.result_tables import result_tables
from manual.running import run_page

import gearcad
from gearcad.cli import main
from gearcad.core import symbols
from gearcad.core.quantities import FieldSchema, schema_of
from gearcad.designs.keys import FIELDS, SHARED
from gearcad.designs.train_keys import PLANETARY, TRAIN

DOCS = Path(__file__).parents[2] / "docs"


OTHERS = {"README.md", "papers.md", "overview.md"}
"""How the manual is made, which is no page of it; and what `test_readme.py` and `test_readme_commands.py` run."""

PAGES = [page for page in sorted(DOCS.rglob("*.md")) if page.relative_to(DOCS).as_posix() not in OTHERS]


def _runs(page: Path) -> bool:
    return any(block.language in ("console", "python") for block in blocks_of(page.read_text(encoding="utf-8")))


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(
            page, id=page.relative_to(DOCS).with_suffix("").as_posix(), marks=[pytest.mark.long] if is_long(page) else []
        )
        for page in PAGES
        if _runs(page)
    ],
)
def test_page_shows_what_comes_out(page: Path, tmp_path: Path) -> None:
    faults = list(run_page(page, tmp_path))
    assert not faults, "\n".join(f"{page}: {fault}" for fault in faults)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(DOCS).as_posix())
def test_commands_stand_where_they_are_run(page: Path) -> None:
    """But `gearcad open`, which lasts until Ctrl-C."""
    for block in blocks_of(page.read_text(encoding="utf-8")):
        if block.language not in ("console", "python", "toml", "csv"):
            assert not re.search(r"^(?:\$ )?gearcad (?!open)", block.text, re.MULTILINE), f"{page}, line {block.line}: not run"


COMMANDS = main.list_commands(Context(main))
SHOWN_ONLY = ("open", "doctor")
"""What lasts until Ctrl-C."""


def _page(command: str) -> str:
    return (DOCS / "commands" / f"{command}.md").read_text(encoding="utf-8")


def test_pages_are_those_of_the_commands_in_their_order() -> None:
    index = (DOCS / "commands" / "index.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"```{toctree}\n:maxdepth: 1\n\n(.*?)\n```", index, re.DOTALL)
    assert block.split() == COMMANDS


@pytest.mark.parametrize("command", COMMANDS)
def test_page_has_help_options_and_an_example(command: str) -> None:
    page = _page(command)
    assert page.count(f"```{{command}} {command}\n") == page.count(f"```{{options}} {command}\n") == 1
    run = [each.text for block in blocks_of(page) if block.language == "console" for each in commands_of(block)]
    assert command in SHOWN_ONLY or any(text.startswith(f"gearcad {command}") for text in run)


@pytest.mark.parametrize("command", [each for each in COMMANDS if each not in ("new", "data", "completion", *SHOWN_ONLY)])
def test_page_names_every_file_that_its_example_writes(command: str) -> None:
    """What the example prints at its end, as `test_manual.py` finds it."""
    page = _page(command)
    files = page.partition("## Files")[2].partition("## Options")[0]
    named = [name for row in re.findall(r"^\| ([^|]*) \|", files, re.MULTILINE) for name in re.findall(r"`([^`]+)`", row)]
    commands = [each for block in blocks_of(page) if block.language == "console" for each in commands_of(block)]
    shown = [each.shown for each in commands if each.text.startswith(f"gearcad {command}")]
    written = [line.strip() for text in shown for line in text.splitlines() if re.fullmatch(r"\S+\.\w+", line.strip())]
    starters = {path.name for path in (DOCS.parent / "templates").iterdir()}
    for path in written:
        if path not in starters:
            assert any(fnmatch(path.rpartition("/")[2], name) or fnmatch(path, f"*/{name}") for name in named), path
    assert written


CALLED_OTHERWISE = {"read": "read_spec"}
"""Names of the entrance whose documentation stands under that of their home."""


def test_every_public_name_is_documented() -> None:
    pages = "".join(page.read_text(encoding="utf-8") for page in (DOCS / "api").glob("*.md"))
    directives = re.findall(r"^\.\. auto(\w+):: (\S+)", pages, re.MULTILINE)
    whole = [name.rpartition(".")[2] for kind, name in directives if kind == "module"]
    documented = {name.rpartition(".")[2] for _, name in directives}
    rooms = {room: found for room in dir(gearcad) if isinstance(found := getattr(gearcad, room), ModuleType)}
    public = {CALLED_OTHERWISE.get(name, name) for name in gearcad.__all__ if not name.startswith("__")}
    for room, module in rooms.items():
        if room not in whole:
            public |= set(getattr(module, "__all__", ()))
    assert not public - documented
    for _, name in directives:
        assert name.startswith("gearcad.")


@pytest.mark.long
def test_manual_is_built_without_a_warning_and_offline(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    build = pytest.importorskip("sphinx.cmd.build", reason="the extra docs is not installed")

    def refuse(*address: object) -> None:
        raise AssertionError(f"the network is asked for: {address}")

    monkeypatch.setattr(socket.socket, "connect", refuse)
    monkeypatch.setattr(sys, "path", [*sys.path])
    assert build.main(["-W", "-q", "-d", str(tmp_path / "trees"), str(DOCS), str(tmp_path / "manual")]) == 0
    for page in (tmp_path / "manual").rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        assert not re.findall(r"<(?:script|link|img|iframe)[^>]*(?:src|href)=\"(?:https?:)?//[^\"]*", text), page
    for sheet in (tmp_path / "manual").rglob("*.css"):
        assert not re.findall(r"url\([\"']?(?:https?:)?//[^)]*", sheet.read_text(encoding="utf-8")), sheet
    index = (tmp_path / "manual" / "searchindex.js").read_text(encoding="utf-8")
    assert '"commands/build"' in index


def _directives(page: str, name: str) -> list[str]:
    return re.findall(rf"^```{{{name}}} (\S+)$", (DOCS / page).read_text(encoding="utf-8"), re.MULTILINE)


def _shown() -> dict[str, set[str]]:
    """What is shown of each key, its table's name left out: the words of a field, by its key."""
    found: dict[str, set[str]] = {}
    for table, fields in key_tables().items():
        for key, field in fields.items():
            full = f"transient.{key}" if table == "dynamics.transient" else key
            full = f"{table.partition('.')[2]}.{key}" if table in ("planetary.carrier", "planetary.pre_stage") else full
            found.setdefault(full, set()).add(_said(field))
    return found


def _said(field: FieldSchema) -> str:
    return f"{field.symbol.words} {field.symbol.symbol} {permitted(field.name, field)}"


def _all_keys() -> Iterator[tuple[str, str, FieldSchema]]:
    for kind in (FIELDS, PLANETARY, TRAIN):
        for table, fields in kind.items():
            for key, field in fields.items():
                yield table, key, field


def test_every_table_of_keys_is_shown_once() -> None:
    shown = _directives("keys.md", "keys")
    assert sorted(shown) == sorted(key_tables())


def test_every_key_is_shown_as_its_schema_says_it() -> None:
    """Keys of a gear that stand behind `pre_stage.pinion.`, `material.` or in another table are shown with their own table."""
    shown = _shown()
    missing = []
    for table, key, field in _all_keys():
        parts = key.split(".")
        tails = [".".join(parts[first:]) for first in range(len(parts))]
        if not any(_said(field) in shown.get(tail, ()) for tail in tails):
            missing.append(f"{table}.{key}")
    assert not missing


def test_every_result_is_shown_once() -> None:
    assert sorted(_directives("results.md", "results")) == sorted(result_tables())
    nested = [each for name in symbols.__all__ if isinstance(each := getattr(symbols, name), dict)]
    assert all(table in result_tables().values() for table in nested if "inertia" not in table)


def test_shared_keys_of_pairs_are_those_that_the_page_does_not_name() -> None:
    text = (DOCS / "keys.md").read_text(encoding="utf-8")
    assert "Any of these but the number of teeth, the profile shift, tip and root diameter and the cutter" in " ".join(
        text.split()
    )
    gears = [
        key
        for name in (
            "gear",
            "gear.rack",
            "gear.cutter",
            "gear.premachining",
            "gear.finishing",
            "gear.making",
            "gear.double_helix",
            "gear.body",
            "gear.modification",
        )
        for key in key_tables()[name]
    ]
    own = {key for key in gears if key not in SHARED}
    assert own == {"name", "teeth", "profile_shift", "tip_diameter", "root_diameter"} | set(key_tables()["gear.cutter"])


@pytest.mark.parametrize(
    ("table", "key", "expected"),
    [
        ("gear", "teeth", ("whole, 3 to 2000, or −2000 to −10: internal gear", "must be given")),
        ("gear", "normal_module", ("0.01 to 200", "must be given, or `normal_diametral_pitch`")),
        ("gear", "face_width", ("above 0 to 10000", "must be given")),
        ("gear", "profile_shift", ("−5 to 5, or `auto` (pairs)", "0")),
        ("gear.rack", "rack.root_radius", ("0 to 5, or `full`", "0.38")),
        ("gear.body", "body.bolt_holes", ("whole, 0 or 1 to 1000", "0")),
        ("gear.body", "body.hub_side", ("`front`, `back`, `both`", "`front`")),
        ("load", "torque", ("0, or 1e-9 to 1e9 with either sign".replace("-", "−"), "must be given")),
        ("check", "convergence", ("`on`, `off`", "`on`")),
        ("rating", "stiffening", ("`true`, `false`", "`false`")),
        ("train.mesh", "pair", ("name of a file", "none")),
    ],
)
def test_what_can_stand_at_a_key(table: str, key: str, expected: tuple[str, str]) -> None:
    field = key_tables()[table][key]
    assert (permitted(key, field), default(table, key, field)) == expected


def test_default_of_a_field_is_that_of_its_class() -> None:
    from gearcad.dynamics.options import DynamicsOptions
    from gearcad.geometry import Gear

    for kind, made in ((DynamicsOptions, DynamicsOptions()), (Gear, Gear(teeth=20, normal_module=2, face_width=10))):
        for name, field in schema_of(kind).items():
            if not (field.required or field.optional):
                assert getattr(made, name) == field.default, name


def test_gallery_page_has_all_its_designs(tmp_path):
    """The page is what its script writes; each of thirty specs is a design with a picture, a spec and a STEP file."""
    gallery = runpy.run_path(str(DOCS / "figures" / "gallery.py"))
    page = (DOCS / "gallery.md").read_text(encoding="utf-8")
    assert page == gallery["page"]()
    assert set(re.findall(r"/figures/made/([\w.-]+)", page)) == set(gallery["FIGURES"])
    designs = [gearcad.read(spec) for spec in gallery["write_specs"](tmp_path)]
    assert len(designs) == len(set(gallery["NAMES"])) == 30
    assert {design.kind.value for design in designs} == {"gear", "pair", "rack", "rack_pair", "planetary", "train"}
