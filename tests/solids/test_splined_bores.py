"""Splined bores of gears: their area in closed form, what stays of the gear, tables, documents, and what is refused."""

import copy
import json
import math
import pickle
from dataclasses import replace
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from click.testing import CliRunner
from scipy.integrate import quad

from gearcad import Body, Gear, GeometryError, ParameterError, SplinedBore
from gearcad.cli import main
from gearcad.designs.reader import read_spec
from gearcad.designs.table import open_table
from gearcad.geometry import DoubleHelix
from gearcad.geometry.bore_teeth import bore_teeth, free_bore, with_round_bore
from gearcad.geometry.spline import SplineJoint
from gearcad.meshing.outline import held_radius
from gearcad.solids.exact.inertia import moments
from gearcad.solids.exact.solid import gear_boundary
from gearcad.solids.facets.tessellation import tessellate
from gearcad.solids.files.dxf import gear_contour, write_dxf

N30 = "N 30 x 1.25 x 22 x 9H"


def gear(bore: str | float = N30, **given: object) -> Gear:
    body = given.pop("body", {})
    assert isinstance(body, dict)
    inputs = {"teeth": 40, "normal_module": 2.0, "face_width": 20.0, **given}
    return Gear(**inputs, body=Body(bore=bore, **body))  # type: ignore[arg-type]


def opening(teeth: int, module: float, root: float, tip: float, width: float, radius: float, angle: float = 30.0) -> float:
    """Return the area (mm²) of a splined opening: `width` of its spaces on the reference circle, `radius` of their corners.

    A space is bounded as an external tooth whose tip corners are rounded: the middle of such a corner lies on the tangent of
    the base circle through the place where it touches the flank, the `radius` nearer to the base circle.
    """
    alpha = math.radians(angle)
    outer, inner = root / 2, tip / 2
    base = module * teeth * math.cos(alpha) / 2
    half_at_base = width / (module * teeth) + math.tan(alpha) - alpha
    middle = outer - radius
    length = radius + math.sqrt(middle**2 - base**2)
    turn = half_at_base - length / base + math.atan((length - radius) / base)
    touch = math.hypot(base, length)

    def flank(r: float) -> float:
        at = math.acos(base / r)
        return half_at_base - math.tan(at) + at

    def corner(r: float) -> float:
        return turn + math.acos(min((r**2 + middle**2 - radius**2) / (2 * r * middle), 1.0))

    beyond = sum(
        quad(lambda r, half=half: 2 * r * half(r), low, high, epsabs=1e-13, epsrel=1e-13)[0]
        for half, low, high in ((flank, inner, touch), (corner, touch, outer))
    )
    return math.pi * inner**2 + teeth * beyond


def din(diameter: float, module: float, teeth: int, loosened: float = 0.0) -> float:
    """Return the opening (mm²) of a hub of DIN 5480 whose spaces are wider by so much (mm) than the basic ones."""
    width = module * math.pi / 2 + (diameter - module * (teeth + 1.1)) * math.tan(math.radians(30)) + loosened
    return opening(teeth, module, diameter, diameter - 2 * module, width, 0.16 * module)


OPENINGS = {
    N30: din(30, 1.25, 22),
    "N 20 x 1 x 18": din(20, 1, 18),
    "N 120 x 3 x 38 x 9H": din(120, 3, 38, 0.062),  # printed: 6.305 to 6.361 mm, the middle is the basic 6.271 and 62 µm
    "INT 24T x 16/32P x 30R x 5": opening(
        24, 25.4 / 16, 25.4 / 16 * 25.8, 25.4 / 16 * 23, 25.4 / 16 * math.pi / 2, 0.4 * 25.4 / 16
    ),
}
"""Openings (mm²) in closed form, from the formulas of the standards; of ANSI B92.1 in inches."""

