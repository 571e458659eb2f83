"""gearcad rate: exit statuses, screen, documents and pages of pairs, racks and planetary trains; columns of tables."""

import csv
import json
from pathlib import Path

import lxml.html
import pytest
from click.testing import CliRunner, Result

from gearcad import read
from gearcad.batch import BatchSummary
from gearcad.batch.run import falls_short
from gearcad.cli import main
from gearcad.core.runtime import templates
from gearcad.designs.variations import column_symbol
from gearcad.jobs.strength import Rate, rate_columns

REDUCER = (templates() / "reducer-21-43.toml").read_text(encoding="utf-8")


@pytest.fixture(autouse=True)
def _no_reports(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pictures take longer than all else."""
    monkeypatch.setattr("gearcad.jobs.strength._write_report", lambda _result, _name, _head, path: path.write_text(""))


def run(spec: Path, *options: str) -> Result:
    return CliRunner().invoke(main, ["rate", str(spec), "-o", str(spec.parent / "out"), *options])


def written(folder: Path, *changes: tuple[str, str], text: str = REDUCER) -> Path:
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    spec = folder / "pair.toml"
    spec.write_text(text, encoding="utf-8")
    return spec


def test_a_pair_that_holds(tmp_path: Path) -> None:
    result = run(written(tmp_path))
    assert result.exit_code == 0, result.output
    lines = result.stdout.splitlines()
    assert lines[-3].startswith("reducer-21-43 at 200 N·m, 1450 rpm: strength passed")
    assert any(line.startswith("S_H, flank") for line in lines)
    assert any(line.startswith("load factors    K_A 1  K_gamma 1  K_v 1.04") for line in lines)
    document = json.loads((tmp_path / "out" / "rate.json").read_text(encoding="utf-8"))
    assert (document["kind"], document["strength"], document["passed"]) == ("rate", "passed", True)
    assert document["sources"]["K_v"] == "ISO 6336-1:2006, 6.5 (Method B)"
    assert document["nominal"]["F_t"] == pytest.approx(document["load"]["torque"] * 2000 / 63, rel=1e-12)


@pytest.mark.long
def test_the_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.undo()
    assert run(written(tmp_path)).exit_code == 0
    page = lxml.html.fromstring((tmp_path / "out" / "rate.html").read_text(encoding="utf-8"))
    assert len(page.xpath("//figure//img")) == 4
    assert "Strength passed." in page.text_content()


def test_a_small_part_of_the_width_and_what_a_life_is_of_are_seen(tmp_path: Path) -> None:
    lines = run(written(tmp_path, ("torque = 200.0", "torque = 2.0"))).stdout.splitlines()
    assert any(line.startswith("Warning: K_Hbeta: only 43% of the face width would carry") for line in lines)
    assert sum(line.startswith("  life at the required safety (h)  ") for line in lines) == 2


@pytest.mark.parametrize(
    ("values", "short"),
    [
        ({}, False),
        ({"check.passed": True, "rate.passed": True}, False),
        ({"check.passed": None}, False),
        ({"check.passed": False}, True),
        ({"rate.passed": False}, True),
        ({"rate.passed": None}, True),
        ({"rate.passed": None, "rate.strength": "not judged"}, True),
        ({"rate.passed": None, "rate.strength": "not asked for"}, False),
    ],
)
def test_rows_that_fall_short(values: dict[str, bool | None], short: bool) -> None:
    assert falls_short(values) is short


def test_a_table_with_a_row_that_falls_short(monkeypatch: pytest.MonkeyPatch) -> None:
    summary = BatchSummary(results=(), ok=2, failed=0, not_run=0, short=1, errors=())
    monkeypatch.setattr("gearcad.batch.run_table", lambda *_, **__: summary)
    result = CliRunner().invoke(main, ["batch", "table.csv", "--do", "rate"])
    assert result.exit_code == 1
    assert "2 rows ok, 0 failed, 1 with checks or ratings not passed" in result.stderr


@pytest.mark.parametrize(
    ("change", "words", "status"),
    [
        (("torque = 200.0", "torque = 400.0"), "strength NOT passed: flank of the pinion", 1),
        (("speed = 1450.0", "# speed"), "strength not judged: the speed is 0 rpm", 1),
        (("hardness = 720.0", "hardness = 300.0"), "pair.toml: material.hardness = 300 HV: must be from 660 to 800 HV", 2),
        (("torque = 200.0", "torque = 0.0"), "pair.toml: load.torque = 0 N·m: must not be 0", 2),
        (('quality = "MQ"', 'quality = "MX"'), "quality", 2),
        (("accuracy_grade = 6", "accuracy_grade = 14"), "rating.accuracy_grade = 14: must be", 2),
        (("oil_viscosity_40 = 220.0", "# none"), "oil_viscosity_40 is missing: must be given", 2),
    ],
)
def test_exit_statuses(tmp_path: Path, change: tuple[str, str], words: str, status: int) -> None:
    result = run(written(tmp_path, change), "--json")
    assert result.exit_code == status, result.output
    if status == 2:
        assert words in result.stderr
        assert result.stdout == ""
        assert len(result.stderr.splitlines()) == 1
    else:
        assert words in result.stderr
        document = json.loads(result.stdout)
        assert document["passed"] is (False if document["strength"] == "failed" else None)


def test_columns_of_a_table_are_explained() -> None:
    job = Rate(report=False)
    columns = rate_columns(job.document(job.run(read(templates() / "reducer-21-43.toml"))))
    flat = [f"rate.{key}" for key, value in columns.items() if not isinstance(value, dict)]
    flat += [f"rate.{key}.{gear}" for key, value in columns.items() if isinstance(value, dict) for gear in value]
    assert [key for key in flat if column_symbol(key) is None and key != "rate.warnings"] == []
    assert columns["S_H_min"] == min(columns["S_H"].values())
    assert columns["life_infinite"] is False


def test_a_rack(tmp_path: Path) -> None:
    rack = run(written(tmp_path, text=(templates() / "rack.toml").read_text(encoding="utf-8")))
    assert rack.exit_code == 0
    assert "strength not asked for" in rack.output


@pytest.mark.long
def test_every_mesh_of_a_planetary_train(tmp_path: Path) -> None:
    text = (templates() / "planetary-24-21-66.toml").read_text(encoding="utf-8")
    assert run(written(tmp_path, text=text)).exit_code == 0  # the starter has no quality: nothing is asked for
    spec = written(tmp_path, ('group = "Eh"', 'group = "Eh"\nquality = "MQ"'), text=f"{text}\n[rating]\nlife = 1000.0\n")
    result = run(spec)
    assert result.exit_code == 0, result.output
    document = json.loads((tmp_path / "out" / "rate.json").read_text(encoding="utf-8"))
    assert set(document["meshes"]) == {"sun-planet", "ring-planet"}
    planet = document["meshes"]["sun-planet"]["factors"]["Y_M"]
    assert sorted(planet.values()) == [0.7, 1.0]
    cycles = document["meshes"]["sun-planet"]["load_cycles"]["flank"]
    assert cycles["wheel"] == pytest.approx(cycles["pinion"] * 3 * 21 / 24)  # three planets
    assert (tmp_path / "out" / "rate-sun-planet.html").exists()


@pytest.mark.long
def test_a_study_of_safeties(tmp_path: Path) -> None:
    spec, runner = written(tmp_path), CliRunner()
    table, folder = str(tmp_path / "table.csv"), str(tmp_path / "made")
    assert runner.invoke(main, ["study", str(spec), "--vary", "load.torque=100:200:3", "-o", table]).exit_code == 0
    assert runner.invoke(main, ["batch", table, "--do", "rate", "-o", folder, "-j", "1"]).exit_code == 0
    with (tmp_path / "made" / "results.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    safeties = [float(row["rate.S_H.pinion"]) for row in rows]
    assert safeties == sorted(safeties, reverse=True)
    results = str(tmp_path / "made" / "results.csv")
    found = runner.invoke(main, ["plot", results, "--x", "load.torque", "--y", "rate.S_H_min", "-o", str(tmp_path / "p.png")])
    assert found.exit_code == 0, found.output
