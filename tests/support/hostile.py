"""Specs with a value in them that nobody should write: what a command may do with them is say so in one line."""

import copy
import csv
import io
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import fields
from datetime import date
from typing import Any

from click.testing import CliRunner, Result
from hypothesis import strategies as st

from gearcad.cli import main
from gearcad.designs.keys import KEYS
from gearcad.designs.reader import starter_text
from gearcad.designs.train_keys import PLANETARY
from gearcad.dynamics.trains.members import Inertia, Shaft, ToothMesh

LONGEST_LINE = 1500
"""Characters of the longest message: one that lists every permitted key."""

NUMBERS = (
    *(0, -1, 1, 2**53 + 1, 10**16, 10**400, -(10**400)),
    *(0.0, 0.5, 1e-300, 5e-324, 1e-9, 1e9, 1e16, 1e300, -1e300, float("inf"), float("nan")),
    16**5000,
)
"""The last is too long for Python to write."""

WORDS = ("", " ", "auto", "on", "3d", "ground", "x" * 3000, "\x1b[31mred", "a\nb", "\0", "\u202eabc", "µ", "\U0001f600")
OTHERS = (
    True,
    date(2020, 2, 30 - 1),
    [],
    {},
    {"a": 1},
    [[]],
    [1, "a"],
    [{}],
    [10**400],
    [1e300, 1e300],
    [{"name": "x" * 3000}],
)

CHEAP = {"positions": 12, "refinement": 0.25, "convergence": "off", "body_teeth": 3, "torques": [100.0]}
"""A check that takes a second."""

_PARTS = {"inertia": Inertia, "shaft": Shaft, "mesh": ToothMesh}
_DESIGNS = ("fzg-c", "volvo-13-44", "spur", "uhlir-19-23", "rack")
_PLANETARY = ("planetary-24-21-66", "planetary-alm", "planetary-differential")
_TRAINS = ("train-1-stage", "train-2-stage")


def _nested(depth: int) -> list[Any]:
    value: list[Any] = []
    for _ in range(depth):
        value = [value]
    return value


def hostile_values() -> st.SearchStrategy[Any]:
    return st.one_of(
        st.sampled_from(NUMBERS),
        st.sampled_from(WORDS),
        st.sampled_from(OTHERS),
        st.sampled_from([_nested(depth) for depth in (50, 150, 500)]),
        st.text(st.characters(codec="utf-8"), max_size=20),
        st.floats(),
        st.integers(),
    )