KINDS = {
    "spur": gear(),
    "helical": gear(helix_angle=15.0),
    "hubs": gear(helix_angle=-15.0, body={"hub_diameter": 45.0, "hub_length": 4.0, "hub_side": "both", "end_chamfer": 0.5}),
    "double": gear(helix_angle=25.0, double_helix=DoubleHelix(gap_width=4.0)),
    "apex": gear(helix_angle=25.0, double_helix=DoubleHelix(gap_width=0.0)),
}


@pytest.mark.parametrize("designation", OPENINGS)
def test_the_area_of_a_splined_bore(designation: str) -> None:
    """What a splined bore takes from a gear is its area in closed form times its length."""
    large = gear(designation, teeth=75)
    solid = moments(gear_boundary(replace(large, body=Body()))).volume
    taken = solid - moments(gear_boundary(large)).volume
    assert taken == pytest.approx(20.0 * OPENINGS[designation], rel=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_volumes_of_solids_and_triangles(kind: str) -> None:
    """The bore is straight whatever the teeth are, as long as the hubs; triangles are closed and near the exact volume."""
    part = KINDS[kind]
    length = 20.0 + sum(part.body.hub_ends)
    whole, exact = (moments(gear_boundary(each)).volume for each in (replace(part, body=replace(part.body, bore=0.0)), part))
    assert exact == pytest.approx(whole - length * OPENINGS[N30], rel=1e-9)
    facets = tessellate(part, 0.002)
    found = facets.to_trimesh()
    assert found.is_watertight and found.is_winding_consistent and found.euler_number == 0
    assert facets.volume == pytest.approx(exact, abs=0.002 * found.area)


def test_the_outline_is_that_of_the_hub_of_a_spline() -> None:
    joint = SplineJoint(designation=f"{N30} / W 30 x 1.25 x 22 x 8f", length=20.0)
    hub = joint.parts["hub"].gear
    teeth = bore_teeth(gear(helix_angle=20.0))
    assert teeth is not None
    np.testing.assert_array_equal(gear_contour(teeth), gear_contour(hub))
    assert (teeth.face_width, teeth.helix_angle, free_bore(gear())) == (20.0, 0.0, 27.5)


def test_the_contour_of_a_dxf(tmp_path: Path) -> None:
    write_dxf(gear(), tmp_path / "gear.dxf")
    space = ezdxf.readfile(tmp_path / "gear.dxf").modelspace()
    (bore,) = (each for each in space.query("LWPOLYLINE") if each.dxf.layer == "BORE")
    assert bore.closed and not space.query("CIRCLE")
    x, y, bulge = np.array(bore.get_points("xyb")).T
    chord = np.hypot(np.roll(x, -1) - x, np.roll(y, -1) - y)
    angle = 4 * np.arctan(bulge)
    turning = np.where(angle == 0, 1.0, angle)
    radius = chord / (2 * np.sin(turning / 2))
    segments = np.where(angle == 0, 0.0, radius**2 * (angle - np.sin(angle)) / 2)
    area = float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / 2 + segments.sum())
    assert area == pytest.approx(OPENINGS[N30], abs=0.0005 * 150)  # 0.5 µm along a contour of 150 mm


# ---------------------------------------------------------------------- a bore like any other


def test_it_counts_as_the_bore_of_its_root_circle() -> None:
    splined, round_one = gear(helix_angle=10.0), gear(30.0, helix_angle=10.0)
    assert held_radius(splined) == held_radius(round_one) == 15.0
    assert with_round_bore(splined) == round_one
    assert splined != round_one and hash(splined.body) != hash(round_one.body)
    assert splined.body.bore_spline == N30 and round_one.body.bore_spline is None
    document, other = splined.to_dict(), round_one.to_dict()
    assert document["body"].pop("bore_spline") == N30
    assert type(document["body"]["bore"]) is float and document["body"] == other["body"]
    codes = [each.code for each in splined.notices]
    assert codes == ["spline-not-judged", *(each.code for each in round_one.notices)]
    json.dumps(document)


