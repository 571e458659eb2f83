"""Assembly of gearboxes: exact outlines, tooth positions counted in whole numbers, phases by cut flanks, and single trains."""

import math
import random
import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from support.gearboxes import box_of, meshing_planets, of_train, ravigneaux
from support.planetary import clearance, contacts
from support.planetary_trains import TRAINS

import gearcad
from gearcad.cli import main
from gearcad.core.errors import GeometryError
from gearcad.designs import PlanetaryGearboxDesign
from gearcad.designs.reader import starter_text
from gearcad.planetary import Central, Drive, GearPlace, Rim, SetMesh, mesh_phases
from gearcad.planetary.gearbox import Gearbox, GearboxState
from gearcad.planetary.gearbox_assembly import SetAssembly

CHORD = 2e-3
"""What chords of outlines may take off a clearance (mm)."""


def _mates(assembly: SetAssembly, planets: int) -> list[tuple[str, str, str]]:
    """Names of the gears of each mesh of each planet, and that of the mesh."""
    centrals = {each.name for each in assembly.subject.centrals}
    return [
        (mesh.first if mesh.first in centrals else f"{mesh.first} {number}", f"{mesh.second} {number}", mesh.name)
        for mesh in assembly.meshes
        for number in range(1, planets + 1)
    ]


def _judge(assembly: SetAssembly, places: dict[str, GearPlace]) -> None:
    """Teeth stand in the middle of spaces: each half of the backlash may be turned away, and no more."""
    for first, second, mesh in _mates(assembly, assembly.gearing.planets):
        one, other = (assembly.gearing.gears[name.split(" ")[0]] for name in (first, second))
        pair = assembly.pairs[mesh]
        height = max(places[first].height, places[second].height)
        role = pair.gears.pinion is other.gear
        working = abs(pair.working_pitch_diameters.pinion if role else pair.working_pitch_diameters.wheel) / 2
        half = math.degrees(pair.circumferential_backlash / 2 / working)
        for turn, free in ((0.0, True), (0.9 * half, True), (-0.9 * half, True), (1.1 * half, False), (-1.1 * half, False)):
            turned = places[second]._replace(rotation=places[second].rotation + turn)
            left = clearance(one.gear, other.gear, (places[first], turned), height)
            assert left > -CHORD if free else left < 0, (first, second, turn, left)


@pytest.mark.parametrize("helix", [0.0, 18.0])
def test_exact_outlines_of_a_ravigneaux_set_have_half_the_backlash_on_either_side(helix: float) -> None:
    each = ravigneaux(26, 19, 34, 20, 3, helix)
    state = GearboxState(name="it", held=("r.large",))
    box = box_of(each, "r.small", "r.ring", state)
    assembly, found = box.assemblies["r"], box.state("it")
    for angle in (0.0, 1234.5):
        places = {name.removeprefix("r."): place for name, place in box.pose(found, angle).items()}
        _judge(assembly, places)
    still = {name: place.rotation for name, place in box.pose().items()}
    assert box.pose(found, 777.0)["r.large"].rotation == still["r.large"]


@pytest.mark.parametrize("kind", ["A helical", "B", "C", "D"])
def test_exact_outlines_of_stepped_sets(kind: str) -> None:
    each = of_train(kind)
    box = box_of(each, "s.a", "s.carrier", GearboxState(name="it", held=("s.b",)))
    assembly = box.assemblies["s"]
    for first, second, mesh in _mates(assembly, assembly.gearing.planets):
        places = {name.removeprefix("s."): place for name, place in box.pose(box.state("it"), 321.0).items()}
        one, other = (assembly.gearing.gears[name.split(" ")[0]].gear for name in (first, second))
        height = max(places[first].height, places[second].height)
        assert clearance(one, other, (places[first], places[second]), height) > -CHORD, mesh


def _teeth_fit(assembly: SetAssembly, planets: int) -> bool:
    gearing = replace(assembly.gearing, planets=planets)
    other = SetAssembly(replace(assembly.subject, gearing=gearing))
    return all(off < 1e-7 for off, _ in other.misfits)


def test_tooth_positions_of_random_ravigneaux_sets_counted_in_whole_numbers() -> None:
    """Planets put in at n/N of a turn see both suns and the ring as the first ones do, but for whole pitches of all."""
    rng, fitting = random.Random(1), 0
    for _ in range(16):
        small, short, large, long = rng.randint(18, 34), rng.randint(17, 24), rng.randint(24, 40), rng.randint(17, 24)
        each = ravigneaux(small, short, large, long, 1)
        try:
            assembly = SetAssembly(each)
            _ = assembly.pairs, assembly.axes
        except GeometryError:
            continue
        ring = large + 2 * long
        for planets in range(1, 9):
            fits = all((ring - small) * n % planets == 0 == (large + small) * n % planets for n in range(planets))
            assert _teeth_fit(assembly, planets) is fits, (small, short, large, long, planets)
            fitting += fits
    assert fitting > 16


