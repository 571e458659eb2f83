"""Comments and places of keys under change: what a field is emptied of and given again stands as it stood."""

from pathlib import Path

import pytest
from support.specs import starter_specs

from gearcad.core.runtime import templates
from gearcad.page.fields import given_texts
from gearcad.page.workbench import Workbench

SPECS = [
    pytest.param(spec, id=spec.stem, marks=[pytest.mark.long] * (number % 3 > 0)) for number, spec in enumerate(starter_specs())
]
"""Every third of the starters; the others take long and have the same keys."""


def _bench(spec: Path) -> Workbench:
    return Workbench(spec.read_text(encoding="utf-8"), spec.stem, templates())


@pytest.mark.parametrize("typed", [{"": 1, "-.": 1}, {"": 1}, {"": 2}], ids=["half typed", "one step", "two steps"])
@pytest.mark.parametrize("spec", SPECS)
def test_a_key_that_is_emptied_and_typed_again_stands_as_it_stood(spec: Path, typed: dict[str, int]) -> None:
    """For every key that has a field; keys after it are emptied and typed again in the same text."""
    bench = _bench(spec)
    text = bench.text
    for key, value in given_texts(bench.tables).items():
        for before, step in typed.items():
            bench.change({key: before}, step)
        bench.change({key: value}, 1)
        assert bench.text == text, key


@pytest.mark.parametrize("spec", SPECS)
def test_another_value_changes_its_own_lines_only(spec: Path) -> None:
    text = _bench(spec).text
    comments = [line.partition("#")[2] for line in text.splitlines()]
    for key in given_texts(_bench(spec).tables):
        bench = _bench(spec)
        for typed in ("", "77"):
            bench.change({key: typed}, 1)
        changed = [(old, new) for old, new in zip(text.splitlines(), bench.text.splitlines(), strict=True) if old != new]
        assert len(changed) == 1 and "77" in changed[0][1], key
        assert [line.partition("#")[2] for line in bench.text.splitlines()] == comments, key


def test_keys_that_are_emptied_one_after_the_other_keep_their_places() -> None:
    bench = _bench(templates() / "reducer-21-43.toml")
    text, given = bench.text, given_texts(bench.tables)
    keys = ["pinion.teeth", "wheel.teeth", "pair.face_width"]
    for key in keys:
        bench.change({key: ""})
    assert not given_texts(bench.tables).keys() & set(keys)
    for key in keys:
        bench.change({key: given[key]})
    assert bench.text == text


def test_a_key_that_is_emptied_is_gone_for_the_text() -> None:
    """What is written into the text afterwards is all there is."""
    bench = _bench(templates() / "reducer-21-43.toml")
    bench.change({"pinion.teeth": ""})
    assert "21" not in bench.text.partition("[pinion]")[2].partition("[wheel]")[0]
    bench.write(bench.text.replace("[pinion]", "[pinion]  # small"), "text")
    bench.change({"pinion.teeth": "22"})
    assert "[pinion]  # small" in bench.text and bench.tables["pinion"]["teeth"] == 22