def test_copies_are_equal() -> None:
    body = Body(bore=" N 30 x 1,25  x 22 x 9H ")
    assert body == Body(bore=SplinedBore(N30)) == pickle.loads(pickle.dumps(body)) == copy.deepcopy(body)
    assert replace(body, hub_diameter=40.0, hub_length=2.0).bore_spline == N30
    assert replace(gear(), profile_shift=0.2).body.bore == SplinedBore(N30)
    assert {body: 1}[Body(bore=N30)] == 1 and body != Body(bore=30.0)
    assert repr(body) == f"Body(bore=SplinedBore('{N30}'))"


@pytest.mark.parametrize(
    ("bore", "said"),
    [
        ("W 30 x 1.25 x 22 x 8f", f'write "{N30}"'),
        ("N 30 x 1.25 x 22 x 8F / W 30 x 1.25 x 22 x 8f", 'write "N 30 x 1.25 x 22 x 8F"'),
        ("EXT 24z x 2.5m x 37.5R x 5f", 'write "INT 24z x 2.5m x 37.5R x 5H"'),
        ("EXT 24T x 12/24P x 30P x 6", 'write "INT 24T x 12/24P x 30P x 6"'),
        ("H7", 'must be a number at least 0 mm, or a hub such as "N 30'),
        ("30", "must be a number at least 0 mm"),
        ("N 30 x 1.3 x 22 x 9H", "the nearest is 1.25"),
        ("N 30 x 1.25 x 30 x 9H", "number of teeth near 22"),
        ("N 30 x 1.25 x 22 x 9f", "one of F, G, H, J, K, M"),
        ("INT 4z x 2m x 30R x 5H", "number of teeth must be a whole number from 6 to 500"),
        ("INT 24z x 2m x 45P x 5H", 'root must be "fillet" at a pressure angle of 45 deg'),
        ("N 8 x 1 x 7", "tips must lie outside the base circle (diameter 6 mm, base circle 6.06218 mm)"),
    ],
)
def test_bores_that_are_no_hub(bore: str, said: str) -> None:
    with pytest.raises((ParameterError, GeometryError)) as caught:
        Body(bore=bore)
    assert caught.value.parameter == "bore" and said in str(caught.value) and "\n" not in str(caught.value)


def test_what_cannot_stand_beside_a_splined_bore() -> None:
    for given in ({"keyway": True}, {"keyway_width": 8.0, "keyway_depth": 3.3}):
        with pytest.raises(GeometryError, match=r"must be left out: the bore is a spline \(N 30"):
            Body(bore=N30, **given)  # type: ignore[arg-type]
    with pytest.raises(GeometryError, match=r"a rim of .* inside the root circle 29 mm\); it is the root circle of N 30"):
        gear(teeth=17)
    with pytest.raises(GeometryError, match="is for external gears"):
        Gear(teeth=-60, normal_module=2, face_width=10, body=Body(bore=N30))


# ---------------------------------------------------------------------- specs, tables, commands


def test_specs_and_tables(tmp_path: Path) -> None:
    spec, table = tmp_path / "g.toml", tmp_path / "t.csv"
    spec.write_text(f'[gear]\nteeth = 40\nnormal_module = 2\nface_width = 20\nbody.bore = "{N30}"\n', encoding="utf-8")
    rows = f"name;teeth;normal_module;face_width;body.bore\na;40;2,0;20;{N30.replace('.', ',')}\nb;40;2,0;20;30\n"
    table.write_text(rows, encoding="utf-8")
    from_spec = read_spec(spec).gear  # type: ignore[union-attr]
    bores = [row.design().gear.body.bore for row in open_table(table).rows()]  # type: ignore[union-attr]
    assert from_spec.body.bore == bores[0] == SplinedBore(N30) and bores[1] == 30.0
    run = CliRunner().invoke(main, ["data", str(spec)])
    assert run.exit_code == 0 and f"30.0000 ({N30})" in run.output
    spec.write_text(spec.read_text(encoding="utf-8").replace("N 30", "W 30"), encoding="utf-8")
    run = CliRunner().invoke(main, ["data", str(spec)])
    assert run.exit_code and f"gear.body.bore = 'W 30 x 1.25 x 22 x 9H': must be the hub alone: write \"{N30}\"" in run.output
