"""STEP as we write it: well formed text, the same solid for the CAD kernel; names, colours, bytes through CadQuery."""

import re
from pathlib import Path

import cadquery
import pytest
from hypothesis import HealthCheck, given, settings
from OCP.Interface import Interface_Static
from OCP.STEPCAFControl import STEPCAFControl_Controller
from support.specs import starter_specs
from support.step_witness import assert_same_solids, checked_text, product_tree
from support.strategies import build_gear, gear_inputs
from support.train_solids import simple_set, small_train

from gearcad import Body, Gear, GearPair, Rack, build
from gearcad.core.errors import InputError
from gearcad.designs import read_spec
from gearcad.geometry import DoubleHelix, RackPair
from gearcad.jobs.build import products_of
from gearcad.solids import FileOptions, gear_solid, pair_assembly, rack_solid, write_step
from gearcad.solids.body_plan import BRIGHT_STEEL, PART_COLOURS, STEEL
from gearcad.solids.exact.assemblies import pair_product, rack_product
from gearcad.solids.exact.rack_solid import rack_boundary
from gearcad.solids.exact.solid import AssembledProduct, Product, SolidProduct, cad_assembly, cad_solid, gear_boundary
from gearcad.solids.files.step import StepSchema, real, write_by_kernel, write_product
from gearcad.solids.files.train_products import carrier_boundary, carrier_solid, train_product
from gearcad.solids.train_plan import CarrierPlan, TrainPlan

SAME = 1e-9
"""Relative: booleans of planes and round walls are exact."""


def _bodied(teeth: int = 8, **given: object) -> Gear:
    body = Body(bore=5, keyway_width=2, keyway_depth=1, hub_diameter=9, hub_length=2, end_chamfer=0.4)
    return Gear(teeth=teeth, normal_module=2, **{"face_width": 6, "body": body, **given})


def _ring(**given: object) -> Gear:
    body = Body(rim_diameter=90, bolt_circle=82, bolt_holes=3, bolt_diameter=4, end_chamfer=0.3)
    return Gear(teeth=-30, normal_module=2, face_width=6, body=body, **given)


PARTS = {
    "bodied": lambda: gear_boundary(_bodied(helix_angle=15)),
    "rack": lambda: rack_boundary(Rack(teeth=2, normal_module=2, face_width=8, height=6, helix_angle=17)),
    "spur": lambda: gear_boundary(_bodied(20)),
    "chamfers below the root": lambda: gear_boundary(_bodied(12, face_width=12, body=Body(bore=5, end_chamfer=5.2))),
    "ring": lambda: gear_boundary(_ring(helix_angle=-18)),
    "gap": lambda: gear_boundary(_bodied(helix_angle=25, double_helix=DoubleHelix(gap_width=2, offset=0.3))),
    "apex": lambda: gear_boundary(_bodied(helix_angle=25, double_helix=DoubleHelix(gap_width=0))),
    "straight rack": lambda: rack_boundary(Rack(teeth=3, normal_module=2, face_width=8, height=6)),
}


def _compare(product: Product, folder: Path) -> None:
    ours, witness = folder / "ours.step", folder / "witness.step"
    write_product(product, ours)
    checked_text(ours.read_text("ascii"))
    solid = isinstance(product, SolidProduct)
    write_by_kernel(cad_solid(product.boundary) if solid else cad_assembly(product), witness, product.name)
    assert_same_solids(ours, witness)
    assert product_tree(ours) == product_tree(witness)


def _long_but(kept: set[str], names: object) -> list[object]:
    return [name if name in kept else pytest.param(name, marks=pytest.mark.long) for name in names]


@pytest.mark.parametrize("name", _long_but({"bodied", "rack"}, PARTS))
def test_parts_are_those_of_the_kernels_writer(name: str, tmp_path: Path) -> None:
    _compare(SolidProduct(name, PARTS[name](), BRIGHT_STEEL), tmp_path)


def _rack_pair() -> RackPair:
    rack = Rack(teeth=3, normal_module=2, face_width=8, height=6, helix_angle=-10)
    return RackPair(pinion=_bodied(20, helix_angle=10, body=Body()), rack=rack)


ASSEMBLIES = {
    "pair": lambda: pair_product(GearPair(pinion=_bodied(), wheel=_bodied(9)), bracket=True),
    "rack": lambda: rack_product(_rack_pair()),
    "simple train": lambda: train_product(TrainPlan.of(simple_set(24, 21, -66, 3), carrier=True)),
    "train": lambda: train_product(TrainPlan.of(small_train(), carrier=True, carrier_angle=13.0)),
    "exploded train": lambda: train_product(TrainPlan.of(small_train(), carrier=True, exploded=True)),
}


