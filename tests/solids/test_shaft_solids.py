"""Shafts as bodies: exact solids, facets, places in the assembly of a pair, seats, files, and the judge of these files."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import cadquery
import numpy as np
import pytest

from gearcad.core.errors import GeometryError, ParameterError
from gearcad.designs import PairDesign, read_spec
from gearcad.jobs.build import Build, seated_shafts
from gearcad.jobs.draw import Draw, Picture
from gearcad.jobs.verification import Verify
from gearcad.shafts.beam import ShaftBearing, ShaftSegment, SteppedShaft
from gearcad.solids import FileOptions, Format
from gearcad.solids.exact.inertia import moments
from gearcad.solids.exact.shaft_solid import shaft_boundary, shaft_solid
from gearcad.solids.files.shaft_products import ShaftProduct
from gearcad.solids.files.step import write_product
from gearcad.solids.shaft_plan import TurnedPlan
from gearcad.verification.claims import VerificationLevel
from gearcad.verification.step import judge_step, read_step
from gearcad.verification.turned_parts import ExactShaft

VOLUME = 1e-9
"""Relative difference of volumes: planes, cylinders and circles are exact."""

STEPPED = """
[pair]
name = "stepped"
normal_module = 2.0
face_width = 20.0
[pinion]
teeth = 24
face_width = 22.0
body.bore = 20.0
mesh_position = 55.0
[[pinion.shaft]]
length = 40.0
outer_diameter = 20.0
[[pinion.shaft]]
length = 30.0
outer_diameter = {seat}
[[pinion.shaft]]
length = 20.0
outer_diameter = 20.0
[[pinion.bearing]]
position = 10.0
axial_stiffness = "rigid"
[[pinion.bearing]]
position = 80.0
[wheel]
teeth = 51
body.bore = {bore}
body.hub_diameter = 50.0
body.hub_length = 8.0
mesh_position = 50.0
[[wheel.shaft]]
length = 30.0
outer_diameter = 25.0
inner_diameter = 12.0
[[wheel.shaft]]
length = 75.0
outer_diameter = 30.0
[[wheel.bearing]]
position = 10.0
axial_stiffness = "rigid"
[[wheel.bearing]]
position = 90.0
"""

MIDDLE, DISTANCE = 11.0, 75.0
"""Middle of the common face over the lower end of the pinion (half its width of 22 mm), and m_n (24 + 51)/2, mm."""


def shaft_of(*rows: tuple[float, float, float]) -> SteppedShaft:
    segments = (ShaftSegment(length=length, outer_diameter=outer, inner_diameter=inner) for length, outer, inner in rows)
    return SteppedShaft(segments=tuple(segments), bearings=(ShaftBearing(position=0.0),))


def closed_form(*rows: tuple[float, float, float]) -> float:
    return sum(math.pi / 4 * (outer**2 - inner**2) * length for length, outer, inner in rows)


def design_of(folder: Path, seat: float = 20.0, bore: float = 30.0) -> PairDesign:
    spec = folder / "stepped.toml"
    spec.write_text(STEPPED.format(seat=seat, bore=bore), encoding="utf-8")
    found = read_spec(spec)
    assert isinstance(found, PairDesign)
    return found


SHAFTS = {
    "solid": ((20.0, 30.0, 0.0), (5.0, 40.0, 0.0), (30.0, 40.0, 0.0), (10.0, 25.0, 0.0)),
    "hollow": ((20.0, 30.0, 10.0), (15.0, 40.0, 20.0), (30.0, 40.0, 8.0), (10.0, 25.0, 8.0)),
    "bored from both ends": ((20.0, 30.0, 12.0), (15.0, 40.0, 0.0), (10.0, 25.0, 8.0), (5.0, 25.0, 14.0)),
    "plain": ((100.0, 10.0, 0.0),),
}


@pytest.mark.parametrize("rows", SHAFTS.values(), ids=SHAFTS)
def test_a_shaft_is_one_closed_solid(rows: tuple[tuple[float, float, float], ...], tmp_path: Path) -> None:
    """As the CAD kernel reads it from STEP, against the sum of cylinders."""
    shaft, expected = shaft_of(*rows), closed_form(*rows)
    path = tmp_path / "shaft.step"
    write_product(ShaftProduct(plan=TurnedPlan(shaft), name="shaft", options=FileOptions()).solid(), path)
    (found,) = cadquery.importers.importStep(str(path)).vals()
    assert isinstance(found, cadquery.Solid) and found.isValid() and len(found.Shells()) == 1
    assert found.Volume() == pytest.approx(expected, rel=VOLUME)
    assert shaft_solid(shaft).Volume() == pytest.approx(expected, rel=VOLUME)
    assert moments(shaft_boundary(shaft)).volume == pytest.approx(expected, rel=VOLUME)
    assert TurnedPlan(shaft).surface_area == pytest.approx(found.Area(), rel=VOLUME)


def test_random_shafts_are_closed_solids() -> None:
    """Steps and bores at random, with the kernel's volume as the judge."""
    random = np.random.default_rng(7)
    for _ in range(12):
        count = int(random.integers(1, 6))
        outer = random.uniform(20, 60, count)
        inner = np.where(np.arange(count) < random.integers(0, count + 1), random.uniform(2, 18, count), 0.0)
        rows = tuple(zip(random.uniform(1, 50, count).tolist(), outer.tolist(), inner.tolist(), strict=True))
        solid, expected = shaft_solid(shaft_of(*rows)), closed_form(*rows)
        assert solid.isValid() and solid.Volume() == pytest.approx(expected, rel=VOLUME)