def _places(content: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """The way to every value and every table of a spec."""
    if path:
        yield path
    if isinstance(content, Mapping):
        for key, inner in content.items():
            yield from _places(inner, (*path, key))
    elif isinstance(content, list) and content and isinstance(content[0], Mapping):
        for number, inner in enumerate(content):
            yield from _places(inner, (*path, number))


def _more_places(tables: Mapping[str, Any]) -> Iterator[tuple[Any, ...]]:
    """The way to every key that a spec might have."""
    if "train" in tables:
        for key, kind in _PARTS.items():
            yield from (("train", key, 0, field.name) for field in fields(kind))
        yield from (("dynamics", key) for key in KEYS["dynamics"])
        return
    if "planetary" in tables:
        yield from ((table, *key.split(".")) for table, known in PLANETARY.items() for key in known)
        return
    for table in tables:
        yield from ((table, *key.split(".")) for key in KEYS.get(table, ()))
    yield from ((table, key) for table in ("check", "mounting", "dynamics", "load") for key in KEYS[table])


def put(tables: dict[str, Any], path: tuple[Any, ...], value: Any) -> None:
    """Set a value of a spec, in tables that are made where they are missing."""
    inner: Any = tables
    for step in path[:-1]:
        if isinstance(inner, dict) and not isinstance(inner.get(step), dict | list):
            inner[step] = {}
        inner = inner[step]
    inner[path[-1]] = value


@st.composite
def hostile_specs(draw: st.DrawFn, *, trains: bool = False, planetary: bool = False) -> str:
    """A starter with one or two values replaced or added, and now and then a key that nobody knows."""
    starters = _TRAINS if trains else _PLANETARY if planetary else _DESIGNS
    tables = tomllib.loads(starter_text(draw(st.sampled_from(starters)))[1])
    for _ in range(draw(st.integers(1, 2))):
        places = sorted({*_places(tables), *_more_places(tables)}, key=str)
        path = draw(st.sampled_from(places))
        if draw(st.integers(0, 5)) == 0:
            path = (*path[:-1], draw(st.sampled_from(WORDS))) if isinstance(path[-1], str) else path
        try:
            put(tables, path, copy.deepcopy(draw(hostile_values())))
        except (TypeError, IndexError, AttributeError, KeyError):
            continue  # the first change has taken its place away
    return toml_text(tables)


@st.composite
def hostile_rows(draw: st.DrawFn) -> str:
    """A table of pairs with some cells replaced or added, a heading among them now and then."""
    rows = [
        ["name", "pair.normal_module", "pinion.teeth", "wheel.teeth", "pinion.face_width", "wheel.face_width", "load.torque"],
        ["a", "2", "17", "23", "20", "20", "10"],
        ["b", "1", "12", "30", "9", "8", "3"],
    ]
    for _ in range(draw(st.integers(1, 3))):
        row = draw(st.sampled_from(rows))
        cell = draw(st.sampled_from([*WORDS, *map(str, NUMBERS[:-1])]) | st.text(max_size=20))
        place = draw(st.integers(0, len(row)))
        row[place : place + 1] = [cell]
    text = io.StringIO()
    csv.writer(text).writerows(rows)
    return text.getvalue().encode("utf-8", "replace").decode()


@st.composite
def physical_specs(draw: st.DrawFn, base: Mapping[str, Any], keys: tuple[tuple[Any, ...], ...]) -> str:
    """A spec with physical values of any size, most of them permitted."""
    tables = copy.deepcopy(dict(base))
    for path in draw(st.lists(st.sampled_from(keys), min_size=1, max_size=2, unique=True)):
        put(tables, path, draw(st.integers(-12, 12).map(lambda power: 10.0**power) | st.sampled_from([0.0, -1.0, 3e6, 1e300])))
    return toml_text(tables)


def run_politely(*arguments: str) -> Result:
    """Run a command in this process; whatever it is asked, it answers with a status, and with one line where it refuses."""
    result = CliRunner().invoke(main, list(arguments), prog_name="gearcad")
    assert isinstance(result.exception, SystemExit | None), repr(result.exception)
    assert result.exit_code in (0, 1, 2)
    assert "fault of gearcad" not in result.stderr and "Traceback" not in result.output
    assert "RuntimeWarning" not in result.stderr
    errors = [line for line in result.stderr.splitlines() if line.startswith("Error: ")]
    assert len(errors) == (1 if result.exit_code == 2 else len(errors)) <= 1
    if result.exit_code == 2:
        assert len(result.stderr.splitlines()) == 1
    assert all(line.isprintable() and len(line) < LONGEST_LINE for line in result.stderr.splitlines())
    return result


def toml_text(tables: Mapping[str, Any]) -> str:
    """Tables as TOML: every key in a line of its own, what is inside as inline tables."""
    lines = [f"{_key(table)} = {_value(content)}" for table, content in tables.items() if not isinstance(content, Mapping)]
    for table, content in tables.items():
        if isinstance(content, Mapping):
            lines += [f"[{_key(table)}]", *(f"{_key(key)} = {_value(value)}" for key, value in content.items())]
    return "\n".join([*lines, ""])


def _key(key: str) -> str:
    return _quoted(key)


def _quoted(text: str) -> str:
    return '"' + "".join(f"\\U{ord(each):08x}" if each in '"\\' or not each.isprintable() else each for each in text) + '"'


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_key(key)} = {_value(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    if isinstance(value, int):
        return hex(value) if value >= 2**64 else str(value)
    return str(value)
