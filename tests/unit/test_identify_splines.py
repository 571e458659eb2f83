"""Splines that were measured: the printed rows of DIN 5480-2 are found again, and what tells nothing is refused."""

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from gearcad import SplineJoint
from gearcad.cli import main
from gearcad.core.errors import GeometryError, ParameterError
from gearcad.designs.reader import read_spec
from gearcad.identify import Measurements, SplineIdentification, identify_spline

ROWS = json.loads((Path(__file__).parents[1] / "data" / "splines.json").read_text(encoding="utf-8"))["din5480_inspection"]


def identified(**readings: Any) -> SplineIdentification:
    return identify_spline(Measurements(**readings).measured)


def among_the_best(found: SplineIdentification) -> set[str]:
    return {each.designation for each in (found.best, *found.rivals)}


def test_printed_shafts_are_found() -> None:
    """Tip diameter, span and size over pins as DIN 5480-2 prints them: the size is the one that fits best."""
    for row in ROWS:
        module, diameter = row["module"], row["reference_diameter"]
        pins = {} if row["over_pins"] is None else {"over_pins": {row["shaft_pin"]: row["over_pins"]}}
        tip, span = diameter - 0.2 * module, {row["span_teeth"]: row["span"]}
        found = identified(teeth=row["teeth"], tip_diameter=tip, span=span, **pins)
        assert found.best.designation == f"DIN 5480 - W {diameter:g} x {module:g} x {row['teeth']}", row
        assert found.fits


def test_printed_hubs_are_found_or_among_what_fits_as_well() -> None:
    certain, rows = 0, [row for row in ROWS if row["teeth"] >= 10]  # readings of rings begin there
    for row in rows:
        module, diameter = row["module"], row["reference_diameter"]
        between = {row["hub_pin"]: row["between_pins"]}
        found = identified(teeth=-row["teeth"], tip_diameter=diameter - 2 * module, between_pins=between)
        assert f"DIN 5480 - N {diameter:g} x {module:g} x {row['teeth']}" in among_the_best(found), row
        certain += not found.rivals
    assert certain > len(rows) / 2


@pytest.mark.parametrize(
    ("designation", "part"),
    [
        ("EXT 24z x 2.5m x 37.5R x 5f", "shaft"),
        ("INT 24z x 2.5m x 30P x 5H", "hub"),
        ("EXT 30T x 12/24P x 45R x 5", "shaft"),
    ],
)
def test_splines_of_other_standards_are_found(designation: str, part: str) -> None:
    spline = SplineJoint(designation=designation, length=30.0).parts[part]
    size, sign = spline.actual_other or spline.basic_size, -1 if spline.is_hub else 1
    pins = spline.over_pins(size)
    gauge = "between_pins" if spline.is_hub else "over_pins"
    found = identified(
        teeth=sign * spline.joint.count,
        tip_diameter=round(spline.tip_diameter, 2),
        root_diameter=round(spline.root_diameter, 2),
        **{gauge: {spline.pin_diameter: round(pins or 0.0, 3)}},
    )
    assert found.best.designation == spline.designation.rpartition(" x ")[0]
    assert found.best.size == pytest.approx(size, abs=0.03)


def test_what_tells_nothing_or_fits_nothing_is_one_line() -> None:
    with pytest.raises(ParameterError, match="it tells nothing of a spline"):
        identified(teeth=22, tip_diameter=29.75, lead=300.0)
    with pytest.raises(GeometryError, match="no spline of a standard comes near"):
        identified(teeth=22, tip_diameter=600.0)
    assert not identified(teeth=22, tip_diameter=129.7).fits


def test_the_command_writes_a_spec(tmp_path: Path) -> None:
    readings = ["--teeth", "22", "--tip-diameter", "29.7", "--over-pins", "2.7:32.88", "--span", "5:17.10"]
    path = tmp_path / "found.toml"
    result = CliRunner().invoke(main, ["identify", "--spline", *readings, "--write", str(path)])
    assert result.exit_code == 0, result.output
    assert "Certain: DIN 5480 - W 30 x 1.25 x 22 fits" in result.output
    document = read_spec(path).to_dict()
    assert (document["joint"]["nominal_diameter"], document["joint"]["module"], document["shaft"]["teeth"]) == (30, 1.25, 22)
    found = json.loads(CliRunner().invoke(main, ["identify", "--spline", *readings, "--json"]).stdout)
    assert found["certain"] is True and found["candidates"][0]["designation"] == "DIN 5480 - W 30 x 1.25 x 22"