@pytest.mark.parametrize("rows", SHAFTS.values(), ids=SHAFTS)
def test_facets_are_watertight_and_within_the_chord_error(rows: tuple[tuple[float, float, float], ...]) -> None:
    error = 0.01
    product = ShaftProduct(plan=TurnedPlan(shaft_of(*rows)), name="shaft", options=FileOptions(chord_error=error))
    mesh = product.facets.to_trimesh()
    bored = all(inner for _, _, inner in rows)
    assert mesh.is_watertight and mesh.is_winding_consistent and mesh.euler_number == (0 if bored else 2)
    assert 0 < mesh.volume < closed_form(*rows) * (1 + VOLUME)
    middles = mesh.vertices[mesh.faces].mean(axis=1)
    away = ExactShaft(shaft_of(*rows)).surface.distances(middles).min(axis=0)
    assert 0.1 * error < away.max() <= error


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (((10.0, 20.0, 0.0), (10.0, 40.0, 20.0)), "shaft[0].outer_diameter = 20 mm: must be above 20 mm"),
        (((10.0, 30.0, 0.0), (10.0, 30.0, 10.0), (10.0, 30.0, 0.0)), "shaft[1].inner_diameter = 10 mm: must reach an end"),
    ],
)
def test_what_is_no_solid_is_refused(rows: tuple[tuple[float, float, float], ...], said: str) -> None:
    with pytest.raises(GeometryError) as error:
        shaft_boundary(shaft_of(*rows))
    assert said in str(error.value)


def test_shafts_stand_with_their_gears(tmp_path: Path) -> None:
    """The left end is `mesh_position` below the middle of the common face; the axes are those of the gears."""
    job = Build(formats=(Format.STEP,))
    names = {path.name for path in job.write(job.run(design_of(tmp_path)), tmp_path / "out")}
    assert {"pinion-shaft.step", "wheel-shaft.step", "assembly.step"} <= names
    (root,) = read_step(tmp_path / "out" / "assembly.step")
    places = {part.product: part.place[:, 3] for part in root.parts()}
    assert set(places) == {"stepped pinion", "stepped wheel", "stepped pinion shaft", "stepped wheel shaft"}
    assert places["stepped pinion shaft"] == pytest.approx([0.0, 0.0, MIDDLE - 55.0], abs=1e-9)
    assert places["stepped wheel shaft"] == pytest.approx([DISTANCE, 0.0, MIDDLE - 50.0], abs=1e-9)
    colours = [part.colour for part in root.parts()]
    assert None not in colours and len({tuple(round(share, 3) for share in each or ()) for each in colours}) == 4
    document = job.document(design_of(tmp_path))
    assert document["shafts"]["wheel-shaft"]["left_end"] == pytest.approx([DISTANCE, 0.0, MIDDLE - 50.0])
    mass = 7850e-9 * closed_form((30.0, 25.0, 12.0), (75.0, 30.0, 0.0))
    assert document["shafts"]["wheel-shaft"]["mass"] == pytest.approx(mass, rel=VOLUME)


