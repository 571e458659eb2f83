"""The B-rep of rings with modified flanks, measured before and after STEP against formulas of the tests' own (reference)."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import cadquery
import numpy as np
import pytest
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepClass import BRepClass_FaceClassifier
from OCP.GeomAbs import GeomAbs_BSplineSurface
from OCP.gp import gp_Pnt2d
from OCP.TopAbs import TopAbs_IN
from support.modified import depth_off, removed_volume, unturned
from support.modifying import AMOUNTS, modified
from support.rings import RingSection

from gearcad import BasicRack, Body, Gear, GeometryError
from gearcad.geometry import ShaperCutter
from gearcad.solids import gear_solid, write_step

ON_FLANK = 1e-6  # mm: what section and sweep together are fitted to
VOLUME_TOLERANCE = 1e-7  # of the whole volume: what the kernel's own integration reaches

_RIM = Body(rim_diameter=110)
_PLAIN = {"teeth": -40, "normal_module": 2.0, "face_width": 12.2, "body": _RIM}
_CUTTER = ShaperCutter(teeth=25, tip_radius=0.2)

RINGS = {
    "spur, form root": Gear(**_PLAIN),
    "right hand, shaped": Gear(**_PLAIN | {"helix_angle": 28.0, "cutter": _CUTTER}),
    "left hand": Gear(**_PLAIN | {"helix_angle": -15.0, "profile_shift": -0.4, "cutter": ShaperCutter(tip_radius=0.2)}),
    "chamfered": Gear(**_PLAIN | {"helix_angle": 25.0, "body": replace(_RIM, end_chamfer=1.2, tip_chamfer=0.3)}),
    "chamfered beyond the root": Gear(**_PLAIN | {"helix_angle": -17.0, "body": replace(_RIM, end_chamfer=5.2)}),
}  # fmt: skip


def _valid_and_closed(shape: cadquery.Shape) -> bool:
    return BRepCheck_Analyzer(shape.wrapped).IsValid() and all(shell.wrapped.Closed() for shell in shape.Shells())


def _again(solid: cadquery.Shape, path: Path) -> cadquery.Shape:
    write_step(solid, path, name="ring")
    again = cadquery.importers.importStep(str(path)).val()
    assert len(again.Solids()) == 1
    return again


def _points(shape: cadquery.Shape, most: int = 48, grid: int = 5) -> np.ndarray:
    """Points (n, 3) of the B-spline faces (flanks, fillets, chamfers), inside their edges and on some of them."""
    faces = [face for face in shape.Faces() if BRepAdaptor_Surface(face.wrapped).GetType() == GeomAbs_BSplineSurface]
    found = []
    for face in faces[:: math.ceil(len(faces) / most)]:
        surface = BRepAdaptor_Surface(face.wrapped)
        u0, u1, v0, v1 = face._uvBounds()
        for u in u0 + (u1 - u0) * (np.arange(grid) + 0.37) / grid:
            for v in v0 + (v1 - v0) * (np.arange(grid) + 0.41) / grid:
                if BRepClass_FaceClassifier(face.wrapped, gp_Pnt2d(u, v), 1e-7).State() == TopAbs_IN:
                    found.append(surface.Value(u, v))
        found += [edge.positionAt(t).toPnt() for edge in face.Edges() for t in (0.0, 0.3, 1.0)]
    return np.array([(point.X(), point.Y(), point.Z()) for point in found])


def _measure(gear: Gear, shape: cadquery.Shape) -> None:
    """Flanks, fillets and chamfers lie where they are specified, inside of faces and on edges."""
    section, points = RingSection(gear), _points(shape)
    radius = np.hypot(*points[:, :2].T)
    flank = (radius < section.form - ON_FLANK) & (radius > section.tip_form + ON_FLANK)
    assert flank.sum() > 200
    assert np.abs(depth_off(gear, points[flank])).max() < ON_FLANK
    rest = (radius > section.form + ON_FLANK) | (radius < section.tip_form - ON_FLANK)
    assert rest.sum() > 100
    assert section.off(unturned(gear, points[rest])).max() < ON_FLANK


_LONG = ("spur, form root", "right hand, shaped", "chamfered", "chamfered beyond the root")


@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.long] * (name in _LONG)) for name in RINGS])
def test_all_modifications_before_and_after_step(name: str, tmp_path: Path) -> None:
    gear = modified(RINGS[name])
    solid = gear_solid(gear)
    for made in (solid, _again(solid, tmp_path / "ring.step")):
        assert _valid_and_closed(made)
    _measure(gear, solid)
    removed = gear_solid(RINGS[name]).Volume() - solid.Volume()
    assert removed == pytest.approx(removed_volume(gear), abs=VOLUME_TOLERANCE * solid.Volume())


def _crossed() -> list[object]:
    """Every ring with every modification: an eighth of them by default, the others long."""
    return [
        pytest.param(name, amount, marks=() if (row + column) % 8 == 0 else pytest.mark.long)
        for row, name in enumerate(RINGS)
        for column, amount in enumerate(AMOUNTS)
    ]


@pytest.mark.parametrize(("name", "amount"), _crossed())
def test_each_modification_is_measured_on_the_solid(name: str, amount: str) -> None:
    gear = modified(RINGS[name], amount)
    solid = gear_solid(gear)
    assert _valid_and_closed(solid)
    _measure(gear, solid)


def test_fillets_without_a_root_land_go_on_meeting() -> None:
    """A full radius leaves no land to open: the fillets turn less and less towards the middle of the space."""
    gear = modified(Gear(**_PLAIN | {"helix_angle": 20.0, "rack": BasicRack(root_radius="full")}))
    section, solid = RingSection(gear), gear_solid(gear)
    assert _valid_and_closed(solid)
    points = _points(solid, 160)
    radius = np.hypot(*points[:, :2].T)
    flank = (radius < section.form - ON_FLANK) & (radius > section.tip_form + ON_FLANK)
    assert np.abs(depth_off(gear, points[flank])).max() < ON_FLANK
    root = np.abs(radius - section.root) < ON_FLANK
    assert root.sum() > 50
    angle = section.folded(points[root])[1]
    assert np.abs(section.pitch / 2 - np.abs(angle)).max() * section.root < ON_FLANK


def test_sharp_corners_turn_with_their_flanks() -> None:
    kinks = {"tip_relief_transition": 0.0, "root_relief_transition": 0.0}
    gear = modified(Gear(**_PLAIN | {"helix_angle": 15.0, "cutter": ShaperCutter(tip_radius=0.0)}), **kinks)
    solid = gear_solid(gear)
    assert _valid_and_closed(solid)
    points = _points(solid)
    assert np.abs(depth_off(gear, points)).max() < ON_FLANK
    assert np.hypot(*points[:, :2].T).max() == pytest.approx(RingSection(gear).root, abs=1e-9)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(200))
def test_random_rings_long(seed: int, tmp_path: Path) -> None:
    """Random rings, two in three of them modified, chamfered or bolted: sides, volume, validity, STEP."""
    plain, gear = _random(seed)
    before, solid = gear_solid(plain), gear_solid(gear)
    again = _again(solid, tmp_path / "ring.step")
    for made in (before, solid, again):
        assert _valid_and_closed(made), gear
    assert before.Volume() == pytest.approx(RingSection(plain).volume, rel=VOLUME_TOLERANCE), plain
    assert again.Volume() == pytest.approx(solid.Volume(), rel=VOLUME_TOLERANCE), gear
    _measure(gear, solid)
    assert before.Volume() - solid.Volume() == pytest.approx(removed_volume(gear), abs=VOLUME_TOLERANCE * solid.Volume()), gear


def _random(seed: int) -> tuple[Gear, Gear]:
    """A random ring, and the same with random modifications or none."""
    rng = np.random.default_rng(seed)
    while True:
        try:
            plain = _draw(rng)
            if rng.random() < 0.3:
                return plain, plain
            names = [name for name in AMOUNTS if rng.random() < 0.5] or ["tip_relief"]
            amounts = {name: AMOUNTS[name] * min(plain.normal_module, 2.0) / 2 for name in names}
            lengths = {"end_relief_length": rng.uniform(0.02, 0.5) * plain.face_width}
            return plain, modified(plain, *names, **amounts, **lengths)
        except GeometryError:
            continue


def _draw(rng: np.random.Generator) -> Gear:
    module = float(rng.choice([0.05, 0.5, 2.0, 6.0, 100.0]))
    teeth, width = int(rng.integers(30, 120)), module * rng.uniform(0.2, 20)
    cutter = ShaperCutter(tip_radius=rng.uniform(0.05, 0.3))
    if rng.random() < 0.6:
        cutter = replace(cutter, teeth=int(rng.integers(12, teeth - 10)), profile_shift=rng.uniform(-0.2, 0.3))
    bare = Gear(
        teeth=-teeth,
        normal_module=module,
        face_width=width,
        helix_angle=float(rng.choice([0, rng.uniform(-40, 40)])),
        profile_shift=rng.uniform(-1.0, 0.3),
        tooth_thinning=module * rng.uniform(0, 0.05),
        cutter=cutter,
    )
    root = -bare.root_diameter
    body = {"rim_diameter": root + module * rng.uniform(0.3, 12)}
    if rng.random() < 0.5:
        body |= {"end_chamfer": module * rng.uniform(0.05, 1.5), "end_chamfer_angle": rng.uniform(15, 65)}
    if rng.random() < 0.3:
        body["tip_chamfer"] = module * rng.uniform(0.05, 0.2)
    if rng.random() < 0.3:
        middle = (root + body["rim_diameter"]) / 2
        body |= {"bolt_circle": middle, "bolt_holes": 7, "bolt_diameter": module * rng.uniform(0.1, 2)}
    return replace(bare, body=Body(**body))
