"""Tables of results on the page: the design of a row is the one that the row was made of."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from gearcad.batch.row import Record, Status, flat_document
from gearcad.batch.run import write_results
from gearcad.core.errors import SpecError
from gearcad.designs.cells import Decimal
from gearcad.designs.design import Design
from gearcad.designs.reader import starter_text
from gearcad.designs.table import DesignRow, open_table
from gearcad.page.panels.table import MOST_ROWS, ResultsTable, read_results
from gearcad.page.run_process import design_of

FIGURES = {"check": {"passed": True, "contact_pressure": 1000.5}, "rate": {"S_H": {"pinion": 1.25}, "strength": "passed"}}


class _Journal:
    """Rows that a batch would have made, without its files."""

    def __init__(self, table: Path) -> None:
        self.designs: dict[str, Design] = {row.name: row.design() for row in open_table(table).rows()}
        self._table = table

    def results(self) -> Iterator[tuple[DesignRow, Record]]:
        for row in open_table(self._table).rows():
            values = dict(flat_document(self.designs[row.name].to_dict() | FIGURES))
            yield row, Record(number=row.number, status=Status.OK, seconds=0.5, files=("data.json",), values=values)


def _results(folder: Path, text: str, decimal: Decimal = Decimal.POINT) -> tuple[_Journal, ResultsTable]:
    (folder / "table.csv").write_text(text, encoding="utf-8")
    journal = _Journal(folder / "table.csv")
    write_results(journal, folder, folder, decimal)
    return journal, read_results((folder / "results.csv").read_text(encoding="utf-8-sig"), "results.csv")


@pytest.mark.parametrize(
    ("starter", "decimal"),
    [
        ("pairs", Decimal.COMMA),
        ("gears", Decimal.POINT),
        ("rings", Decimal.POINT),
        ("planetary-sets", Decimal.POINT),
    ],
)
def test_rows_of_starters_give_their_designs_again(tmp_path: Path, starter: str, decimal: Decimal) -> None:
    journal, table = _results(tmp_path, starter_text(starter)[1], decimal)
    assert [table.called(number) for number in table.rows] == list(journal.designs)
    for number in list(table.rows)[:2]:
        design = design_of(table.spec(number, tmp_path), "mine", tmp_path)
        assert design == journal.designs[design.name]


def test_what_is_automatic_and_what_names_as_derived_ones_do_stays_an_input(tmp_path: Path) -> None:
    text = (
        "name,load.torque,pair.normal_module,pair.centre_distance,pinion.teeth,wheel.teeth,pinion.profile_shift,"
        "wheel.profile_shift,pair.face_width,pinion.tip_diameter,load.speed,wheel.tooth_allowance\n"
        "a,20,2,52,20,31,0.3,auto,20,44.5,1500,cd25\n"
        "b,30,2,52,20,31,auto,auto,22,,,\n"
        "=c,30,2,52,20,31,auto,auto,22,,,\n"
    )
    journal, table = _results(tmp_path, text)
    for number in table.rows:
        spec = table.spec(number, tmp_path)
        assert design_of(spec, "mine", tmp_path).to_dict() == journal.designs[table.called(number)].to_dict()
    assert [table.called(number) for number in table.rows] == ["a", "b", "=c"]
    assert "tip_diameter = 44.5" in table.spec(2, tmp_path) and "tip_diameter" not in table.spec(3, tmp_path)
    assert "speed = 1500.0" in table.spec(2, tmp_path)


def test_columns_of_numbers_and_their_points(tmp_path: Path) -> None:
    _, table = _results(tmp_path, starter_text("pairs")[1])
    assert {"pair.total_contact_ratio", "check.contact_pressure", "rate.S_H.pinion", "pinion.teeth"} <= set(table.numbers)
    assert not {"name", "status", "files.data.json", "rate.strength"} & set(table.numbers)
    points = dict(table.points("pinion.teeth", "check.contact_pressure"))
    assert points == {number: (float(points[number][0]), 1000.5) for number in table.rows}


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("", "no table of results"),
        ("name,pinion.teeth\na,20\n", "no column status"),
        ("status,pinion.teeth\nok,20\n", "no column name"),
        ("name,status\na,failed\n", "no row is ok"),
        ("name,status\na,ok,surplus\n", "no row is ok"),
        ("name,status\n" + "a,ok\n" * (MOST_ROWS + 1), "more than 50000 rows"),
    ],
)
def test_what_is_no_table_of_results(text: str, fault: str) -> None:
    with pytest.raises(SpecError, match=fault):
        read_results(text, "results.csv")


@pytest.mark.parametrize(
    "row",
    [
        "../a,ok,,20,2,20",
        "a,ok,,2,2,20",
        "a,ok,,<script>,2,20",
        "a,ok,,20,2,",
    ],
)
def test_rows_that_make_no_design_say_so(row: str, tmp_path: Path) -> None:
    heading = "name,status,files.data.json,gear.teeth,gear.normal_module,gear.face_width\n"
    with pytest.raises(SpecError, match="no longer makes a design"):
        read_results(heading + row + "\n", "results.csv").spec(2, tmp_path)


def test_a_row_names_no_file_outside_the_folder(tmp_path: Path) -> None:
    heading = "name,status,gear.teeth,gear.normal_module,gear.face_width,drawing.template\n"
    table = read_results(heading + "a,ok,20,2,20,../../etc/passwd\n", "results.csv")
    with pytest.raises(SpecError, match="must be a file in the folder of the page"):
        table.spec(2, tmp_path)


@pytest.mark.parametrize("columns", [("a", "gear.tip_diameter"), ("gear.tip_diameter", "a"), ("a", "b"), ("a",)])
def test_two_columns_are_looked_at_first_where_there_are_two(columns: tuple[str, ...]) -> None:
    pytest.importorskip("nicegui")
    from gearcad.page.panels.table import first_columns

    x, y, colour = first_columns(ResultsTable("results.csv", columns, {2: ["1"] * len(columns)}))
    assert {x, y} == set(columns) and colour == ""