@pytest.mark.parametrize("name", _long_but({"pair"}, ASSEMBLIES))
def test_assemblies_are_those_of_the_kernels_writer(name: str, tmp_path: Path) -> None:
    _compare(ASSEMBLIES[name](), tmp_path)


SPECS = [path for path in starter_specs() if not path.name.startswith("train")]


@pytest.mark.long
@pytest.mark.parametrize("spec", SPECS, ids=lambda path: path.stem)
def test_starters_are_those_of_the_kernels_writer(spec: Path, tmp_path: Path) -> None:
    parts, assembly = products_of(read_spec(spec), FileOptions())
    for product in (*parts.values(), *([assembly] if assembly else [])):
        _compare(product.solid(), tmp_path)


@pytest.mark.long
@settings(max_examples=50, suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture], deadline=None)
@given(inputs=gear_inputs())
def test_any_gear_is_that_of_the_kernels_writer(tmp_path: Path, inputs: dict[str, object]) -> None:
    try:
        gear = build_gear(inputs)
    except InputError:
        return
    _compare(SolidProduct("gear", gear_boundary(gear), BRIGHT_STEEL), tmp_path)


# ---------------------------------------------------------------------- text


def test_a_file_has_what_teeth_share_once(tmp_path: Path) -> None:
    path = tmp_path / "gear.step"
    write_product(SolidProduct("gear", gear_boundary(_bodied(9, body=Body())), None), path)
    text = path.read_text("ascii")
    found = checked_text(text)
    assert found.kinds["ADVANCED_FACE"] == 9 * 6 + 2
    assert found.kinds["EDGE_CURVE"] == 9 * 18
    points = re.findall(r"CARTESIAN_POINT\('',\(([^)]*)\)\)", text)
    assert {point for point in points if points.count(point) > 1} <= {"0.0,0.0,0.0"}  # the origin of the whole, and of solids
    assert found.longest < 256


@pytest.mark.parametrize(
    ("value", "text"),
    [(1.0, "1.0"), (-0.1, "-0.1"), (1e-5, "1.E-05"), (-2.5e-17, "-2.5E-17"), (1e22, "1.E+22"), (1 / 3, "0.3333333333333333")],
)
def test_numbers_have_a_point_and_read_back(value: float, text: str) -> None:
    assert real(value) == text
    assert float(text) == value


@pytest.mark.parametrize(
    ("ours", "theirs", "words"),
    [
        ("#7=", "#8=", "twice"),
        (",.T.);\n", ",.T.,$);\n", "EDGE_CURVE|FACE"),
        ("DIRECTION(", "DIRECTIONS(", "DIRECTIONS"),
        ("'confusion accuracy'", "'confusion ' accuracy'", "accuracy"),
        ("1.0", "1", ""),
    ],
)
def test_the_checker_finds_what_is_wrong(ours: str, theirs: str, words: str, tmp_path: Path) -> None:
    path = tmp_path / "rack.step"
    write_product(SolidProduct("rack", PARTS["rack"](), BRIGHT_STEEL), path)
    text = path.read_text("ascii")
    if not words:
        checked_text(text)
        return
    with pytest.raises(AssertionError, match=words):
        checked_text(text.replace(ours, theirs, 1))


# ---------------------------------------------------------------------- CadQuery


def test_what_python_writes_is_what_commands_write(tmp_path: Path) -> None:
    """By way of CadQuery's objects, as long as nothing was done to them."""
    rack, pair = Rack(teeth=2, normal_module=2, face_width=8, height=6), ASSEMBLIES["pair"]()
    write_step(rack_solid(rack), tmp_path / "part.step", name="part")
    write_product(SolidProduct("part", rack_boundary(rack), BRIGHT_STEEL), tmp_path / "same.step")
    assert (tmp_path / "part.step").read_bytes() == (tmp_path / "same.step").read_bytes()
    write_step(cad_assembly(pair), tmp_path / "pair.step", name="any")
    write_product(pair, tmp_path / "same.step")
    assert (tmp_path / "pair.step").read_bytes() == (tmp_path / "same.step").read_bytes()


# ---------------------------------------------------------------------- by hand, and by booleans


def test_a_bracket_is_the_union_of_its_arm_and_shafts() -> None:
    pair = GearPair(pinion=_bodied(), wheel=_bodied(12, body=Body(bore=8)), axial_offset=1.5)
    product = pair_product(pair, bracket=True)
    assert isinstance(product, AssembledProduct)
    part = product.occurrences[-1].product
    assert isinstance(part, SolidProduct)
    distance, bottom, top = pair.centre_distance, -0.8 - 4, 8 + 0.8
    arm = cadquery.Workplane("XY", origin=(distance / 2, 0, bottom)).slot2D(distance + 9.6, 9.6).extrude(4)
    for x, bore in ((0.0, 5.0), (distance, 8.0)):
        arm = arm.union(cadquery.Workplane("XY", origin=(x, 0, bottom)).circle(bore / 2).extrude(top - bottom))
    _same_as_union(cad_solid(part.boundary), arm)


