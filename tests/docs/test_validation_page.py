"""The validation page shows what tests know of published values, each once, and nothing that no test knows."""

import ast
import json
from pathlib import Path

import pytest
from manual.validated import CHAPTERS, counts_text, rows, table_text
from support.published import FILE, Row, found_text

TESTS = Path(__file__).parents[1]
DOCS = TESTS.parent / "docs"


def _judges() -> set[str]:
    """Tests that take `published`, as rows name them."""
    found = set()
    for file in TESTS.rglob("test_*.py"):
        text = file.read_text(encoding="utf-8")
        if "published: Published" in text:
            tests = [
                each for each in ast.parse(text).body if isinstance(each, ast.FunctionDef) and each.name.startswith("test_")
            ]
            found |= {f"{file.name}::{test.name}" for test in tests if "published" in [given.arg for given in test.args.args]}
    return found


def test_rows_and_tests_belong_to_each_other() -> None:
    shown = {row.test for row in rows()}
    assert shown == _judges() and len(shown) > 20
    keys = [(row.test, row.source, row.of, row.quantity) for row in rows()]
    assert len(keys) == len(set(keys))


def test_every_row_is_in_one_chapter_and_every_chapter_on_the_page() -> None:
    page = (DOCS / "validation.md").read_text(encoding="utf-8")
    assert sum(len(rows(chapter)) for chapter in CHAPTERS) == len(rows()) == len(json.loads(FILE.read_text(encoding="utf-8")))
    for chapter in CHAPTERS:
        assert f"```{{validation}} {chapter}\n" in page
        assert table_text(chapter).count("| ± ") == len(rows(chapter)) > 0


def test_what_is_shown_is_within_what_is_permitted() -> None:
    for row in rows():
        last = 10.0 ** -len(row.found.partition(".")[2])
        assert row.deviation <= row.within * 1.001 + last / 2, row
    assert counts_text().startswith(f"{len(rows())} values of ")


@pytest.mark.parametrize(
    ("found", "printed", "within", "text"),
    [
        (1.2345678, "1.23", 0.005, "1.2346"),
        (17.855842, "17.85584", 5e-6, "17.85584"),
        (-124.2807, "-124.28", 0.005, "-124.2807"),
        (2.4, "2", 0.5, "2.40"),
        (0.02681974, "0.0268197", 5e-8, "0.0268197"),
        (356.78123, "357.98", 3.9, "356.781"),
    ],
)
def test_found_values_have_two_digits_more(found: float, printed: str, within: float, text: str) -> None:
    assert found_text(found, printed, within) == text


def test_a_row_is_the_same_but_for_what_another_mesher_does() -> None:
    row = Row("book", "", "c", "357.98", "356.781", 3.9, "test_a.py::test_b")
    assert row.same(row._replace(found="356.500")) and not row.same(row._replace(found="356.300"))
    exact = row._replace(published="16.83", found="16.8258", within=0.005)
    assert exact.same(exact._replace(found="16.8259")) and not exact.same(exact._replace(found="16.8264"))
    assert not exact.same(exact._replace(published="16.82"))
