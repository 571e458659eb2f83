"""REXS: pairs come back as they went, files hold what the database of REXS permits, and units are those that it has."""

from __future__ import annotations

import csv
import math
import tomllib
import xml.etree.ElementTree as ElementTree
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import ClassVar

import pytest
from support.rexs_designs import design_of, differences, random_pairs
from support.specs import TEMPLATES

from gearcad import Gear, export_rexs, import_rexs
from gearcad.core.errors import ParameterError
from gearcad.core.records import Role
from gearcad.designs import Design, GearDesign, PairDesign, read_spec
from gearcad.exchange.rexs_import import RexsImport

DATA = Path(__file__).parents[1] / "data"


def starters_of_gears_and_pairs() -> list[str]:
    """Return the names of all starters that can be exported: a new one is among them by itself."""
    others = {"planetary", "measured", "train", "rack", "spline"}
    tables = {path.stem: tomllib.loads(path.read_text(encoding="utf-8")) for path in sorted(TEMPLATES.glob("*.toml"))}
    return [name for name, found in tables.items() if found.keys() & {"pinion", "gear"} and not found.keys() & others]


STARTERS = starters_of_gears_and_pairs()

ON_SHAFTS = """
[pair]
name = "on-shafts"
normal_module = 2.0
face_width = 20.0
helix_angle = 0.0
[pinion]
teeth = 20
mesh_position = 40.0
coupling = 0.0
[[pinion.shaft]]
length = 400.0
outer_diameter = 20.0
inner_diameter = 8.0
youngs_modulus = 210000.0
poisson_ratio = 0.29
[[pinion.bearing]]
name = "left"
position = 0.0
radial_stiffness = 125.0
axial_stiffness = 40.0
[[pinion.bearing]]
name = "right"
kind = "cylindrical"
position = 400.0
radial_stiffness = 125.0
C = 31000.0
C0 = 27500.0
[[pinion.force]]
position = 200.0
force = [800.0, 0.0, 0.0]
[wheel]
teeth = 40
mesh_position = 30.0
[[wheel.shaft]]
length = 60.0
outer_diameter = 30.0
[[wheel.bearing]]
position = 5.0
axial_stiffness = "rigid"
[[wheel.bearing]]
position = 55.0
[load]
torque = 95.49296585513721
speed = 1500.0
[shafts]
gravity = [0.0, 0.0, 0.0]
mesh_angle = 30.0
[rating]
oil_viscosity_40 = 220.0
oil_density = 875.0
"""


def there_and_back(design: Design, folder: Path) -> RexsImport:
    """Return what is read from the file of a design."""
    path = folder / "file.rexs"
    path.write_text(export_rexs(design).text, encoding="utf-8-sig")
    return import_rexs(path)


def require_same(design: Design, folder: Path) -> None:
    found = there_and_back(design, folder)
    assert (found.version, found.application, found.told) == ("1.6", "gearcad", ())
    (spec,) = found.specs
    assert (spec.name, spec.told, differences(design, spec.design)) == (design.name, (), [])


@pytest.mark.parametrize("name", STARTERS)
def test_starters_come_back(name: str, tmp_path: Path) -> None:
    require_same(read_spec(TEMPLATES / f"{name}.toml"), tmp_path)


def test_starters_are_found() -> None:
    assert {"reducer-21-43", "ring-22-70", "spur", "volvo-13-44"} < {*STARTERS}


@pytest.mark.parametrize(("count", "seed"), [(25, 1), pytest.param(100, 2, marks=pytest.mark.long)])
def test_random_pairs_come_back(count: int, seed: int, tmp_path: Path) -> None:
    """With rings, cutters, grinding stock, allowances, modifications, materials, oil, shafts, bearings and forces."""
    had = Counter[str]()
    for design in random_pairs(count, seed):
        require_same(design, tmp_path)
        text = export_rexs(design).text
        had.update(kind for kind in ("ring_gear", "cutter_wheel_tool", "shaft_section", "machining_allowance") if kind in text)
    assert len(had) == 4