@pytest.mark.parametrize("plates", [((-2.0, 0.0), (9.0, 11.0)), ((-2.0, 0.0),), ((9.0, 11.0),)])
@pytest.mark.parametrize("inner", [0.0, 12.0])
def test_a_carrier_is_the_union_of_its_plates_and_pins(plates: tuple[tuple[float, float], ...], inner: float) -> None:
    pins = ((20.0, 0.0), (-10.0, 17.0), (-10.0, -17.0))
    reach = min(0.5, plates[0][0]), max(8.5, plates[-1][1])
    plan = CarrierPlan(pins, 6.0, inner, 28.0, reach, plates)
    union = cadquery.Workplane("XY")
    for bottom, top in plates:
        plate = cadquery.Workplane("XY", origin=(0, 0, bottom)).circle(28.0)
        union = union.add((plate.circle(inner) if inner else plate).extrude(top - bottom))
    low, high = reach
    bars = cadquery.Workplane("XY", origin=(0, 0, low)).pushPoints(pins).circle(3.0).extrude(high - low)
    assert carrier_boundary(plan).tolerance == 1e-7
    _same_as_union(carrier_solid(plan), union.union(bars))


def _same_as_union(solid: cadquery.Solid, union: cadquery.Workplane) -> None:
    (other,) = union.val().Solids()
    assert solid.isValid()
    assert [len(solid.Faces()), len(solid.Edges())] == [len(other.Faces()), len(other.Edges())]
    assert solid.Volume() == pytest.approx(other.Volume(), rel=SAME)
    assert solid.Area() == pytest.approx(other.Area(), rel=SAME)
    assert (solid.Center() - other.Center()).Length < 1e-9


@pytest.mark.parametrize(
    "name", ["a')b", "dogs', cats", "it's", "''", "#5=X('", "a\\b", "\\S\\a", "x\\'", "é'齿轮", "𝛼'", "a;b", "/*c*/"]
)
def test_open_cascade_reads_names_as_they_were_given(name: str, tmp_path: Path) -> None:
    """Its reader takes a doubled apostrophe before `)` or `,` for the end of the string."""
    from OCP.STEPCAFControl import STEPCAFControl_Reader
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDataStd import TDataStd_Name
    from OCP.TDF import TDF_LabelSequence
    from OCP.TDocStd import TDocStd_Document
    from OCP.XCAFDoc import XCAFDoc_DocumentTool

    write_product(SolidProduct(name, gear_boundary(_bodied(9, body=Body())), None), tmp_path / "it.step")
    document, reader, labels = TDocStd_Document(TCollection_ExtendedString("it")), STEPCAFControl_Reader(), TDF_LabelSequence()
    reader.SetNameMode(True)
    reader.ReadFile(str(tmp_path / "it.step"))
    reader.Transfer(document)
    XCAFDoc_DocumentTool.ShapeTool_s(document.Main()).GetShapes(labels)
    read = TDataStd_Name()
    assert labels.Value(1).FindAttribute(TDataStd_Name.GetID_s(), read)
    assert read.Get().ToExtString() == name


GEAR, MATE = (Gear(teeth=teeth, normal_module=2, face_width=6) for teeth in (8, 9))
NAMES = (
    "plain",
    "O'Brien",
    r"back\\slash",
    "Zahnrad \xe4\xf6\xfc\xdf",
    "\u6b6f\u8eca \U0001f600",
    "long " * 60 + "name",
    "gearcad-name-1",
)


def _drilled() -> cadquery.Shape:
    return cadquery.Workplane(obj=gear_solid(GEAR)).faces(">Z").workplane(origin=(0, 0, 0)).hole(4).val()


def test_a_drilled_or_moved_gear_is_one_part_of_its_name_in_steel(tmp_path: Path) -> None:
    path, drilled, moved = tmp_path / "changed.step", _drilled(), gear_solid(GEAR)
    volume = moved.Volume()
    moved.move(cadquery.Location(cadquery.Vector(0, 0, 5)))
    for shape, expected in ((drilled, (drilled.Volume(), 3.0)), (moved, (volume, 8.0))):
        write_step(shape, path, name="Getriebe 'A'")
        (again,) = cadquery.importers.importStep(str(path)).solids().vals()
        assert (again.Volume(), again.Center().z) == pytest.approx(expected, rel=SAME)
        (part,) = product_tree(path)
        assert (part.product, part.children) == ("Getriebe 'A'", ())
        assert part.colour == pytest.approx(STEEL, abs=1e-4)


