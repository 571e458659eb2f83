"""What stands in a manifest: of which inputs and which gearcad the files are; and no harm comes of one that lies."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from support.batches import GEARS, made_now, snapshot, write_table

import gearcad
from gearcad.batch import run_table
from gearcad.batch.row import MANIFEST, Manifest, RowPart, inputs_hash, read_manifest
from gearcad.jobs.build import Build
from gearcad.solids import Format

pytestmark = pytest.mark.usefixtures("kept_workers")

POINTS = (Build(formats=(Format.CSV,)),)


def test_manifest_names_gearcad_the_parts_and_every_file_with_its_size(tmp_path: Path) -> None:
    run_table(write_table(tmp_path / "table.csv", GEARS[:2]), tmp_path / "out", POINTS, jobs=1)
    folder = tmp_path / "out" / "spur"
    document = json.loads((folder / "manifest.json").read_text())
    assert len(document.pop("inputs")) == 64
    assert document == {
        "gearcad": gearcad.__version__,
        "parts": {
            "csv": {"options": {}, "files": {"gear.csv": (folder / "gear.csv").stat().st_size}},
            "data": {"options": {}, "files": {"data.json": (folder / "data.json").stat().st_size}},
        },
    }


def test_files_may_be_called_as_gears_are(tmp_path: Path) -> None:
    """Else every run would make them again, and none would remove what a changed row has no longer."""
    names = ("drawing-assembly.dxf", "drawing-rim_3.pdf", "S1.step", "Großrad (2).step")
    manifest = Manifest("x", {"draw": RowPart({}, dict.fromkeys(names, 7))})
    (tmp_path / MANIFEST).write_text(manifest.text(), encoding="utf-8")
    assert read_manifest(tmp_path) == manifest
    for name in ("../x.dxf", "a/b.dxf", "a\\b.dxf", ".hidden.dxf", "C:x.dxf", "a\ud800.dxf", "a\x00.dxf", "a.dxf/"):
        (tmp_path / MANIFEST).write_text(Manifest("x", {"draw": RowPart({}, {name: 7})}).text(), encoding="utf-8")
        assert read_manifest(tmp_path) is None, name


def test_hash_is_of_the_inputs_whatever_their_order() -> None:
    assert inputs_hash({"name": "a", "gear.teeth": 20}) == inputs_hash({"gear.teeth": 20, "name": "a"})
    others = [{"name": "a", "gear.teeth": 21}, {"name": "b", "gear.teeth": 20}, {"name": "a", "wheel.teeth": 20}, {"name": "a"}]
    assert len({inputs_hash(inputs) for inputs in others} | {inputs_hash({"name": "a", "gear.teeth": 20})}) == 5


def test_hash_is_of_the_source_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A checkout changes under one version."""
    monkeypatch.chdir(tmp_path)  # Python looks for packages here first
    copy = Path(shutil.copytree(Path(gearcad.__file__).parent, tmp_path / "gearcad"))

    def hash_there() -> str:
        code = "from gearcad.batch.row import MANIFEST, Manifest, RowPart, inputs_hash, read_manifest; print(inputs_hash({}))"
        environment = os.environ | {"PYTHONPATH": str(tmp_path)}
        return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment).stdout

    found = [hash_there()]
    assert found[0].strip() == inputs_hash({})
    for change in ("designs/keys.py", "solids/new.py"):
        with (copy / change).open("a") as file:
            file.write("# another comment\n")
        found.append(hash_there())
    assert len(set(found)) == 3


# ---------------------------------------------------------------------- manifests that lie


def _edited(**changes: Any) -> Callable[[dict[str, Any]], str]:
    return lambda document: json.dumps(document | changes)


def _listing(file: Any, size: Any = 5, *, unfinished: bool = False) -> Callable[[dict[str, Any]], str]:
    """A manifest that lists a file as finished; with `unfinished` as one to be removed, and of other inputs."""

    def edit(document: dict[str, Any]) -> str:
        if unfinished:
            return json.dumps(document | {"inputs": "other", "unfinished": [file]})
        document["parts"]["csv"]["files"] = {file: size}
        return json.dumps(document)

    return edit


LIES: dict[str, Callable[[dict[str, Any]], str | bytes]] = {
    "binary": lambda _: os.urandom(1000),
    "utf-16": lambda document: json.dumps(document).encode("utf-16"),
    "a list": lambda _: "[]",
    "deep": lambda _: "[" * 100_000,
    "no parts": lambda document: json.dumps({"inputs": document["inputs"]}),
    "parts are a list": _edited(parts=["csv"]),
    "parts are null": _edited(parts=None),
    "options are a number": _edited(parts={"csv": {"options": 5, "files": {}}}),
    "files are a text": _edited(parts={"csv": {"options": {}, "files": "gear.csv"}}),
    "unfinished is a number": _edited(unfinished=5),
    "unfinished holds a list": _edited(unfinished=[["gear.csv"]]),
    "infinite size": _listing("gear.csv", float("inf")),
    "size is a text": _listing("gear.csv", "many"),
    "another size": _listing("gear.csv", 12),
    "other inputs": _edited(inputs="x"),
    **{
        f"lists {file[:8]!a}": _listing(file)
        for file in ("../../x", "/etc/hostname", "..", ".", "", "a\0b", "\ud800", "x" * 999)
    },
    **{
        f"gave up {file[:8]!a}": _listing(file, unfinished=True)
        for file in (
            "../../precious",
            "..",
            ".",
            "",
            "a\0b",
            "\ud800",
            "x" * 999,
            "notes",
            "sub",
            "manifest.json",
            "a/b",
            "a\\b",
        )
    },
}


def test_manifest_that_cannot_be_believed_does_no_harm(tmp_path: Path) -> None:
    """Each lie in a row of its own, beside files and folders of the user."""
    rows = {f"row {number}": lie for number, lie in enumerate(LIES)}
    lines = (GEARS[0], *(f"{name},{12 + n % 9},1,2," for n, name in enumerate(rows)))
    table = write_table(tmp_path / "table.csv", lines)
    run_table(table, tmp_path / "out", POINTS, jobs=1)
    before = snapshot(tmp_path / "out")
    own = [tmp_path / "precious", *(tmp_path / "out" / name / file for name in rows for file in ("notes", "sub/x"))]
    for path in own:
        path.parent.mkdir(exist_ok=True)
        path.write_text("kept")
    for name, lie in rows.items():
        manifest = tmp_path / "out" / name / "manifest.json"
        told = LIES[lie](json.loads(manifest.read_text()))
        manifest.write_bytes(told if isinstance(told, bytes) else told.encode("utf-8", "surrogatepass"))
    assert run_table(table, tmp_path / "out", POINTS, jobs=1).errors == ()
    assert [lie for name, lie in rows.items() if name not in made_now(tmp_path / "out")] == []
    assert [path for path in own if path.read_text() != "kept"] == []
    after = snapshot(tmp_path / "out")
    assert {name: content for name, content in after.items() if name in before} == before
    assert {name for name in after if name not in before} == {
        f"{name}/{own}" for name in rows for own in ("notes", "sub", "sub/x")
    }
