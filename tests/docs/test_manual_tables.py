"""Every key of every spec and every quantity of every result stands in the manual, with what the code says of it."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from gearcad.core import symbols
from gearcad.core.quantities import FieldSchema, schema_of
from gearcad.designs.keys import FIELDS, SHARED
from gearcad.designs.train_keys import PLANETARY, TRAIN

DOCS = Path(__file__).parents[2] / "docs"
sys.path.insert(0, str(DOCS))

from manual.field_words import default, permitted  # noqa: E402
from manual.key_tables import key_tables  # noqa: E402
from manual.result_tables import result_tables  # noqa: E402


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
        for name in ("gear", "gear.rack", "gear.cutter", "gear.double_helix", "gear.body", "gear.modification")
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