@pytest.mark.parametrize(
    ("seat", "bore", "codes"),
    [
        (20.0, 30.0, []),
        (18.0, 32.0, ["seat-thinner", "seat-thinner"]),
        (24.0, 30.0, ["seat-thicker"]),
        (48.0, 0.0, ["seat-thicker", "one-piece"]),
    ],
)
def test_seats_that_differ_are_told(seat: float, bore: float, codes: list[str], tmp_path: Path) -> None:
    design = design_of(tmp_path, seat, bore)
    found = [each for each in Build().notices(design) if each.code not in {notice.code for notice in design.pair.notices}]
    assert [each.code for each in found] == codes
    if codes and bore:
        assert f"{seat:g} mm" in found[0].text and "20 mm" in found[0].text
    assert "rigid-shafts" not in codes and "rigid-shafts" in {each.code for each in design.notices}


def test_a_shaft_thicker_than_the_roots_stands_for_the_body_of_its_gear(tmp_path: Path) -> None:
    """Within the gear the solid ends half a module below the roots: nothing fills the spaces of teeth."""
    design = design_of(tmp_path, 48.0)
    pinion = replace(design.pair.pinion, body=replace(design.pair.pinion.body, bore=0.0))
    design = replace(design, pair=replace(design.pair, pinion=pinion))
    shaft = seated_shafts(design)[0]
    assert [each.code for each in shaft.notices] == ["pinion-shaft"] and "43 mm" in next(shaft.notices).text  # m_n (24 - 2.5)
    rows = ((40.0, 20.0, 0.0), (4.0, 48.0, 0.0), (22.0, 41.0, 0.0), (4.0, 48.0, 0.0), (20.0, 20.0, 0.0))
    assert shaft_solid(shaft.shaft).Volume() == pytest.approx(closed_form(*rows), rel=VOLUME)


def test_the_judge_takes_files_of_shafts_and_finds_a_wrong_one(tmp_path: Path) -> None:
    shaft = shaft_of(*SHAFTS["hollow"])
    product = ShaftProduct(plan=TurnedPlan(shaft), name="shaft", options=FileOptions()).solid()
    path = tmp_path / "shaft.step"
    write_product(product, path)
    claims = list(judge_step(path, product, {"shaft": ExactShaft(shaft)}))
    assert len(claims) >= 8 and all(claim.passed for claim in claims)
    longer = shaft_of((20.001, 30.0, 10.0), *SHAFTS["hollow"][1:])
    failed = {each.quantity for each in judge_step(path, product, {"shaft": ExactShaft(longer)}) if not each.passed}
    assert {"volume", "area", "distance of edges and plain faces from the exact surface"} <= failed


def test_a_scene_has_the_shafts_of_its_gears(tmp_path: Path) -> None:
    """They turn with their gears, and are not cut lengthways."""
    shot = Picture(explode=True).run(design_of(tmp_path)).shot
    parts = {part.name: part for part in shot.scene(0.0)}
    wheel, shaft = parts["stepped wheel"], parts["stepped wheel shaft"]
    assert shaft.rotation == wheel.rotation and shaft.offset[:2] == wheel.offset[:2] and wheel.offset[0] > DISTANCE
    assert parts["stepped pinion shaft"].offset[:2] == (0.0, 0.0)


def test_no_bracket_stands_beside_shafts(tmp_path: Path) -> None:
    with pytest.raises(GeometryError, match="bracket = True: must be left out with shafts"):
        Build(options=FileOptions(bracket=True)).run(design_of(tmp_path))


def test_a_chord_error_below_single_precision_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="chord_error"):
        Build(formats=(Format.STL,), options=FileOptions(chord_error=1e-7)).run(design_of(tmp_path))


