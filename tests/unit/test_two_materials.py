"""A material for each gear: in specs, tables, studies and Python, in ratings, and between finite elements."""

import math
import re
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest

import gearcad
from gearcad import BasicRack, Body, Gear, GearPair, Load, Material, ParameterError
from gearcad.check.options import CheckOptions
from gearcad.check.task import check_task
from gearcad.contact.plane.pair import plane_pair
from gearcad.core.errors import SpecError
from gearcad.core.records import PerGear
from gearcad.decks.plane import PlaneDecks
from gearcad.designs import PairDesign, PlanetaryDesign, design_from_tables, open_table, read_spec
from gearcad.designs.spec_writers import pair_text
from gearcad.designs.table import fault_alone, permitted_alone
from gearcad.designs.variations import column_of_train, column_symbol, read_variants
from gearcad.material import MaterialGroup, MaterialQuality
from gearcad.rating import DynamicFactor, RatingOptions, RunningIn, rate, running_in_alpha
from gearcad.rating.contact_stress import peak_pressure
from gearcad.stiffness.methods import METHODS

CAST_IRON = Material(name="GG-20", youngs_modulus=118000.0, poisson_ratio=0.3)
HERTZ_AWAY = 2e-3  # of the greatest pressure: cells, and curvature that changes over the contact

SPEC = """
[pair]
normal_module = 3.0
face_width = 25.0
flank_roughness = 4.8
accuracy_grade = 7
[pinion]
teeth = 21
accuracy_grade = 6
[wheel]
teeth = 43
[material]
pinion = "Eh MQ"
wheel = "V MQ"
density = 7800
[wheel.material]
hardness = 300
[load]
torque = 200.0
speed = 1450.0
[rating]
load_cycles = [1e7, 5e6]
spectrum = [[0.1, 1.25], [0.9, 0.8]]
pitting_permitted = true
"""


def pair(*, width: float = 14.0) -> GearPair:
    gears = [
        Gear(teeth=teeth, normal_module=4.5, profile_shift=shift, face_width=width, body=Body(bore=30.0))
        for teeth, shift in ((16, 0.1817), (24, 0.1715))
    ]
    return GearPair(pinion=gears[0], wheel=gears[1])


def read(text: str) -> PairDesign:
    design = design_from_tables(tomllib.loads(text), where=lambda key: key, default_name="two")
    assert isinstance(design, PairDesign)
    return design


def test_spec_of_both_gears() -> None:
    design = read(SPEC)
    pinion, wheel = design.materials
    assert pinion == Material(name="Eh MQ", density=7800.0)
    assert wheel == Material(name="V MQ", density=7800.0, hardness=300.0)
    assert design.pair.gears.map(lambda gear: gear.accuracy_grade) == (6, 7)
    assert design.pair.wheel.flank_roughness == 4.8
    assert design.rating is not None and [each.torque for each in design.rating.bins] == [1.25, 0.8]
    document = design.to_dict()
    assert "material" not in document and document["materials"]["wheel"]["quality"] == "MQ"
    assert read(pair_text(design)) == replace(design, pair=replace(design.pair, name="two"))


