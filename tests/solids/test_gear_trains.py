"""Trains of pairs as bodies: teeth mesh in all meshes at once, judged by exact outlines; axes, heights, names, and clashes."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.commands import read_json

from gearcad import Gear, GearPair
from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.records import PerGear, Role
from gearcad.designs import TrainDesign, read_spec
from gearcad.designs.reader import starter_text
from gearcad.geometry import Body
from gearcad.jobs.build import Build
from gearcad.jobs.train_bodies import gear_train_plan, suited_to_train
from gearcad.jobs.train_sheets import job_for
from gearcad.jobs.verification import Verify
from gearcad.shafts.beam import ShaftSegment, SteppedShaft
from gearcad.solids import FileOptions, Format
from gearcad.solids.files.gear_train_products import GearTrainProduct
from gearcad.solids.gear_train_plan import GearKey, GearTrainPlan, ShaftPlan, TrainMeshPlan
from gearcad.verification.assemblies import OUTLINES, PlacedMesh, PlacedPart, judge_places
from gearcad.verification.claims import ClaimSubject, Judge, VerificationLevel

PLACE = 1e-9
"""mm: sums of distances of axes."""


def starter(folder: Path, name: str = "two-stage", *changes: tuple[str, str]) -> TrainDesign:
    file, text = starter_text(name)
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    (folder / file).write_text(text, encoding="utf-8")
    design = read_spec(folder / file)
    assert isinstance(design, TrainDesign)
    return design


def gear(teeth: int, helix: float = 0.0, width: float = 20.0, **more: Any) -> Gear:
    return Gear(teeth=teeth, normal_module=2.0, face_width=width, helix_angle=helix, tooth_thinning=0.03, **more)


def pair(pinion: Gear, wheel: Gear) -> GearPair:
    return GearPair(pinion=pinion, wheel=wheel)


def mesh(name: str, of: GearPair, gears: tuple[str, str], lines: tuple[int, int], angle: float = 0.0) -> TrainMeshPlan:
    return TrainMeshPlan(name=name, pair=of, gears=PerGear(*gears), lines=PerGear(*lines), angle=angle)


IDLER = gear(31, -12.0, 18.0)
RING = Gear(teeth=-62, normal_module=2.0, face_width=15.0, tooth_thinning=0.03, body=Body(rim_diameter=150.0))
PLANS = {
    "chain with angles": [
        mesh("1", pair(gear(19, 12.0, 24.0), gear(43, -12.0)), ("a", "b"), (0, 1), 73.0),
        mesh("2", pair(gear(21), gear(37)), ("c", "d"), (1, 2), -140.0),
        mesh("3", pair(gear(23, -8.0), gear(29, 8.0, 25.0)), ("e", "f"), (2, 3), 12.5),
    ],
    "idler between two": [
        mesh("1", pair(gear(19, 12.0, 24.0), IDLER), ("a", "i"), (0, 1), 10.0),
        mesh("2", pair(IDLER, gear(45, 12.0, 15.0)), ("i", "b"), (1, 2), 100.0),
    ],
    "one wheel, two pinions": [
        mesh("1", pair(gear(19, 12.0, 24.0), IDLER), ("a", "w"), (0, 1), 10.0),
        mesh("2", pair(gear(23, 12.0, 14.0), IDLER), ("b", "w"), (2, 1), 77.0),
    ],
    "ring behind a stage": [
        mesh("1", pair(gear(19), gear(41)), ("a", "b"), (0, 1), 200.0),
        mesh("2", pair(gear(23), RING), ("c", "r"), (1, 2), 30.0),
    ],
}


def claims_of(plan: GearTrainPlan) -> dict[str, bool]:
    """Judge the places of the solids as a file has them: by outlines, which know nothing of the plan."""
    product = GearTrainProduct(plan, FileOptions())
    placed = []
    for each in product.solid().occurrences:
        origin, z, x = (np.array(part) for part in each.frame)
        placed.append(PlacedPart(each.product.name, np.column_stack([x, np.cross(z, x), z, origin])))
    names = {key: product.product_name(standing.name) for key, standing in plan.standing.items()}
    meshes = [
        PlacedMesh(own.pair, names[GearKey(own.name, Role.PINION)], names[GearKey(own.name, Role.WHEEL)]) for own in plan.meshes
    ]
    judge = Judge(ClaimSubject.STEP, VerificationLevel.FILES, "assembly", OUTLINES)
    return {f"{claim.where}: {claim.quantity}": claim.passed for claim in judge_places(judge, meshes, placed)}


@pytest.mark.parametrize("name", PLANS)
def test_teeth_mesh_in_all_meshes_at_one_angle(name: str) -> None:
    plan = GearTrainPlan("t", tuple(PLANS[name]))
    found = claims_of(plan)
    assert len(found) == 3 * len(plan.meshes) and all(found.values()), found
    assert not [notice for notice in plan.notices if notice.code == "clash"]


def test_a_gear_that_is_turned_by_itself_does_not_mesh() -> None:
    """The judge sees half a pitch: so does it see what the plan would do wrong."""
    plan = GearTrainPlan("t", tuple(PLANS["chain with angles"]))
    turned = GearTrainPlan("t", plan.meshes)
    key = GearKey("2", Role.WHEEL)
    turned._rotations[key] += 360 / 37 / 2
    assert not all(claims_of(turned).values())


def test_axes_and_heights(tmp_path: Path) -> None:
    """Distances of axes are those of the pairs, at the angles of the meshes; positions on shafts give the heights."""
    plan = gear_train_plan(starter(tmp_path))
    gears, shafts = {each.name: each for each in plan.gears}, {each.name: each for each in plan.standing_shafts}
    first, second = (each.pair.centre_distance for each in plan.meshes)
    assert (gears["wheel 1"].x, gears["wheel 1"].y) == pytest.approx((first, 0.0), abs=PLACE)
    angle = math.radians(30)
    place = (first + second * math.cos(angle), second * math.sin(angle))
    assert (gears["wheel 2"].x, gears["wheel 2"].y) == pytest.approx(place, abs=PLACE)
    assert (gears["pinion 2"].x, gears["pinion 2"].y) == (gears["wheel 1"].x, gears["wheel 1"].y)
    # The middle of stage 2 is 92 - 45 mm behind that of stage 1, whose pinion begins at 0.
    assert gears["pinion 1"].z == 0 and gears["pinion 2"].z == pytest.approx(15 + 47 - 20, abs=PLACE)
    assert {name: shaft.z for name, shaft in shafts.items()} == pytest.approx(
        {"input": 15 - 95, "middle": 15 - 45, "output": 62 - 92}, abs=PLACE
    )
    assert not plan.notices
    assert all(claims_of(plan).values())


def test_assumed_places_and_clashes_are_told(tmp_path: Path) -> None:
    (assumed,) = gear_train_plan(starter(tmp_path, "train-pairs")).notices
    assert assumed.code == "assumed-places"
    folded = gear_train_plan(starter(tmp_path, "two-stage", ("mesh_angle = 30.0", "mesh_angle = 180.0")))
    assert [notice.text.partition(":")[0] for notice in folded.notices] == ["the shaft input stands in wheel 2"]
    same = PLANS["chain with angles"]
    shaft = SteppedShaft(segments=(ShaftSegment(length=100.0, outer_diameter=20.0),), bearings=())
    places = {GearKey("1", Role.WHEEL): 50.0, GearKey("2", Role.PINION): 55.0}
    tight = GearTrainPlan("t", tuple(same), (ShaftPlan(name="s", line=1, shaft=shaft, positions=places),))
    assert "b and c stand in each other" in " ".join(notice.text for notice in tight.notices)


def test_loops_must_close() -> None:
    one = pair(gear(20), gear(40))
    loop = [mesh("1", one, ("a", "b"), (0, 1)), mesh("2", one, ("c", "d"), (0, 1), 20.0)]
    with pytest.raises(GeometryError, match=r"2.mesh_angle = 20 deg: must lead to the axis that other meshes give"):
        GearTrainPlan("t", tuple(loop)).axes  # noqa: B018


def test_files_of_a_train(tmp_path: Path) -> None:
    """Those of the pairs are those of the pairs alone, byte by byte; the assembly has each gear and shaft once."""
    design = starter(tmp_path)
    job = suited_to_train(Build(formats=(Format.STEP,)), design)
    result = job.run(design)
    files = job.write(result, tmp_path / "out")
    names = {file.relative_to(tmp_path / "out").as_posix() for file in files}
    pairs = {"data.json", "pinion.step", "wheel.step", "assembly.step", "pinion-shaft.step", "wheel-shaft.step"}
    shafts = {f"shaft-{name}.step" for name in ("input", "middle", "output")}
    assert names == {"data.json", "assembly.step", *shafts} | {f"stage {n}/{name}" for n in (1, 2) for name in pairs}
    alone = Build(formats=(Format.STEP,))
    for each in result.meshes.meshes:  # type: ignore[attr-defined]
        alone.write(alone.run(each.mesh.design), tmp_path / "alone")
        for name in pairs - {"assembly.step"}:
            assert (tmp_path / "alone" / name).read_text().splitlines()[8:] == (
                tmp_path / "out" / each.mesh.folder / name
            ).read_text().splitlines()[8:], name
    text = (tmp_path / "out" / "assembly.step").read_text()
    for name in ("pinion 1", "wheel 1", "pinion 2", "wheel 2", "input", "middle", "output"):
        assert f"'two-stage {name}'" in text
    told = job.document(result)["arrangement"]
    assert json.loads(json.dumps(told))["gears"]["wheel 1"]["mesh"] == "stage 1"


def test_a_mesh_without_a_pair_is_refused(tmp_path: Path) -> None:
    design = starter(tmp_path, "train-2-stage")
    with pytest.raises(ParameterError, match="must be given, the spec of a pair"):
        gear_train_plan(replace(design))


@pytest.mark.long
def test_files_of_a_train_are_verified(tmp_path: Path) -> None:
    """STEP by Open CASCADE, facets by trimesh, places by exact outlines; claims of pairs in the folders of their meshes."""
    design = starter(tmp_path)
    job = job_for(Verify(), design)
    result = job.run(design)
    assert not result.failed and result.passed
    of_all = [claim for claim in result.claims if claim.where.startswith("assembly")]
    backlash = [claim.where for claim in of_all if claim.quantity == "circumferential backlash"]
    assert len(backlash) == 6 and sum("wheel 2" in where for where in backlash) == 3
    files = {file.relative_to(tmp_path / "out").as_posix() for file in job.write(result, tmp_path / "out")}
    assert {"verify.json", "assembly.step", "stage 1/verify.json", "stage 2/verify.pdf", "stage 2/wheel.stl"} <= files
    document = read_json(tmp_path / "out" / "verify.json")
    own = [read_json(tmp_path / "out" / f"stage {n}" / "verify.json")["counts"]["passed"] for n in (1, 2)]
    assert document["counts"]["passed"] == len([claim for claim in of_all if claim.passed]) + sum(own)