def test_a_splined_bore_and_tools_of_the_shelf_come_back(tmp_path: Path) -> None:
    text = '[gear]\nteeth = 30\nnormal_module = 2\nface_width = 20\nbody.bore = "N 20 x 1.25 x 14 x 9H"\ntool = "DIN 3972 II"\n'
    gear = design_of(text).gears["gear"]
    found = export_rexs(gear)
    assert [line.partition(":")[0] for line in found.kept] == ["gear.tool", "gear.body.bore"]
    again = there_and_back(GearDesign(name=gear.name, gear=gear), tmp_path).specs[0].design
    assert again.gears["gear"].body.bore_spline == gear.body.bore_spline
    assert differences(GearDesign(name=gear.name, gear=replace(gear, tool=None)), again) == []


# ---------------------------------------------------------------- what the file holds

CHILDREN = {
    "model": {"relations", "components", "load_spectrum"},
    "relations": {"relation"},
    "relation": {"ref"},
    "components": {"component"},
    "component": {"attribute"},
    "attribute": {"array"},
    "array": {"c"},
}
"""Elements of REXS that gearcad writes, and what stands in them."""

NEEDED = {
    "model": {"version", "applicationId", "applicationVersion", "date", "applicationLanguage"},
    "relation": {"id", "type"},
    "ref": {"id", "role", "hint"},
    "component": {"id", "type", "name"},
    "attribute": {"id", "unit"},
}
"""Attributes of the elements."""

RELATIONS = {
    "assembly": (
        ("assembly", "part"),
        {("gear_unit", "gear_casing"), ("gear_unit", "shaft"), ("gear_unit", "cylindrical_stage")},
    ),
    "stage": (("stage", "gear_1", "gear_2"), {("cylindrical_stage", "gear", "gear")}),
    "flank": (("gear", "left", "right"), {("gear", *["cylindrical_gear_flank"] * 2)}),
    "side": (
        ("assembly", "inner_part", "outer_part"),
        {(kind, "shaft", "gear_casing") for kind in ("concept_bearing", "rolling_bearing_with_catalog_geometry")},
    ),
    "reference": (
        ("origin", "referenced"),
        {("gear", "material"), ("shaft", "material"), ("cylindrical_stage", "lubricant"), ("gear_casing", "lubricant")},
    ),
    "manufacturing_step": (
        ("workpiece", "tool", "manufacturing_settings"),
        {
            ("cylindrical_gear_flank", tool, "cylindrical_gear_manufacturing_settings")
            for tool in ("rack_shaped_tool", "cutter_wheel_tool")
        },
    ),
}
"""Roles of each relation, and the types of components that the database of REXS 1.6 permits in them; gear is either."""

RELATIONS["assembly"][1].update({("shaft", part) for part in ("gear", "shaft_section", "external_load")})
RELATIONS["reference"][1].update(
    ("cylindrical_gear_flank", part)
    for part in (
        *("tip_relief", "root_relief", "profile_crowning", "profile_slope", "profile_twist", "helix_crowning", "helix_slope"),
        *("end_relief_datum_face", "end_relief_non_datum_face"),
    )
)


def units() -> dict[tuple[str, str], str]:
    """Return the unit of each attribute of each type of component, written down from the public database of REXS 1.6."""
    with (DATA / "rexs_attributes.csv").open(encoding="utf-8", newline="") as file:
        return {(row["component"], row["attribute"]): row["unit"] for row in csv.DictReader(file)}