@pytest.mark.parametrize(
    ("common", "own", "expected"),
    [
        ('name = "Eh MQ"', 'quality = "ME"', Material(group=MaterialGroup.CASE_HARDENED, quality=MaterialQuality.HIGH)),
        ('group = "V"\nquality = "ML"', 'name = "Eh MQ"', Material(name="Eh MQ")),
        ('wheel = "V ML"\nhardness = 210', "hardness = 220", Material(name="V ML", hardness=220.0)),
        ('name = "20MnCr5"\ngroup = "Eh"', "", Material(name="20MnCr5", group=MaterialGroup.CASE_HARDENED)),
    ],
)
def test_own_counts_before_common(common: str, own: str, expected: Material) -> None:
    text = SPEC.partition("[material]")[0] + f"[material]\n{common}\n[wheel.material]\n{own}\n"
    assert read(text).materials.wheel == expected


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"V MQ"', '"V MX"', "material.wheel = 'V MX': must be a group and a quality of ISO 6336-5, such as \"Eh MQ\""),
        ("wheel = ", "sun = ", "material.sun: unknown key"),
        ("wheel = ", "rack = ", "material.rack: is the material of one gear among several; those here are pinion and wheel"),
        ("hardness = 300", "hardness = -3", "wheel.material.hardness = -3: must be a number at least 50"),
        ("hardness = 300", "hardnes = 300", "wheel.material.hardnes: unknown key; did you mean material.hardness?"),
        ("density = 7800", "density = 0", "material.density = 0 kg/m³: must be a number at least 0.001"),
        ("hardness = 300", 'name = "V ME"\nquality = "MQ"', "wheel.material.quality = 'MQ': must be ME, or left out"),
        ("accuracy_grade = 7", "accuracy_grade = 13", "pair.accuracy_grade = 13: must be a whole number from 0 to 12"),
        ("accuracy_grade = 7", 'tooth_allowance = "cd35"', "pair.tooth_allowance = 'cd35': must be a letter a to h"),
        ("[1e7, 5e6]", "[1e7]", "rating.load_cycles = [10000000.0]: must be a number for both gears, or a list [pinion"),
        ("[0.9, 0.8]", "[0.8, 0.8]", "must have shares of life that add up to 1, here 0.9"),
        ("[0.9, 0.8]", "[0.9, nan]", "rating.spectrum"),
        ("= true", "= 1", "rating.pitting_permitted = 1: must be true or false"),
        ("[rating]", '[rating]\ndynamic_factor = "D"', "must be a number at least 0.1 and at most 100, or \"B\" or \"C\""),
        ("[rating]", "[rating]\noil_temperature = 70", "rating.oil_viscosity_40 is missing: must be given, in mm²/s at 40 °C"),
    ],
)  # fmt: skip
def test_faults_are_one_line(old: str, new: str, message: str) -> None:
    with pytest.raises(SpecError) as caught:
        read(SPEC.replace(old, new, 1))
    assert message in str(caught.value) and "\n" not in str(caught.value)


def test_single_gears_have_one_material() -> None:
    gear = "[gear]\nteeth = 20\nnormal_module = 2.0\nface_width = 20.0\n"
    for more in ('[material]\npinion = "Eh MQ"', 'material.name = "Eh MQ"'):
        with pytest.raises(SpecError):
            design_from_tables(tomllib.loads(gear + more), where=str, default_name="one")


def test_columns_of_a_table(tmp_path: Path) -> None:
    path = tmp_path / "it.csv"
    path.write_text(
        "name;normal_module;face_width;pinion.teeth;wheel.teeth;material.pinion;wheel.material.name;wheel.material.hardness;"
        "rating.spectrum;rating.load_cycles;rating.pitting_permitted;rating.dynamic_factor\n"
        "a;3;25;21;43;Eh MQ;V MQ;300;0,1:1,25 0,9:0,8;1e7 5e6;true;C\n"
        "b;3;25;21;43;;;;;1e7;false;1,1\n",
        encoding="utf-8",
    )
    first, second = (row.design() for row in open_table(path).rows())
    assert isinstance(first, PairDesign) and isinstance(second, PairDesign)
    assert first.materials == PerGear(Material(name="Eh MQ"), Material(name="V MQ", hardness=300.0))
    expected = RatingOptions(
        spectrum=((0.1, 1.25), (0.9, 0.8)), load_cycles=(1e7, 5e6), pitting_permitted=True, dynamic_factor="C"
    )
    assert first.rating == expected
    assert second.material is None and second.rating == RatingOptions(load_cycles=1e7, dynamic_factor=1.1)


def test_columns_of_results_are_known() -> None:
    for heading in ("materials.wheel.hardness", "wheel.material.hardness", "material.hardness"):
        found = column_symbol(heading)
        assert found is not None and found[1].words.startswith("hardness of the flanks")
    assert (column_of_train("materials.sun.youngs_modulus") or ("",))[0] == "sun"


def test_names_are_tried_alone_as_those_of_a_pair() -> None:
    assert permitted_alone("material.wheel", "V MQ") and permitted_alone("material.rack", "V MQ")
    fault = fault_alone("material.wheel", "V MX", where=str)
    assert fault is not None and 'such as "Eh MQ"' in str(fault)


