"""Files of splines: both parts on one axis, judged by the CAD kernel and by outlines that are turned until they touch."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gearcad import SplineJoint
from gearcad.core.errors import ParameterError
from gearcad.designs import SplineDesign
from gearcad.geometry import HubInputs, ShaftInputs
from gearcad.jobs.build import Build
from gearcad.jobs.mesh import Mesh
from gearcad.jobs.verification import Verify
from gearcad.solids import Format, spline_assembly
from gearcad.verification.assemblies import PlacedMesh, PlacedPart, judge_joint, judge_places
from gearcad.verification.claims import ClaimSubject, Judge, VerificationLevel
from gearcad.verification.step import read_step

OWN: dict[str, Any] = {"tolerance_actual": 30.0, "tolerance_effective": 20.0}
JOINT = SplineJoint(
    name="seat",
    designation="N 20 x 1.25 x 14 x 9H / W 20 x 1.25 x 14 x 8f",
    length=12.0,
    shaft=ShaftInputs(bore=6.0, **OWN),
    hub=HubInputs(outer_diameter=30.0, **OWN),
)
DESIGN = SplineDesign(name="seat", spline=JOINT)


def place(angle: float) -> np.ndarray:
    turn = np.radians(angle)
    cosine, sine = np.cos(turn), np.sin(turn)
    return np.array([[cosine, -sine, 0, 0], [sine, cosine, 0, 0], [0, 0, 1, 0]])


def failed(turn_of_hub: float) -> set[str]:
    """Claims about places that fail where the hub is turned by an angle (degrees)."""
    judge = Judge(ClaimSubject.STEP, VerificationLevel.FILES, "some.step", "exact outlines")
    placed = [PlacedPart("seat shaft", place(0.0)), PlacedPart("seat hub", place(turn_of_hub))]
    claims = judge_places(judge, [PlacedMesh(JOINT, "seat shaft", "seat hub")], placed)
    return {claim.quantity for claim in claims if not claim.passed}


def test_a_hub_stands_in_the_middle_of_its_play() -> None:
    middle, play = JOINT.hub_rotation, JOINT.backlash_angle
    assert middle == pytest.approx(180 / 14)
    assert play is not None and play > 0.1
    assert failed(middle) == failed(middle + 0.49 * play) == failed(middle - 0.49 * play) == set()
    assert failed(middle + 0.51 * play) == failed(middle - 0.51 * play) == {"teeth do not overlap"}
    assert "teeth do not overlap" in failed(0.0)


def test_plays_are_those_of_the_outlines() -> None:
    claims = list(judge_joint(JOINT, "seat"))
    assert [claim.passed for claim in claims].count(True) == 5
    assert [claim.quantity for claim in claims if claim.passed is None] == ["contact ratio, centre distance"]


def test_assembly_has_both_bodies_with_names_colours_and_volumes(tmp_path: Path) -> None:
    job = Build(formats=(Format.STEP, Format.STL, Format.GLB))
    names = [path.name for path in job.write(job.run(DESIGN), tmp_path)]
    assert names == [
        "data.json",
        *("shaft.glb", "hub.glb", "assembly.glb", "shaft.stl", "hub.stl", "shaft.step", "hub.step", "assembly.step"),
    ]
    (root,) = read_step(tmp_path / "assembly.step")
    shaft, hub = root.parts()
    assert [part.product for part in (shaft, hub)] == ["seat shaft", "seat hub"]
    assert shaft.colour != hub.colour
    assert shaft.shape.IsNull() is False
    together = spline_assembly(JOINT).toCompound()
    solids = together.Solids()
    assert len(solids) == 2 and all(solid.isValid() for solid in solids)
    assert solids[0].intersect(solids[1]).Volume() == 0.0


@pytest.mark.long
def test_every_claim_about_the_files_of_a_spline_holds() -> None:
    result = Verify(level=VerificationLevel.FILES).run(DESIGN)
    assert result.passed
    assert {claim.quantity for claim in result.not_judged} <= {"drawings", "contact ratio, centre distance"}


def test_a_single_part_is_no_assembly(tmp_path: Path) -> None:
    alone = SplineJoint(name="end", designation="W 20 x 1.25 x 14", length=12.0)
    job = Build(formats=(Format.STEP,))
    names = [path.name for path in job.write(job.run(SplineDesign(name="end", spline=alone)), tmp_path)]
    assert names == ["data.json", "shaft.step"]
    (root,) = read_step(tmp_path / "shaft.step")
    assert root.product == "end"


def test_sections_of_both_parts_are_meshed(tmp_path: Path) -> None:
    result = Mesh(given={"elements": 600}).run(DESIGN)
    assert list(result.meshes) == ["shaft", "hub"]
    assert result.passed
    shaft, hub = result.meshes["shaft"], result.meshes["hub"]
    assert "bore" in shaft.sides and "rim" in hub.sides
    with pytest.raises(ParameterError, match="shaft and hub of a spline are both meshed"):
        Mesh(given={"gear": "pinion"}).run(DESIGN)