ALONE = """
[[shaft]]
length = 40.0
outer_diameter = 20.0
inner_diameter = 8.0
[[shaft]]
length = 60.0
outer_diameter = 30.0
[[bearing]]
position = 10.0
axial_stiffness = "rigid"
[[bearing]]
position = 90.0
"""


def test_a_shaft_by_itself_has_files_a_sheet_and_a_picture(tmp_path: Path) -> None:
    spec = tmp_path / "alone.toml"
    spec.write_text(ALONE, encoding="utf-8")
    design = read_spec(spec)
    job = Build(formats=(Format.STEP, Format.STL))
    names = {path.name for path in job.write(job.run(design), tmp_path / "out")}
    assert names == {"data.json", "shaft.step", "shaft.stl"}
    (found,) = cadquery.importers.importStep(str(tmp_path / "out" / "shaft.step")).vals()
    assert found.Volume() == pytest.approx(closed_form((40.0, 20.0, 8.0), (60.0, 30.0, 0.0)), rel=VOLUME)
    assert [(sheet.name, sheet.title) for sheet in Draw().run(design).sheets] == [("shaft", "Shaft alone")]
    assert [part.name for part in Picture().run(design).shot.scene(0.0)] == ["alone"]
    for refused in (Build(formats=(Format.DXF,)), Build(options=FileOptions(bracket=True)), Draw(what="tool")):
        with pytest.raises((GeometryError, ParameterError)):
            refused.run(design)


def test_bearings_of_given_sizes_are_rings_of_the_assembly(tmp_path: Path) -> None:
    """They have no files of their own. A bore that is not the shaft's diameter is told."""
    spec = tmp_path / "on-rings.toml"
    sizes = "position = 90.0\nd = 30.0\nD = 62.0\nB = 16.0\n"
    text = STEPPED.format(seat=20.0, bore=30.0).replace("position = 90.0\n", sizes)
    spec.write_text(text, encoding="utf-8")
    design = read_spec(spec)
    job = Build(formats=(Format.STEP,))
    names = {path.name for path in job.write(job.run(design), tmp_path / "out")}
    assert not [name for name in names if "bearing" in name]
    (root,) = read_step(tmp_path / "out" / "assembly.step")
    ring = next(part for part in root.parts() if part.product == "stepped wheel bearing 2")
    assert ring.place[:, 3] == pytest.approx([DISTANCE, 0.0, MIDDLE - 50.0 + 90.0 - 8.0], abs=1e-9)
    assert cadquery.Solid(ring.shape).Volume() == pytest.approx(closed_form((16.0, 62.0, 30.0)), rel=VOLUME)
    spec.write_text(text.replace("d = 30.0", "d = 35.0"), encoding="utf-8")
    told = [str(each) for each in job.notices(read_spec(spec)) if each.code == "bearing-seat"]
    assert told == ["wheel: 2: the bearing has a bore of 35 mm, the shaft 30 mm there"]


def test_sizes_of_bearings_belong_together() -> None:
    with pytest.raises(GeometryError, match="must be given: d, D and B belong together"):
        ShaftBearing(position=0.0, d=20.0, D=47.0)
    with pytest.raises(GeometryError, match="D = 20 mm: must be above 20 mm, the bore"):
        ShaftBearing(position=0.0, d=20.0, D=20.0, B=14.0)


@pytest.mark.long
def test_all_files_of_a_pair_on_shafts_and_bearings_are_verified(tmp_path: Path) -> None:
    """STEP, STL, 3MF, GLB and sheets of gears, shafts and rings; nothing of the shafts is left without a judge."""
    spec = tmp_path / "verified.toml"
    sizes = "position = 90.0\nd = 30.0\nD = 62.0\nB = 16.0\n"
    spec.write_text(STEPPED.format(seat=20.0, bore=30.0).replace("position = 90.0\n", sizes), encoding="utf-8")
    found = Verify(level=VerificationLevel.FILES).run(read_spec(spec))
    assert not found.failed
    judged = {claim.where for claim in found.claims if claim.passed}
    assert {"pinion-shaft.step", "wheel-shaft.stl", "drawing-pinion-shaft.dxf"} <= judged
    assert any("wheel bearing 2" in where for where in judged)