def test_values_of_a_study(tmp_path: Path) -> None:
    path = tmp_path / "it.toml"
    path.write_text(SPEC, encoding="utf-8")
    varied = read_variants(path, ["wheel.material.hardness=250,350", "material.pinion=Eh MQ,Eh ME", "rating.load_cycles=1000"])
    designs = [design for design in varied.designs if isinstance(design, PairDesign)]
    assert [design.materials.wheel.hardness for design in designs] == [250.0, 250.0, 350.0, 350.0]
    assert [design.materials.pinion.name for design in designs] == ["Eh MQ", "Eh ME"] * 2
    assert designs[0].rating is not None and designs[0].rating.load_cycles == 1000.0
    varied = read_variants(path, ["rating.spectrum=1:0.8,0.5:1 0.5:2:0.5"])
    assert isinstance(varied.designs[1], PairDesign) and varied.designs[1].rating is not None
    assert varied.designs[1].rating.spectrum == ((0.5, 1.0), (0.5, 2.0, 0.5))


def test_gears_of_a_train(tmp_path: Path) -> None:
    path = tmp_path / "it.toml"
    path.write_text(
        '[planetary]\nplanets = 3\ninput = "sun"\noutput = "carrier"\nfixed = "ring"\nnormal_module = 2.0\nface_width = 20.0\n'
        '[sun]\nteeth = 24\n[planet]\nteeth = 21\nmaterial.density = 7000\n[ring]\nteeth = -66\n[material]\nsun = "Eh MQ"\n',
        encoding="utf-8",
    )
    design = read_spec(path)
    assert isinstance(design, PlanetaryDesign) and isinstance(design.material, dict)
    assert design.material == {"sun": Material(name="Eh MQ"), "planet": Material(density=7000.0), "ring": Material()}
    assert set(design.to_dict()["materials"]) == {"sun", "planet", "ring"}


def test_python_takes_both() -> None:
    both = PerGear(Material(), CAST_IRON)
    found = gearcad.rate(pair(), Load(torque=100), material=both).nominal
    # Z_E of steel on GG-20 is printed as 162.0 sqrt(MPa) in DIN 3990-2, table 1; xi is 2 E1 E2/((E1 + E2) E_St).
    assert found.flank.elasticity_factor == pytest.approx(162.0, abs=0.05)
    assert found.stiffness.material_factor == pytest.approx(2 * 118 * 206 / (118 + 206) / 206, rel=1e-12)
    swapped = gearcad.rate(pair(), Load(torque=100), material=PerGear(CAST_IRON, Material()))
    assert swapped.nominal.contact_stresses == found.contact_stresses
    with pytest.raises(ParameterError, match=r"wheel\.material = 3: must be a Material"):
        gearcad.rate(pair(), Load(torque=100), material=PerGear(Material(), 3))  # type: ignore[type-var]


def test_iron_as_stiff_as_steel_is_told() -> None:
    iron = replace(CAST_IRON, group=MaterialGroup.GREY_IRON)
    for material, told in ((Material(name="GG MQ"), True), (iron, False), (Material(name="V MQ"), False)):
        codes = [notice.code for notice in rate(pair(), PerGear(Material(), material), Load(torque=100)).notices]
        assert ("modulus-of-steel" in codes) is told


def test_own_grades_of_deep_teeth() -> None:
    """Y_DT counts from grade 4 on, of the coarser gear."""
    rack = BasicRack(addendum=1.4, dedendum=1.6, root_radius=0.2)
    deep = pair().gears.map(lambda gear: replace(gear, teeth=3 * gear.teeth, profile_shift=0.0, rack=rack))
    found = []
    for grades in ((None, None), (4, 4), (4, 6)):
        pinion, wheel = (replace(gear, accuracy_grade=grade) for gear, grade in zip(deep, grades, strict=True))
        own = GearPair(pinion=pinion, wheel=wheel)
        found.append(rate(own, Material(), Load(torque=100)).roots.pinion.deep_tooth_factor)
    assert found[1] < 1 and (found[0], found[2]) == (1.0, 1.0)


def test_one_material_twice_is_one_material() -> None:
    for material in (Material(), CAST_IRON):
        one, two = (rate(pair(), each, Load(torque=100)) for each in (material, PerGear(material, material)))
        assert one.to_dict() == two.to_dict()


