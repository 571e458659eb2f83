"""Small design tables, tables of real variants, and what can be told of the folder that a batch has made of one."""

import csv
import hashlib
import json
import random
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import openpyxl
import pytest

from gearcad import SpecError
from gearcad.designs import open_table
from gearcad.designs.reader import design_from_tables
from gearcad.designs.table import DesignRow

GEARS = ("name,teeth,normal_module,face_width,helix_angle", "spur,12,1,2,", "left,17,1,3,-15", "right,23,0.8,2.5,10")
"""Three gears that cost little in any format."""

PAIRS = (
    "name,normal_module,helix_angle,pinion.teeth,wheel.teeth,pinion.profile_shift,pinion.face_width,wheel.face_width",
    "slow,1,,12,23,0.4,2,2",
    "skew,1,12,14,15,0.1,3,2",
)

MIXED = (
    "name,gear.teeth,gear.normal_module,gear.face_width,gear.profile_shift,"
    "pair.normal_module,pair.centre_distance,pinion.teeth,wheel.teeth,pinion.face_width,wheel.face_width,wheel.profile_shift,"
    "load.torque",
    "zeta,,,,,2,40,17,22,8,8,auto,-3.5",
    "alpha,20,1.5,6,-0.12,,,,,,,,",
    "mu,,,,,1,,12,30,2,2,-0.2,",
)
"""A pair with a shift to be derived, a gear, and a pair; not in the order of the alphabet."""


def write_table(path: Path, lines: Iterable[str]) -> Path:
    """A table of the given lines."""
    path.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
    return path


def rows_of(lines: Iterable[str]) -> list[dict[str, str]]:
    """The rows of a table by its headings, blank cells left out."""
    return [{key: cell for key, cell in row.items() if cell} for row in csv.DictReader(lines)]


def read_results(folder: Path) -> list[dict[str, str]]:
    """The lines of results.csv as they are written, blank cells too."""
    with (folder / "results.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def made_now(folder: Path) -> list[str]:
    """Names of the rows that the last run has worked on: the others have no seconds."""
    return [line["name"] for line in read_results(folder) if line["seconds"]]


def snapshot(folder: Path) -> dict[str, str]:
    """A digest of every file below `folder` and the names of all folders; the seconds in the tables of results left out."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        if path.is_dir():
            found[name] = "folder"
        elif name == "results.csv":
            found[name] = repr([row | {"seconds": ""} for row in read_results(folder)])
        elif name == "results.parquet":
            found[name] = _parquet_without_seconds(path)
        else:
            found[name] = hashlib.sha256(path.read_bytes()).hexdigest()
    return found


def _parquet_without_seconds(path: Path) -> str:
    from pyarrow.parquet import read_table

    table = read_table(path).drop_columns(["seconds"])
    return f"{table.to_pylist()} {table.schema}"


def times(folder: Path) -> dict[str, int]:
    """When each file of the rows was written (ns): a file that was made again, even with the same bytes, has a new time."""
    return {path.relative_to(folder).as_posix(): path.stat().st_mtime_ns for path in folder.glob("*/*")}


_ENDS = {"step": b"END-ISO-10303-21;\n", "dxf": b"EOF\n", "json": b"}\n", "csv": b"\n", "html": b"</html>"}


def lies(folder: Path) -> list[str]:
    """What the manifests below `folder` say that is not so: files that are missing, torn, or of another size."""
    found = []
    for manifest in folder.glob("*/manifest.json"):
        for part in json.loads(manifest.read_bytes())["parts"].values():
            for name, size in part["files"].items():
                found += [f"{manifest.parent.name}/{name}: {fault}" for fault in _faults(manifest.parent / name, size)]
    return found


def _faults(path: Path, size: int) -> list[str]:
    if not path.is_file():
        return ["missing"]
    content = path.read_bytes()
    if len(content) != size:
        return [f"{len(content)} bytes, not {size}"]
    if path.suffix == ".stl":
        triangles = int.from_bytes(content[80:84], "little")
        return [] if len(content) == 84 + 50 * triangles else [f"{triangles} triangles in {len(content)} bytes"]
    return [] if content.endswith(_ENDS[path.suffix[1:]]) else ["torn"]


SHEET_GEARS = "name,teeth,normal_module,face_width\n"
GOOD = "good,20,2,10\n"

ERROR = "is an error of the spreadsheet; mend the formula and save again"
"""What a message says of a cell such as #N/A."""


def sheet_rows_of(content: str | bytes, name: str = "t.csv") -> list[DesignRow]:
    """The rows of a file with this content."""
    Path(name).write_bytes(content.encode() if isinstance(content, str) else content)
    return list(open_table(name).rows())


def values_of(content: str | bytes) -> list[Any]:
    """The values of the rows, in the order of the columns, without their keys."""
    return [list(row.values.values()) for row in sheet_rows_of(content)]


def faults_of(content: str | bytes, name: str = "t.csv") -> list[str]:
    """All faults of all rows."""
    return [fault for row in sheet_rows_of(content, name) for fault in row.all_faults()]


def refusal_of(content: str | bytes, name: str = "t.csv") -> str:
    """Why the file is no table."""
    with pytest.raises(SpecError) as caught:
        sheet_rows_of(content, name)
    return str(caught.value)


def workbook(rows: list[list[Any]], name: str = "t.xlsx") -> Path:
    """A workbook with these rows in its only sheet."""
    book = openpyxl.Workbook()
    sheet = book.active
    assert sheet is not None
    for row in rows:
        sheet.append(row)
    book.save(name)
    return Path(name)


HEADING = "name,normal_module,helix_angle,pinion.teeth,pinion.profile_shift,pinion.face_width,pinion.body.bore,"
HEADING += "wheel.teeth,wheel.profile_shift,wheel.face_width,wheel.body.bore"


def variants(count: int) -> list[str]:
    """The lines of a table with `count` pairs that can be made; the same ones each time."""
    chance = random.Random(1)
    rows: list[str] = []
    while len(rows) < count:
        pair, pinion, wheel = _draw(chance)
        try:
            tables = {"pair": pair, "pinion": pinion, "wheel": wheel}
            design_from_tables(tables, where=lambda _key: "", default_name="any")
        except SpecError:
            continue
        cells = [f"v{len(rows) + 1:04d}", *_values(pair, pinion, wheel)]
        rows.append(",".join(cells))
    return [HEADING, *rows]


def _draw(chance: random.Random) -> tuple[dict[str, float], ...]:
    module = chance.choice([1.5, 2.5, 4.0])
    pair = {"normal_module": module, "helix_angle": chance.choice([0.0, 10.0, 15.0, 20.0, 25.0, 30.0])}
    smaller = chance.randint(12, 40)
    teeth = (smaller, chance.randint(smaller, 60))
    shifts = (round(chance.uniform(0.3 if smaller < 17 else 0.0, 0.6), 2), round(chance.uniform(-0.3, 0.3), 2))
    gears = (
        {"teeth": z, "profile_shift": x, "face_width": 8 * module, "body.bore": round(0.4 * module * z, 1)}
        for z, x in zip(teeth, shifts, strict=True)
    )
    return (pair, *gears)


def _values(*tables: dict[str, float]) -> Iterator[str]:
    for table in tables:
        yield from map(str, table.values())
