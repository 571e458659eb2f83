"""Teeth on a blank of one's own, a STEP file: one solid, of the volume of both, with the faces of our own teeth."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import cadquery
import pytest

from gearcad import build
from gearcad.core.errors import GearcadError, GeometryError
from gearcad.designs import open_table
from gearcad.designs.reader import read_spec
from gearcad.geometry import Body, Gear
from gearcad.solids.exact.own_blank import toothed_blank
from gearcad.solids.exact.solid import gear_solid

GEAR = Gear(teeth=17, normal_module=2.0, face_width=8.0, helix_angle=12.0, profile_shift=0.3)
ROOT = GEAR.root_diameter / 2


def _disc(radius: float, width: float = 8.0, low: float = 0.0) -> cadquery.Workplane:
    return cadquery.Workplane("XY").workplane(offset=low).circle(radius).circle(4.0).extrude(width)


def _blank() -> cadquery.Workplane:
    """A rim up to the root circle, a web with holes, and a hub that stands out on both sides."""
    rim = cadquery.Workplane("XY").circle(ROOT).circle(ROOT - 3.0).extrude(8.0)
    web = cadquery.Workplane("XY").workplane(offset=2.0).circle(ROOT - 2.5).circle(5.0).extrude(3.0)
    web = web.faces(">Z").workplane().polarArray(9.0, 0, 360, 4).hole(2.0)
    return rim.union(web).union(_disc(6.0, 12.0, -2.0))


def _gear(folder: Path, blank: cadquery.Workplane) -> Gear:
    cadquery.exporters.export(blank, str(folder / "blank.step"))
    return replace(GEAR, body=Body(step=str(folder / "blank.step")))


def _areas(solid: cadquery.Solid) -> list[float]:
    """Areas (mm²) of the faces that are swept curves: flanks and fillets."""
    return sorted(face.Area() for face in solid.Faces() if face.geomType() in ("BSPLINE", "BEZIER"))


def test_the_whole_is_blank_and_teeth_and_its_flanks_are_our_own(tmp_path: Path) -> None:
    blank = _blank()
    whole = toothed_blank(_gear(tmp_path, blank))
    assert whole.isValid()
    assert whole.ShapeType() == "Solid"
    plain = gear_solid(GEAR)
    teeth = plain.Volume() - math.pi * ROOT**2 * 8.0
    assert whole.Volume() == pytest.approx(blank.val().Volume() + teeth, rel=1e-9)
    build(GEAR, tmp_path / "ours", ["step"])
    ours = cadquery.importers.importStep(str(tmp_path / "ours" / "gear.step")).val()
    assert len(_areas(ours)) >= 4 * 17
    assert _areas(whole) == pytest.approx(_areas(ours), rel=1e-9)


def test_its_files_are_closed_and_seen_from_the_folder_of_the_spec(tmp_path: Path) -> None:
    import trimesh

    _gear(tmp_path, _disc(ROOT + 1.0))
    spec = 'gear.teeth = 17\ngear.normal_module = 2.0\ngear.face_width = 8.0\ngear.body.step = "blank.step"\n'
    (tmp_path / "own.toml").write_text(spec, encoding="utf-8")
    design = read_spec(tmp_path / "own.toml")
    files = build(design, tmp_path / "files", ["step", "stl"])
    solid = cadquery.importers.importStep(str(files[-1])).val()
    facets = trimesh.load(files[-2])
    assert solid.isValid()
    assert facets.is_watertight
    assert facets.volume == pytest.approx(solid.Volume(), rel=2e-3)
    document = design.to_dict()["gear"]
    assert document["body"]["step"] == "blank.step"
    assert [notice["code"] for notice in document["notices"]].count("own-blank") == 1


def test_a_cell_of_a_table_names_a_blank_from_the_folder_of_the_table(tmp_path: Path) -> None:
    heading, row = "name,teeth,normal_module,face_width,body.step", "own,17,2,8,blank.step"
    (tmp_path / "gears.csv").write_text(f"{heading}\n{row}\n", encoding="utf-8")
    (tmp_path / "blank.step").write_text("ISO-10303-21;", encoding="utf-8")
    (found,) = open_table(tmp_path / "gears.csv").rows()
    assert found.design().gears["gear"].body.step == str(tmp_path / "blank.step")
    assert "ISO-10303-21;" in found.inputs.values()


@pytest.mark.parametrize(
    ("radius", "width", "low", "place"),
    [
        (ROOT - 0.1, 8.0, 0.0, f"radius {ROOT:.6g} mm, z = 4 mm, all round"),
        (ROOT + 2.0, 7.0, 0.0, f"radius {ROOT:.6g} mm, z = 7.5 mm, all round"),
        (ROOT + 2.0, 8.0, 0.5, f"radius {ROOT:.6g} mm, z = 0.25 mm, all round"),
    ],
)
def test_a_rim_that_does_not_reach_is_told_with_its_place(
    radius: float, width: float, low: float, place: str, tmp_path: Path
) -> None:
    with pytest.raises(GeometryError) as caught:
        toothed_blank(_gear(tmp_path, _disc(radius, width, low)))
    inner = ROOT - 0.2
    assert str(caught.value) == (
        "body.step = 'blank.step': must have a rim about z that reaches from "
        f"{inner:.6g} to {ROOT:.6g} mm, the root circle: nothing is at {place}"
    )


def test_a_hole_in_the_rim_is_told_with_its_place(tmp_path: Path) -> None:
    x, y = (ROOT * each(math.radians(40.0)) for each in (math.cos, math.sin))
    hole = cadquery.Workplane("XY").center(x, y).circle(0.8).extrude(3.0)
    with pytest.raises(GeometryError, match=r"z = 1\.5 mm, angle 40 deg$"):
        toothed_blank(_gear(tmp_path, _disc(ROOT + 2.0).cut(hole)))


def test_what_is_no_blank_is_refused_in_one_line(tmp_path: Path) -> None:
    (tmp_path / "text.step").write_text("hello", encoding="utf-8")
    two = _disc(ROOT).union(_disc(ROOT, 2.0, 20.0))
    gears = {
        "cannot be read (No such file or directory)": replace(GEAR, body=Body(step=str(tmp_path / "none.step"))),
        "must be a STEP file with one solid: it cannot be read": replace(GEAR, body=Body(step=str(tmp_path / "text.step"))),
        "must hold one solid, not 2": _gear(tmp_path, two),
    }
    for message, gear in gears.items():
        with pytest.raises(GearcadError) as caught:
            toothed_blank(gear)
        assert str(caught.value).endswith(message)


@pytest.mark.parametrize(
    ("gear", "message"),
    [
        ({"body": {"step": "b.step", "bore": 6.0}}, "bore = 6 mm: must be left out where step is given"),
        ({"body": {"step": " "}}, "step = ' ': must be the name of a STEP file"),
        ({"body": {"step": "b.step"}, "teeth": -40}, "body.step = 'b.step': must be left out: it is for external gears"),
    ],
)
def test_what_does_not_go_with_a_blank_is_refused(gear: dict, message: str) -> None:  # type: ignore[type-arg]
    with pytest.raises(GearcadError) as caught:
        Gear(**{"teeth": 17, "normal_module": 2.0, "face_width": 8.0} | gear | {"body": Body(**gear["body"])})
    assert str(caught.value).startswith(message)