def test_flanks_of_two_materials_run_in_by_the_mean() -> None:
    hard, soft = (Material(name=name, hardness=hardness) for name, hardness in (("Eh MQ", 700.0), ("V MQ", 300.0)))
    options, inertias = RatingOptions(accuracy_grade=8), PerGear(1e-3, 5e-3)
    factor = DynamicFactor.of(pair(), PerGear(hard, soft), Load(torque=100), inertias, options)
    alone = [DynamicFactor.of(pair(), each, Load(torque=100), inertias, options) for each in (hard, soft)]
    # y_alpha of V by sigma_Hlim 766.9 MPa of ISO 6336-5
    left = factor.pitch_deviation - float(running_in_alpha(factor.pitch_deviation, RunningIn.THROUGH_HARDENED, 3.0, 766.9))
    speed = 3.0 / (math.pi * factor.reference_diameter) * 60_000
    assert alone[1].effects(speed)[0] == pytest.approx(factor.single_stiffness / factor.specific_load * left, rel=1e-12)
    for mixed, *single in zip(factor.effects(speed)[:2], *(each.effects(speed)[:2] for each in alone), strict=True):
        assert float(mixed) == pytest.approx(sum(map(float, single)) / 2, rel=1e-12)


@pytest.mark.parametrize(
    ("wheel", "expected"),
    [
        (Material(name="V MQ"), {"gears": ("2.060000000000e+05", ["pinion", "wheel"])}),
        (
            CAST_IRON,
            {"gears_pinion": ("2.060000000000e+05", ["pinion"]), "gears_wheel": ("1.180000000000e+05", ["wheel"])},
        ),
    ],
)
def test_decks_have_the_elasticity_of_each_gear(
    wheel: Material, expected: dict[str, tuple[str, list[str]]], tmp_path: Path
) -> None:
    """Sections are of the material of their gear; gears of one elasticity have one material."""
    task = check_task(pair(), PerGear(Material(name="Eh MQ"), wheel), Load(torque=100), CheckOptions(body_teeth=3))
    PlaneDecks(task).at(0.0).write(tmp_path / "pair.inp")
    text = (tmp_path / "pair.inp").read_text()
    moduli = dict(re.findall(r"\*MATERIAL, NAME=(\w+)\n\*ELASTIC\n(\S+), 3\.0+e-01\n", text))
    sections = re.findall(r"\*SOLID SECTION, ELSET=(\w+), MATERIAL=(\w+)\n", text)
    found: dict[str, tuple[str, list[str]]] = {name: (modulus, []) for name, modulus in moduli.items()}
    for part, name in sections:
        found[name][1].append(part.partition("_")[0])
    assert found == expected


@pytest.mark.parametrize(
    ("steel", "mate", "torque"),
    [
        (Material(), CAST_IRON, 100.0),
        (Material(youngs_modulus=210000.0), Material(group="plastic", youngs_modulus=4156.0, poisson_ratio=0.34), 3.0),  # type: ignore[arg-type]
    ],
)
def test_sections_of_two_materials_press_as_hertz_has_it(steel: Material, mate: Material, torque: float) -> None:
    model = plane_pair(pair(), PerGear(steel, mate))
    found = model.solve(0.0, torque)
    (contact,), (force,), (pressures,) = found.pairs, found.forces, found.pressures
    modulus = 1 / sum((1 - each.poisson_ratio**2) / each.youngs_modulus for each in (steel, mate))
    assert pressures.max() == pytest.approx(peak_pressure(float(force), contact.radius, modulus), rel=HERTZ_AWAY)


@pytest.mark.parametrize("name", ["potential-energy", "weber-banaschek", "iso6336"])
def test_stiffness_lies_between(name: str) -> None:
    """Compliances of two gears add up: those of unlike pairs, to what two alike have, but for the logarithm of contact."""
    materials = [Material(), CAST_IRON, PerGear(Material(), CAST_IRON), PerGear(CAST_IRON, Material())]
    steel, iron, *mixed = (1 / METHODS[name](pair=pair(), material=each)(Load(torque=100)).mean for each in materials)
    assert sum(mixed) == pytest.approx(steel + iron, rel=0.02)
    assert all(steel < each < iron for each in mixed)