def require_rexs(text: str) -> ElementTree.Element:
    """Check the structure, the references and the attributes of a file that gearcad wrote, and return its tree."""
    root = ElementTree.fromstring(text)
    for element in root.iter():
        assert {each.tag for each in element} <= CHILDREN.get(element.tag, set())
        assert element.attrib.keys() - {"order"} == NEEDED.get(element.tag, set())
    kinds = {each.attrib["id"]: each.attrib["type"] for each in root.iter("component")}
    assert [*kinds] == [str(number) for number in range(1, len(kinds) + 1)]
    for relation in root.iter("relation"):
        roles, permitted = RELATIONS[relation.attrib["type"]]
        refs = relation.findall("ref")
        assert tuple(each.attrib["role"] for each in refs) == roles
        assert [each.attrib["hint"] for each in refs] == [kinds[each.attrib["id"]] for each in refs]
        short = ("gear" if each.attrib["hint"] in ("cylindrical_gear", "ring_gear") else each.attrib["hint"] for each in refs)
        assert tuple(short) in permitted
    known = units()
    for component in root.iter("component"):
        kind = "cylindrical_gear" if component.attrib["type"] == "ring_gear" else component.attrib["type"]
        for each in component:
            name = each.attrib["id"]
            if not name.startswith("custom_"):
                assert known[kind, name] == each.attrib["unit"], (kind, name)
    return root


def test_files_hold_what_the_database_of_rexs_permits() -> None:
    designs = [*(read_spec(TEMPLATES / f"{name}.toml") for name in STARTERS), *random_pairs(15, 3), design_of(ON_SHAFTS)]
    written = set[tuple[str, str]]()
    for design in designs:
        root = require_rexs(export_rexs(design).text)
        parts = [(each.attrib["type"], part.attrib["id"]) for each in root.iter("component") for part in each]
        written |= {(kind, name) for kind, name in parts if not name.startswith("custom_")}
    assert len(written) > 110