def test_a_set_with_two_planets_between_sun_and_ring() -> None:
    """Both turn in one sense: 1 - z_r/z_s between them, and planets fit where N divides z_r - z_s."""
    each = meshing_planets(34, 18, 18, 90, 4)
    box = box_of(each, "s.sun", "s.carrier", GearboxState(name="it", held=("s.ring",)))
    assembly, found = box.assemblies["s"], box.state("it")
    assert found.ratio == pytest.approx(1 - 90 / 34, rel=1e-12)
    places = {name.removeprefix("s."): place for name, place in box.pose(found, 99.0).items()}
    _judge(assembly, places)
    first, second = (assembly.axes[name] for name in ("inner", "outer"))
    apart = abs(complex(first.radius, 0) - second.radius * np.exp(1j * second.angle))
    assert (first.radius, second.radius, apart) == pytest.approx((52.0, 72.0, 36.0), rel=1e-12)
    for planets in range(1, 9):
        assert _teeth_fit(assembly, planets) is ((90 - 34) % planets == 0), planets


@pytest.mark.parametrize("kind", ["A", "B", "C", "D"])
def test_tooth_positions_of_stepped_planets_counted(kind: str) -> None:
    train = TRAINS[kind]
    assembly = SetAssembly(of_train(kind, 1))
    a, b = train.meshes
    za, zb, z1, z2 = a.central.gear.teeth, b.central.gear.teeth, a.rim.gear.teeth, b.rim.gear.teeth
    for planets in range(1, 13):

        def fits(number: int, planets: int = planets) -> bool:
            angle = Fraction(number, planets)  # of a turn, against the carrier
            for pitches in range(z1 * z2):
                turned = Fraction(za, z1) * angle + Fraction(pitches, z1)  # of the planet, central a at rest
                if (z2 * turned - zb * angle).denominator == 1:
                    return True
            return False

        assert _teeth_fit(assembly, planets) is all(fits(number) for number in range(planets)), planets


@pytest.mark.parametrize("kind", ["A", "A helical", "B", "C", "D"])
@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("turning", [1, -1])
def test_phases_are_those_of_a_planetary_train(kind: str, sense: int, turning: int) -> None:
    train, assembly = TRAINS[kind], SetAssembly(of_train(kind))
    wanted = mesh_phases(train, Drive(sense=sense, turning=turning))
    same = 1 if train.basic_ratio > 0 else -1
    for number, mesh in enumerate(train.meshes):
        outer = 1 if mesh.external else -1
        own, turns = (sense, turning) if number == 0 else (-same * sense, same * turning)
        part = next(each for each in assembly.meshes if each.first == mesh.central.name)
        found = assembly.phases(part, side=own * outer, turning=-turns * outer)
        assert found.left_flanks is wanted[mesh.name].left_flanks
        for one, other in zip(found.relative, wanted[mesh.name].relative, strict=True):
            assert abs((one - other + 0.5) % 1 - 0.5) < 1e-9, (kind, mesh.name)


@pytest.mark.parametrize("held", ["r.large", "r.carrier"])
@pytest.mark.parametrize("entering", ["r.small", "r.ring"])
def test_phases_of_planets_that_mesh_with_planets_by_cut_flanks(held: str, entering: str) -> None:
    each = ravigneaux(26, 19, 34, 20, 3)
    leaving = "r.ring" if entering == "r.small" else "r.small"
    box = box_of(each, entering, leaving, GearboxState(name="it", held=(held,)))
    found, assembly, places = box.state("it"), box.assemblies["r"], box.pose()
    phases = box.phases(found)
    for mesh in assembly.meshes:
        told, pair = phases[f"r.{mesh.name}"], assembly.pairs[mesh.name]
        assert told is not None
        if pair.wheel.internal:
            continue  # held against planetary trains
        first, second = (assembly.gearing.gears[name].gear for name in mesh)
        posed = SetMesh(
            central=Central(name="c", gear=second, meshes="p"), rim=Rim(name="p", gear=first), pair=pair
        )  # that on the second's axis
        own = found.planet_speeds[f"r.{mesh.second}"] - found.speeds["r.carrier"]
        torque = found.mesh_torques[f"r.{mesh.name}"]
        assert torque is not None
        driver = posed.rim_role if torque * own > 0 else posed.central_role
        for number, ahead in enumerate(told.ahead):
            one = places[f"r.{mesh.first}" if f"r.{mesh.first}" in places else f"r.{mesh.first} {number + 1}"]
            other = places[f"r.{mesh.second} {number + 1}"]
            psi = math.atan2(one.y - other.y, one.x - other.x)
            cut = contacts(posed, angle=math.radians(other.rotation), psi=psi, driver=driver, turning=1 if own > 0 else -1)
            off = (cut.ahead / (math.pi * second.base_diameter / second.teeth) - ahead + 0.5) % 1 - 0.5
            assert np.abs(off).max() < 1e-6, (mesh, number)