@pytest.mark.parametrize("name", NAMES)
def test_any_name_reads_back(name: str, tmp_path: Path) -> None:
    path = tmp_path / "box.step"
    write_step(cadquery.Solid.makeBox(1, 1, 1), path, name=name)
    assert [part.product for part in product_tree(path)] == [name]
    assert f"FILE_NAME('{name[:5]}" in path.read_text("ascii").replace(r"O\X\27", "O'") or not name[:5].isascii()


def _gone_on_with() -> cadquery.Assembly:
    """A pair and boxes with it, of which two are of one colour, and two the same product."""
    red, peg = cadquery.Color(1.0, 0.0, 0.0), cadquery.Solid.makeBox(1, 2, 3)
    whole = pair_assembly(GearPair(pinion=GEAR, wheel=MATE))
    for number, name in enumerate((*NAMES[:3], "first", "second")):
        box, product = (peg, {"product": "peg"}) if number > 2 else (cadquery.Solid.makeBox(1, 1, 1), {})
        whole.add(box, name=name, loc=cadquery.Location(cadquery.Vector(0, 0, 9 + number)), color=red, metadata=product)
    return whole


def test_an_assembly_keeps_products_places_and_colours(tmp_path: Path) -> None:
    path = tmp_path / "assembly.step"
    write_step(_gone_on_with(), path, name="any")
    (whole,) = product_tree(path)
    assert [part.name for part in whole.children[2:]] == [*NAMES[:3], "first", "second"]
    assert [part.product for part in whole.children[2:]] == [*NAMES[:3], "peg", "peg"]
    assert [part.place[11] for part in whole.children[2:]] == [9, 10, 11, 12, 13]
    light = [tuple(_light(share) for share in PART_COLOURS[gear]) for gear in ("pinion", "wheel")]
    for part, colour in zip(whole.children, [*light, *[(1.0, 0.0, 0.0)] * 5], strict=True):
        assert part.colour == pytest.approx(colour, abs=1e-4)


def _light(share: float) -> float:
    """sRGB as shares of light (IEC 61966-2-1), in which the kernel has colours."""
    return share / 12.92 if share <= 0.04045 else ((share + 0.055) / 1.055) ** 2.4


def test_equal_input_gives_equal_bytes_and_settings_stay(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)
    STEPCAFControl_Controller.Init_s()
    before = Interface_Static.IVal_s("write.surfacecurve.mode"), Interface_Static.CVal_s("write.step.schema")
    found = set()
    for number in range(10):  # occurrences are numbered through the session, and lines broken by it
        pair = pair_assembly(GearPair(pinion=GEAR, wheel=MATE)).add(cadquery.Solid.makeBox(1, 1, 1), name="box")
        write_step(pair, tmp_path / f"{number}.step", name="any")
        found.add((tmp_path / f"{number}.step").read_bytes())
    assert len(found) == 1
    assert before == (Interface_Static.IVal_s("write.surfacecurve.mode"), Interface_Static.CVal_s("write.step.schema"))
    text = found.pop().decode("ascii")
    assert "'2000-01-01T00:00:00'" in text and "PCURVE" not in text


AP242 = (
    ("AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }", "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF { 1 0 10303 442 1 1 4 }"),
    ("core data for automotive mechanical design processes", "managed model based 3d engineering"),
    ("'automotive_design',2000", "'ap242_managed_model_based_3d_engineering',2014"),
)
"""What differs between a file in AP214 and one in AP242."""


@pytest.mark.parametrize("own", [True, False], ids=["ours", "the kernel's"])
def test_ap242_differs_in_its_schema_alone(own: bool, tmp_path: Path) -> None:
    """Names and places are those of the CAD kernel's reader in both."""
    solid = pair_assembly(GearPair(pinion=_bodied(), wheel=_bodied(12), name="pair ä"))
    texts = []
    for schema in StepSchema:
        path = tmp_path / f"{schema.name}.step"
        if own:
            write_step(solid, path, name="pair ä", schema=schema)
        else:
            write_by_kernel(solid, path, "pair ä", schema)
        texts.append(path.read_text(encoding="ascii"))
    plain, other = texts
    if own:
        for before, after in AP242:
            assert plain.count(before) == 1
            plain = plain.replace(before, after)
        assert other == plain
    else:
        assert AP242[0][1] in other and "'ap242_managed_model_based_3d_engineering'" in other
    trees = [product_tree(tmp_path / f"{schema.name}.step") for schema in StepSchema]
    assert trees[0] == trees[1]


def test_ap242_is_an_option_of_files(tmp_path: Path) -> None:
    (path,) = [each for each in build(_bodied(), tmp_path, ["step"], ap242=True) if each.suffix == ".step"]
    assert AP242[0][1] in path.read_text(encoding="ascii")
    with pytest.raises(InputError, match=r"ap242 = True: needs the format step: it is a protocol of STEP"):
        build(_bodied(), tmp_path, ["stl"], ap242=True)