def test_names_with_signs_of_xml_and_a_fixed_date(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    gear = Gear(teeth=20, normal_module=2, face_width=20, name="a & 'c' é")
    first, second = export_rexs(gear), export_rexs(gear)
    assert first.text == second.text and 'date="1970-01-02T00:00:00+00:00"' in first.text
    assert "name=\"a &amp; 'c' é\"" in first.text


# ---------------------------------------------------------------- meaning of the numbers


class OtherProgram:
    """A reader that knows the specification of REXS and nothing of gearcad: all in SI units."""

    SI: ClassVar = {
        **{"mm": 1e-3, "N": 1.0, "N m": 1.0, "N / m": 1.0, "N / mm^2": 1e6, "none": 1.0, "deg": math.pi / 180, "kN": 1e3},
        **{"1 / min": 2 * math.pi / 60, "kg / dm^3": 1e3, "mum": 1e-6, "N mm / rad": 1e-3},
    }

    def __init__(self, text: str) -> None:
        root = ElementTree.fromstring(text)
        self.parts = {each.attrib["id"]: each for each in root.iter("component")}
        self.relations = [(r.attrib["type"], {f.attrib["role"]: f.attrib["id"] for f in r}) for r in root.iter("relation")]

    def value(self, number: str, name: str) -> float:
        (found,) = [each for each in self.parts[number] if each.attrib["id"] == name]
        return float(found.text or "") * self.SI[found.attrib["unit"]]

    def vector(self, number: str, name: str) -> list[float]:
        (found,) = [each for each in self.parts[number] if each.attrib["id"] == name]
        return [float(each.text or "") * self.SI[found.attrib["unit"]] for each in found.iter("c")]

    def related(self, kind: str, role: str, number: str, other: str) -> list[str]:
        return [roles[other] for name, roles in self.relations if name == kind and roles[role] == number]

    def of_kind(self, kind: str) -> list[str]:
        return [number for number, each in self.parts.items() if each.attrib["type"] == kind]


def test_another_program_finds_the_same_deflection_of_a_shaft() -> None:
    """A beam on two springs under a force in its middle: closed form with shear, from the numbers of the file alone."""
    design = design_of(ON_SHAFTS)
    assert isinstance(design, PairDesign) and design.shafts is not None
    file = OtherProgram(export_rexs(design).text)
    shaft = file.of_kind("shaft")[0]
    (section,) = [each for each in file.related("assembly", "assembly", shaft, "part") if each in file.of_kind("shaft_section")]
    outer, inner = (file.value(section, f"{side}_diameter_begin") for side in ("outer", "inner"))
    (steel,) = file.related("reference", "origin", shaft, "referenced")
    modulus, nu = file.value(steel, "elastic_modulus"), file.value(steel, "poisson_ratio")
    bearings = file.related("side", "inner_part", shaft, "assembly")
    places = [
        file.value(each, "u_coordinate_on_shaft_outer_side") - file.vector(shaft, "support_vector")[0] for each in bearings
    ]
    assert places == [file.value(each, "u_coordinate_on_shaft_inner_side") for each in bearings]
    loads = [each for each in file.related("assembly", "assembly", shaft, "part") if each in file.of_kind("external_load")]
    (load,) = [each for each in loads if "force_w_direction" in {part.attrib["id"] for part in file.parts[each]}]
    force, span = file.value(load, "force_w_direction"), places[1] - places[0]
    assert file.value(load, "u_coordinate_on_shaft") == pytest.approx(places[0] + span / 2)
    inertia, area = math.pi / 64 * (outer**4 - inner**4), math.pi / 4 * (outer**2 - inner**2)
    m = (inner / outer) ** 2
    kappa = 6 * (1 + nu) * (1 + m) ** 2 / ((7 + 6 * nu) * (1 + m) ** 2 + (20 + 12 * nu) * m)
    shear = force * span / (4 * kappa * area * modulus / (2 * (1 + nu)))
    springs = force / sum(file.value(each, "radial_stiffness") for each in bearings)
    deflection = force * span**3 / (48 * modulus * inertia) + shear + springs
    own = design.shafts.gears.pick(Role.PINION).shaft.solve().at(200.0)
    assert own[0] * 1e-3 == pytest.approx(deflection, rel=1e-9)
    assert deflection == pytest.approx(0.6722e-3, rel=1e-3)  # 663.7 + 5.3 + 3.2 µm


def test_another_program_finds_the_power_and_the_place_of_the_wheel() -> None:
    """15 kW at 1500 rpm; the wheel lies 30 degrees from x towards y, which is -v."""
    design = design_of(ON_SHAFTS)
    assert isinstance(design, PairDesign)
    file = OtherProgram(export_rexs(design).text)
    first, second = file.of_kind("shaft")
    (torque,) = [
        file.value(load, "torque_around_u_axis")
        for load in file.of_kind("external_load")
        if any(part.attrib["id"] == "torque_around_u_axis" and float(part.text or "0") for part in file.parts[load])
    ]
    assert torque * file.value(first, "rotational_speed") == pytest.approx(15000.0, rel=1e-12)
    (stage,) = file.of_kind("cylindrical_stage")
    distance = file.value(stage, "center_distance")
    assert distance == pytest.approx(0.060)
    turned = -file.value(stage, "rotating_angle_around_neg_u_axis")
    assert math.degrees(turned) == pytest.approx(30.0)
    away = [
        there - here for here, there in zip(*(file.vector(each, "support_vector") for each in (first, second)), strict=True)
    ]
    assert away == pytest.approx([0.040 - 0.030, distance * -math.sin(-turned) * -1, distance * math.cos(turned)])
    rolling = file.of_kind("rolling_bearing_with_catalog_geometry")[0]
    assert file.value(rolling, "radial_dynamic_load_rating") == 31000.0


def test_another_program_finds_the_teeth() -> None:
    """Diameters from the numbers of the file by ISO 21771: reference, tip, root, and the tool's addendum."""
    design = read_spec(TEMPLATES / "reducer-21-43.toml")
    file = OtherProgram(export_rexs(design).text)
    for number, gear in zip(file.of_kind("cylindrical_gear"), design.gears.values(), strict=True):
        module, teeth = file.value(number, "normal_module"), file.value(number, "number_of_teeth")
        left = file.related("flank", "gear", number, "left")[0]
        (tool,) = file.related("manufacturing_step", "workpiece", left, "tool")
        shift = file.value(left, "addendum_modification_coefficient")
        root = teeth * module - 2 * module * (file.value(tool, "addendum_coefficient_reference_profile") - shift)
        thinning = (shift - file.value(left, "addendum_modification_coefficient_after_finishing")) * 2 * module
        assert thinning * math.tan(file.value(left, "normal_pressure_angle")) == pytest.approx(gear.tooth_thinning * 1e-3)
        assert file.value(number, "root_diameter") == pytest.approx(root, rel=1e-12)
        assert file.value(number, "tip_diameter") * 1e3 == pytest.approx(gear.tip_diameter, rel=1e-12)
        (relief,) = [
            each for each in file.related("reference", "origin", left, "referenced") if each in file.of_kind("tip_relief")
        ]
        assert file.value(relief, "tip_relief_depth") == pytest.approx(18e-6)


# ---------------------------------------------------------------- files of others


def test_a_gear_unit_of_another_program() -> None:
    """Two stages on three shafts, REXS 1.4: power flow by hand, 567 N m at 543 rpm, 27:51 and 23:34."""
    found = import_rexs(DATA / "rexs_gear_unit.rexs")
    assert (found.version, found.application) == ("1.4", "Other")
    assert found.told == ("load cases: the first of 2 is taken",)
    first, second = (each.design for each in found.specs)
    assert isinstance(first, PairDesign) and isinstance(second, PairDesign)
    assert [each.name for each in found.specs] == ["First-stage", "Second-stage"]
    assert first.load is not None and (first.load.torque, first.load.speed) == (567.0, 543.0)
    assert second.load is not None
    assert (second.load.torque, second.load.speed) == pytest.approx((-567.0 * 51 / 27, -543.0 * 27 / 51))
    assert (first.pair.pinion.teeth, first.pair.wheel.teeth, first.pair.centre_distance) == (27, 51, 190.0)
    assert (second.pair.pinion.helix_angle, second.pair.wheel.helix_angle) == (-10.0, 10.0)
    assert second.materials.pinion.youngs_modulus == 210000.0 and second.materials.pinion.density == 7850.0
    told = found.specs[1].told
    assert any(line.startswith("pinion.tip_diameter = 1 mm is left out: ") for line in told)
    assert second.shafts is not None and first.shafts is None
    middle = second.shafts.gears.pinion.shaft
    assert [each.outer_diameter for each in middle.segments] == [80.0, 90.0, 80.0]
    assert [(each.position, each.pushes) for each in middle.bearings] == [(20.0, "right"), (250.0, "left")]
    (force,) = second.shafts.gears.wheel.shaft.forces
    assert (force.position, tuple(force.force)) == (200.0, (0.0, -123.0, 0.0))


def test_what_another_program_changed_is_taken_over(tmp_path: Path) -> None:
    text = export_rexs(read_spec(TEMPLATES / "volvo-13-44.toml")).text
    before = '<attribute id="tip_diameter" unit="mm">'
    at = text.index(before) + len(before)
    path = tmp_path / "changed.rexs"
    path.write_text(f"{text[:at]}42.0{text[text.index('<', at) :]}", encoding="utf-8")
    (spec,) = import_rexs(path).specs
    assert spec.design.gears["pinion"].tip_diameter == 42.0
    assert len(spec.told) == 1 and spec.told[0].startswith("pinion.tip_diameter = 42 mm is that of the file")


def test_other_kinds_of_designs_are_refused_in_one_line() -> None:
    with pytest.raises(ParameterError, match=r"^kind = 'rack_pair': must be a gear or a pair: planetary sets, racks"):
        export_rexs(read_spec(TEMPLATES / "rack.toml"))