@pytest.mark.parametrize("name", ["ravigneaux", "simpson"])
def test_starters(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("it.toml").write_text(starter_text(name)[1], encoding="utf-8")
    design = gearcad.read("it.toml")
    assert isinstance(design, PlanetaryGearboxDesign)
    document = gearcad.planetary(design)
    assert len(document.states) == len(design.gearbox.states)
    for each in design.gearbox.assemblies.values():
        assert max(off for off, _ in each.misfits) < 1e-9 and min(one.distance for one in each.clearances) > 1
        for pair in each.pairs.values():
            assert pair.circumferential_backlash > 0.05
        assert not [notice for notice in design.notices if notice.code != "form-root" and "form root" not in notice.text]
        places = {own.removeprefix(f"{each.subject.name}."): place for own, place in design.gearbox.pose().items()}
        _judge(each, places)
    done = CliRunner().invoke(main, ["planetary", "it.toml"])
    assert done.exit_code == 0 and "backlash" in done.stdout and "at least" in done.stdout
    sheet = CliRunner().invoke(main, ["data", "it.toml"])
    assert sheet.exit_code == 0 and "circumferential backlash" in sheet.stdout


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "planets = 3 ",
            "planets = 4 ",
            r"planets = 4: must keep long 1 and short 4 apart: .*; planets = 1 or 2 or 3 would do",
        ),
        (
            "teeth = 26",
            "teeth = 25",
            r"planets = 3: must let the teeth fit: those of planet 2 are 0\.3333 pitches off in \S+; planets",
        ),
        ("axial_position = 26.0", "axial_position = 21.0", r"large\.axial_position = 21 mm: must keep small and large apart"),
        ("teeth = 19", "teeth = 19\nmate_distance = 80.0", r"short\.mate_distance = 80 mm: must be from 6\.75 to 74\.25 mm"),
        ("teeth = 20\n", "teeth = 20\nclocking = 400.0\n", r"planetary\.set\[0\]\.planet\[0\]\.clocking = 400 deg: must be"),
        (
            "small = { teeth = 26",
            "small = { face_widht = 1, teeth = 26",
            r"set\[0\]\.small\.face_widht: unknown key; did you mean face_width\?",
        ),
        (
            "small = { teeth = 26",
            "small = { clocking = 1, teeth = 26",
            r"clocking: unknown key here; it belongs to a planet",
        ),
        ("normal_module = 1.5 ", "", r"normal_module is missing"),
        ("planets = 3 ", "", r"planetary\.set\[0\]\.planets is missing"),
        ("axial_position = 27.0", "axial_position = 60.0", r"axial_position = 60 mm: must bring it to the height of long"),
        ("teeth = -74", "teeth = -72", r"planetary\.set\[0\]\.ring-long\.centre_distance"),
    ],
)
def test_gears_that_do_not_go_together_are_one_line(
    old: str, new: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    text = starter_text("ravigneaux")[1]
    assert old in text
    Path("it.toml").write_text(text.replace(old, new, 1), encoding="utf-8")
    done = CliRunner().invoke(main, ["planetary", "it.toml"])
    assert done.exit_code == 2 and re.search(message, done.stderr), done.stderr
    assert done.stderr.startswith("Error: it.toml") and done.stderr.count("\n") == 1


def test_sets_stand_one_behind_the_other_or_do_not_pass_through_each_other() -> None:
    each = ravigneaux(26, 19, 34, 20, 3)
    state = GearboxState(name="it", held=("r.large", "b.small", "b.large"))

    def box(at: float | None) -> Gearbox:
        assert each.gearing is not None
        other = replace(each, name="b", gearing=replace(each.gearing, axial_position=at))
        return Gearbox(name="box", sets=(each, other), input="r.small", output="r.ring", states=(state,))

    assert box(None).bottoms == {"r": 0.0, "b": 50.0} and box(45.0).bottoms["b"] == 45.0
    with pytest.raises(GeometryError, match=r"b\.axial_position = 44\.9 mm: must keep r\.large and b\.small apart"):
        box(44.9)
