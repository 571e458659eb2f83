"""What would cut a gear: which tools fit, the roots that they leave, and how far these are from the one that is asked for."""

import json
import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.spatial import cKDTree

from gearcad import ISO53_D, BasicRack, Gear, GearPair, Load, Material, PerGear, identify, rate, tools
from gearcad.cli import main
from gearcad.core.errors import ParameterError, SpecError
from gearcad.core.shelf_tables import Place
from gearcad.designs.reader import read_spec, starter_text
from gearcad.geometry.curves import CurveKind
from gearcad.geometry.tool_outlines import fillet_distance, with_tool
from gearcad.geometry.tool_tables import ShelfTool
from gearcad.jobs.searches import pair_spec
from gearcad.jobs.tools import ShelfTools, ToolChoice, ToolChoices
from gearcad.rating import RatingOptions
from gearcad.sizing import SizeTask, search_pairs

HEADING = "name,normal_module,rack.pressure_angle,rack.dedendum,rack.root_radius,cutter.teeth,cutter.tip_radius\n"


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder to work in, and a user without a table."""
    monkeypatch.setattr("gearcad.geometry.tool_shelf.user_table", lambda: tmp_path / "config" / "tools.csv")
    monkeypatch.chdir(tmp_path)
    yield tmp_path


def gear(**changes: object) -> Gear:
    return Gear(**{"teeth": 40, "normal_module": 3.0, "face_width": 20.0, "profile_shift": 0.1} | changes)


def hob(dedendum: float = 1.25, radius: float = 0.38, angle: float = 20.0, module: float | None = None) -> ShelfTool:
    rack = BasicRack(pressure_angle=angle, dedendum=dedendum, root_radius=radius)
    return ShelfTool(name="hob", place=Place.DESIGN, file="tools.csv", row=2, normal_module=module, rack=rack)


def choices(subject: Gear | GearPair, name: str = "gear") -> dict[str, ToolChoice]:
    found = tools(subject)
    assert isinstance(found, ToolChoices)
    return {each.tool.name: each for each in found.gears[name].choices}


def test_the_tool_that_the_gear_has_is_first_and_leaves_the_same_root() -> None:
    found = list(choices(gear(tool="DIN 3972 II")).values())
    assert (found[0].tool.name, found[0].distance, found[0].root_difference) == ("DIN 3972 II", 0.0, 0.0)
    distances = [each.distance for each in found if each.distance is not None]
    assert distances == sorted(distances) and len(distances) >= 6


@pytest.mark.parametrize("deeper", [0.1, -0.05])
def test_roots_of_tools_of_another_depth_are_as_far_apart(deeper: float) -> None:
    """Both root lands are arcs about the axis."""
    one = gear(rack=BasicRack(dedendum=1.25, root_radius=0.3))
    made = with_tool(one, hob(1.25 + deeper, 0.3))
    assert fillet_distance(one.profile, made.profile) == pytest.approx(abs(deeper) * 3, abs=3e-5)
    assert made.root_diameter - one.root_diameter == pytest.approx(-6 * deeper)
    assert made.tip_diameter == one.tip_diameter


@pytest.mark.parametrize(("dedendum", "radius"), [(1.25, 0.2), (1.35, 0.25), (1.167, 0.2)])
def test_the_distance_is_that_of_the_nearest_of_many_points(dedendum: float, radius: float) -> None:
    one = gear(teeth=17, profile_shift=0.3)
    made = with_tool(one, hob(dedendum, radius))
    s = np.linspace(0, 1, 20001)

    def points(of: Gear, *kinds: CurveKind) -> np.ndarray:
        return np.concatenate([curve.points(s) for curve in of.profile.curves if not kinds or curve.kind in kinds])

    root = CurveKind.ROOT, CurveKind.FILLET
    far = [cKDTree(points(b)).query(points(a, *root)[::20])[0].max() for a, b in ((one, made), (made, one))]
    assert fillet_distance(one.profile, made.profile) == pytest.approx(max(far), abs=3e-5)


@pytest.mark.parametrize("helix", [0.0, 21.0])
def test_a_short_lead_hob_leaves_the_root_of_the_gear_that_is_described_by_its_module(helix: float) -> None:
    """The same involute has another module, pressure angle, helix angle and shift: a plain hob cuts that gear."""
    asked = gear(teeth=23, helix_angle=helix, profile_shift=0.25)
    angle = math.radians(17.5)
    module = 3 * math.cos(math.radians(20)) / math.cos(angle)
    base_helix = math.asin(math.sin(math.radians(helix)) * math.cos(math.radians(20)))
    other_helix = math.asin(math.sin(base_helix) / math.cos(angle))
    both = math.radians(asked.transverse_pressure_angle), math.atan(math.tan(angle) / math.cos(other_helix))
    inv = [math.tan(each) - each for each in both]
    half = (math.pi / 2 + 2 * 0.25 * math.tan(math.radians(20))) / 23 + inv[0] - inv[1]
    shift = (half * 23 - math.pi / 2) / (2 * math.tan(angle))
    plain = Gear(
        teeth=23,
        normal_module=module,
        helix_angle=math.degrees(other_helix),
        profile_shift=shift,
        face_width=20,
        tip_diameter=float(asked.tip_diameter),
        rack=BasicRack(pressure_angle=17.5, dedendum=1.3, root_radius=0.4),
    )
    made = with_tool(asked, hob(1.3, 0.4, 17.5, module))
    assert plain.base_diameter == pytest.approx(asked.base_diameter, rel=1e-12)
    assert made.root_diameter == pytest.approx(plain.root_diameter, abs=1e-9)
    assert made.form_diameter == pytest.approx(plain.form_diameter, abs=1e-8)
    radii = np.linspace(plain.root_diameter, plain.tip_diameter, 21) / 2
    assert made.profile.half_angle(radii[1:]) == pytest.approx(plain.profile.half_angle(radii[1:]), abs=1e-8)


def test_tools_of_another_size_are_left_out(here: Path) -> None:
    rows = ["of 3,3,20,1.3,0.3,,", "of 2,2,20,1.3,0.3,,", "steep,3,25,1.2,0.2,,", "near,2.95,17.5,1.3,0.3,,"]
    rows.append(f"lead,{3 * math.cos(math.radians(20)) / math.cos(math.radians(17.5)):.5f},17.5,1.3,0.3,,")
    (here / "tools.csv").write_text(HEADING + "\n".join(rows) + "\n", encoding="utf-8")
    found = choices(gear())
    own = {name for name, each in found.items() if each.tool.place is Place.DESIGN}
    assert own == {"of 3", "lead"}
    assert found["lead"].short_lead is not None and found["of 3"].short_lead is None
    assert "Brown & Sharpe 14.5" not in found


def test_a_ring_is_cut_by_cutters_only(here: Path) -> None:
    (here / "tools.csv").write_text(HEADING + "C25,,20,1.25,0.38,25,0.3\nhob,,20,1.3,0.3,,\n", encoding="utf-8")
    ring = gear(teeth=-70, profile_shift=-0.2)
    assert list(choices(ring)) == ["C25"]
    assert ring.cutter.teeth is None and choices(ring)["C25"].gear.cutter.teeth == 25  # type: ignore[union-attr]


def test_clearances_and_faults_are_those_of_the_pair(here: Path) -> None:
    (here / "tools.csv").write_text(HEADING + "flat,,20,0.9,0.2,,\nround,,20,1.02,0.4,,\n", encoding="utf-8")
    pair = GearPair(pinion=gear(teeth=20), wheel=gear(), centre_distance=90.6)
    found = choices(pair, "wheel")
    for name in ("ISO 53 A", "ISO 53 D"):
        other = GearPair(pinion=pair.pinion, wheel=gear(tool=name), centre_distance=90.6)
        assert found[name].clearance == pytest.approx(other.tip_clearances.pinion)
        assert found[name].holds
    assert found["flat"].faults and found["flat"].clearance is None
    assert found["round"].faults and "fillet interference" in found["round"].faults[0]


def test_a_gear_that_takes_a_listed_name_has_the_listed_root() -> None:
    pair = GearPair(pinion=gear(teeth=20), wheel=gear(), centre_distance=90.6)
    for name, own in (("pinion", pair.pinion), ("wheel", pair.wheel)):
        found = [each for each in choices(pair, name).values() if each.gear is not None]
        assert sum(each.wheel is not None and each.holds for each in found) == 2  # DIN 3972 III and IV
        for each in found:
            made = replace(own, tool=each.tool.name, **({} if each.wheel is None else {"finishing": each.wheel}))
            assert (made.root_diameter, made.form_diameter) == pytest.approx(
                (each.gear.root_diameter, each.gear.form_diameter),
                abs=1e-9,  # type: ignore[union-attr]
            )
            assert fillet_distance(made.profile, each.gear.profile) < 1e-9  # type: ignore[union-attr]


def test_every_fault_of_a_table_is_told_in_a_line(here: Path) -> None:
    (here / "tools.csv").write_text(HEADING + "a,,20,9,0.2,,\nb,,20,1.2,0.2,,\nc,,20,1.2,x,,\n", encoding="utf-8")
    with pytest.raises(SpecError) as told:
        tools()
    first, second = str(told.value).split("\n")
    assert first.startswith("tools.csv row 2 column D (a): rack.dedendum = 9")
    assert second.startswith("tools.csv row 4 column E (c): rack.root_radius = 'x'")


def test_what_has_no_gears_to_cut_is_refused() -> None:
    with pytest.raises(ParameterError, match="must be a GearPair, a Gear"):
        tools(3)  # type: ignore[arg-type]


@pytest.mark.parametrize("starter", ["ground-25-41", "planetary-24-21-66"])
def test_the_command_lists_within_a_hundred_columns_and_as_a_document(starter: str, here: Path) -> None:
    name, text = starter_text(starter)
    (here / name).write_text(text, encoding="utf-8")
    shown = CliRunner().invoke(main, ["tools", name, "--quiet"])
    assert shown.exit_code == 0, shown.output
    assert max(map(len, shown.output.splitlines())) <= 100
    result = CliRunner().invoke(main, ["tools", name, "--json", "--quiet"])
    document = json.loads(result.stdout)
    assert list(document["gears"]) == list(read_spec(name).gears)
    for each in document["gears"].values():
        for found in each["tools"]:
            assert found["holds"] is (found["faults"] == [])
            if found["root_diameter"] is not None:
                assert found["root_difference"] == pytest.approx(found["root_diameter"] - each["root_diameter"])


def test_a_measured_root_names_the_tools_that_leave_it(here: Path) -> None:
    (here / "tools.csv").write_text(HEADING + "shop,2,20,1.31,0.3,,\nother,3,20,1.31,0.3,,\nbad,,20,9,1,,\n", encoding="utf-8")
    made = Gear(teeth=24, normal_module=2.0, face_width=20.0, profile_shift=0.2, tooth_thinning=0.04, tool="shop")
    spans = {count: round(made.inspection.span_measurement(count), 3) for count in (3, 4)}
    read = {"tip_diameter": round(made.tip_diameter, 2), "span": spans, "helix_angle": 0.0}
    assert identify(24, root_diameter=round(made.root_diameter, 2), **read).best.tools == ("shop",)
    assert identify(24, **read).best.tools == ()
    standard = replace(made, tool=None, rack=BasicRack())
    found = identify(24, root_diameter=round(standard.root_diameter, 2), **read).best
    assert set(found.tools) == {f"ISO 53 {each}" for each in "ABC"} | {f"DIN 3972 {each}" for each in ("II", "III", "IV")}
    assert found.to_dict()["tools"] == list(found.tools)


def test_a_search_for_sizes_takes_a_hob_in_place_of_the_rack(here: Path) -> None:
    """Its tip radius goes with the module; the figures of the search are those of the full rating."""
    material = Material(name="Eh MQ")
    task = SizeTask(
        load=Load(torque=100.0, speed=1500.0),
        ratio=2.0,
        materials=PerGear(material, material),
        rating=RatingOptions(life=10_000.0),
        teeth=(18, 18),
        modules=(1.75, 2.25, 3.0),
        helix_angles=(15.0,),
        shifts=(0.3,),
        shift_sums=(0.5,),
    )
    rack = search_pairs(replace(task, rack=ISO53_D), count=3, errors=0)
    hob = search_pairs(replace(task, tool="ISO 53 D"), count=3, errors=0)
    assert [(each.name, each.root_safeties) for each in hob.found] == [(each.name, each.root_safeties) for each in rack.found]
    found = search_pairs(replace(task, tool="DIN 3972 II"), count=3, errors=0).found
    assert len({each.normal_module for each in found}) > 1
    for each in found:
        radius = {1.75: 0.25 / 1.75, 2.25: 0.4 / 2.25, 3.0: 0.2}[each.normal_module]
        assert each.pair().wheel.root_radius == pytest.approx(radius, abs=1e-9)
        rated = rate(each.pair(), task.load, material=material, rating=task.rating)
        assert each.root_safeties == pytest.approx([part.safety for part in rated.root], rel=1e-9)
    (here / "best.toml").write_text(pair_spec(found[0]), encoding="utf-8")
    assert 'tool = "DIN 3972 II"' in (here / "best.toml").read_text(encoding="utf-8")
    assert {str(each.tool) for each in read_spec("best.toml").gears.values()} == {"DIN 3972 II"}


def test_a_hob_of_the_folder_goes_with_the_results_of_a_search(here: Path) -> None:
    (here / "tools.csv").write_text(HEADING + "mine,2.5,20,1.3,0.3,,\n", encoding="utf-8")
    words = "size --torque 100 --ratio 2 --speed 1500 --teeth 18 --helix-angle 15 --errors 0 --count 1 --quiet"
    done = CliRunner().invoke(main, [*words.split(), "--material", "Eh MQ", "-o", "found", "--tool", "mine"])
    assert done.exit_code == 0, done.output
    for each in read_spec("found/best.toml").gears.values():
        assert (str(each.tool), each.rack.dedendum, each.normal_module) == ("mine", 1.3, 2.5)


@pytest.mark.parametrize(
    ("tool", "told"),
    [("DIN 3972 III", "must be a hob that makes all of the teeth; this is a hob before finishing"), ("X", "must be a tool of")],
)
def test_a_search_refuses_other_tools_in_a_line(tool: str, told: str) -> None:
    words = "size --torque 100 --ratio 2 --speed 1500 --material".split()
    done = CliRunner().invoke(main, [*words, "Eh MQ", "--tool", tool])
    assert done.exit_code == 2
    assert done.stderr.startswith(f"Error: tool = '{tool}': {told}") and done.stderr.count("\n") == 1


def test_the_table_that_is_written_is_a_shelf(here: Path) -> None:
    done = CliRunner().invoke(main, ["tools", "-o", "shelf", "--quiet"])
    assert done.exit_code == 0 and done.output.endswith("shelf/tools.json\nshelf/tools.csv\n")
    assert max(map(len, done.output.splitlines()[:-2])) <= 100
    before, again = tools(), tools(folder="shelf")
    assert isinstance(before, ShelfTools) and isinstance(again, ShelfTools)
    copied = [tool for tool in again.tools if tool.place is Place.DESIGN]
    assert [(tool.name, tool.parts, tool.normal_module, tool.source) for tool in copied] == [
        (tool.name, tool.parts, tool.normal_module, tool.source) for tool in before.tools
    ]
