"""Pairs of a train's meshes: loads by hand, documents against those of the pairs alone, the verdict of the worst."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gearcad import Gear, GearPair, Load, Material
from gearcad.check.options import CheckOptions
from gearcad.core.errors import ParameterError
from gearcad.core.records import Role, Verdict
from gearcad.designs import PairDesign, TrainDesign
from gearcad.designs.train_designs import designed_pair
from gearcad.designs.train_meshes import folder_name, train_meshes
from gearcad.dynamics import Inertia, Shaft, ToothMesh, Train
from gearcad.dynamics.engagement import engaged, pinion_loads
from gearcad.dynamics.options import DynamicsOptions
from gearcad.jobs.job import Data
from gearcad.jobs.strength import Check, Rate
from gearcad.jobs.train import figures_of, suited
from gearcad.rating.options import RatingOptions

EXACT = 1e-11
"""Relative: the loads of pairs are rounded to 12 digits."""

STRONG = Material(name="18CrNiMo7-6", group="Eh", quality="MQ")


def pair_design(name: str, teeth: tuple[int, int], module: float, **more: Any) -> PairDesign:
    helix = more.pop("helix_angle", 0.0)
    shared = {"normal_module": module, "face_width": 10 * module, "tooth_thinning": 0.02 * module}
    wheel_helix = helix if teeth[1] < 0 else -helix
    pinion, wheel = (Gear(teeth=z, helix_angle=angle, **shared) for z, angle in zip(teeth, (helix, wheel_helix), strict=True))
    return PairDesign(name=name, pair=GearPair(pinion=pinion, wheel=wheel, name=name), **more)


def chain(designs: list[PairDesign], torque: float, speed: float) -> TrainDesign:
    """Pairs one behind the other, each wheel on a shaft with the next pinion; the last wheel carries the load."""
    inertias, shafts, meshes, output = [], [], [], torque
    for number, design in enumerate(designs, 1):
        ends = f"pinion {number}", f"wheel {number}"
        inertias += [Inertia(name=end, inertia=1e-3) for end in ends]
        meshes.append(ToothMesh(name=f"stage {number}", pinion=ends[0], wheel=ends[1], pair=designed_pair(design)))
        if number > 1:
            shafts.append(Shaft(name=f"s{number}", start=f"wheel {number - 1}", end=ends[0], torsional_stiffness=1e5))
        output *= -abs(design.pair.gear_ratio) if design.pair.wheel.teeth > 0 else abs(design.pair.gear_ratio)
    torques = {"pinion 1": torque, f"wheel {len(designs)}": output * (-1) ** (len(designs) + 1)}
    turned = math.prod(-1 if design.pair.wheel.teeth > 0 else 1 for design in designs)
    torques[f"wheel {len(designs)}"] = -turned * torque * math.prod(abs(design.pair.gear_ratio) for design in designs)
    train = Train(
        name="chain", inertias=tuple(inertias), shafts=tuple(shafts), meshes=tuple(meshes), torques=torques, speed=speed
    )
    return TrainDesign(name="chain", train=train)


STAGES = st.lists(st.tuples(st.integers(18, 30), st.integers(31, 60)), min_size=1, max_size=3)


@given(
    STAGES,
    st.floats(5.0, 80.0),
    st.sampled_from([1, -1]),
    st.floats(100.0, 4000.0),
    st.sampled_from([1, -1]),
    st.sampled_from([0.0, 12.0]),
)
@settings(max_examples=12, deadline=None)
def test_documents_are_those_of_the_pairs_alone(
    stages: list[tuple[int, int]], torque: float, side: int, speed: float, way: int, helix: float
) -> None:
    """Under torque and speed by the numbers of teeth, without losses; signs change from stage to stage."""
    designs = [
        pair_design(f"p{n}", z, 2.0 + n, helix_angle=helix, material=STRONG, load=Load(torque=1.0, application_factor=1.25))
        for n, z in enumerate(stages)
    ]
    found = train_meshes(chain(designs, side * torque, way * speed))
    own_torque, own_speed = side * torque, way * speed
    for mesh, design, (pinion, wheel) in zip(found.meshes, designs, stages, strict=True):
        load = mesh.design.load
        assert load is not None and load.application_factor == 1.25
        assert load.torque == pytest.approx(own_torque, rel=EXACT) and load.speed == pytest.approx(own_speed, rel=EXACT)
        assert mesh.driver is (Role.PINION if side == way else Role.WHEEL)
        alone = replace(design, load=Load(torque=load.torque, speed=load.speed, application_factor=1.25))
        for job in (Data(), Rate(report=False)):
            assert job.document(job.run(mesh.design)) == job.document(job.run(alone))
        own_torque, own_speed = -own_torque * wheel / pinion, -own_speed * pinion / wheel


def test_loads_are_those_that_dynamics_takes() -> None:
    """`engaged` computes them with the mesh cycles: equal to the last digit, also where stiffness decides them."""
    options = DynamicsOptions(stiffness="potential-energy")
    design = chain([pair_design("a", (20, 40), 2.0), pair_design("b", (20, 60), 3.0)], 30.0, 1000.0)
    held = replace(
        design.train,
        shafts=(*design.train.shafts, Shaft(name="hold", start="wheel 1", end="ground", torsional_stiffness=2e4),
                Shaft(name="end", start="wheel 2", end="ground", torsional_stiffness=3e4)),
        torques={"pinion 1": 30.0},
        speed=0.0,
    )  # fmt: skip
    for train in (design.train, held):
        loads = pinion_loads(train, options)
        for mesh in engaged(train, options).meshes:
            assert (loads[mesh.name].torque, loads[mesh.name].driver) == (mesh.course.torque, mesh.course.driver)  # type: ignore[attr-defined]


def test_the_worst_mesh_decides(tmp_path: Path) -> None:
    strong, weak = Material(name="a", group="Eh", quality="MQ"), Material(name="b", group="V", quality="ML", hardness=200.0)
    stages = ((20, 40), 3.0), ((20, 40), 3.0)
    rating = RatingOptions(required_safety_flank=1.0, required_safety_root=1.0)

    def result(*materials: Material | None, torque: float) -> Any:
        designs = [
            pair_design(f"p{n}", z, m, material=material, rating=None if material is None else rating)
            for n, ((z, m), material) in enumerate(zip(stages, materials, strict=True))
        ]
        design = chain(designs, torque, 1500.0)
        job = suited(Rate(report=False), design)
        made = job.run(design)
        return job, made

    job, found = result(strong, weak, torque=60.0)
    assert found.strength is Verdict.FAILED and found.passed is False and found.falls_short
    assert found.worst.mesh.name == "stage 2" and found.verdict == "NOT passed: stage 2"
    document = job.complete_document(found)
    alone = [Rate(report=False).complete_document(each.result) for each in found.meshes]
    assert [each["strength"] for each in document["meshes"].values()] == [each["strength"] for each in alone]
    least = min(min(each["safety"]["flank"].values()) for each in alone)
    assert figures_of(Rate(), document)["S_H_min"] == least
    files = job.write(found, tmp_path)
    assert sorted(file.relative_to(tmp_path).as_posix() for file in files) == [
        "rate.json", "stage 1/rate.json", "stage 2/rate.json",
    ]  # fmt: skip
    for each, own in zip(found.meshes, alone, strict=True):
        assert json.loads((tmp_path / each.mesh.folder / "rate.json").read_text()) == json.loads(json.dumps(own))
    assert result(strong, strong, torque=10.0)[1].strength is Verdict.PASSED
    assert result(strong, None, torque=10.0)[1].strength is Verdict.NOT_ASKED
    unknown = Material(name="c", contact_endurance_limit=1500.0)
    assert result(strong, unknown, torque=10.0)[1].strength is Verdict.NOT_JUDGED


def test_meshes_without_pairs_are_not_judged() -> None:
    design = chain([pair_design("a", (20, 40), 2.0, material=STRONG), pair_design("b", (20, 60), 3.0)], 30.0, 1000.0)
    first, second = (
        ToothMesh(
            name=mesh.name,
            pinion=mesh.pinion,
            wheel=mesh.wheel,
            base_radii=mesh.base_radii.map(float),
            stiffness=200.0,
            teeth=20,
        )
        for mesh in design.train.meshes
    )
    alone = replace(design, train=replace(design.train, meshes=(first, second)))
    design = replace(design, train=replace(design.train, meshes=(design.train.meshes[0], second)))
    job = suited(Rate(report=False), design)
    found = job.run(design)
    assert found.without == ("stage 2",) and found.strength is Verdict.NOT_JUDGED
    assert "the mesh has no pair" in job.complete_document(found)["not_judged"]["stage 2"]
    with pytest.raises(ParameterError, match="must be a pair"):
        suited(Rate(), alone).run(alone)


def test_names_of_folders() -> None:
    assert [folder_name(name) for name in ("stage 1", "a/b", "1.5", "rate.json", "…")] == [
        "stage 1", "a-b", "1.5", "rate-json", "pair",
    ]  # fmt: skip


@pytest.mark.long
def test_a_check_is_that_of_the_pair_alone() -> None:
    quick = CheckOptions(positions=12, refinement=0.5, convergence="off", body_teeth=3, torques=(20,))
    designs = [pair_design("a", (20, 30), 2.0, check=quick), pair_design("b", (21, 33), 2.0, check=quick)]
    design = chain(designs, -40.0, 900.0)
    job = suited(Check(report=False), design)
    found = job.run(design)
    assert [each.mesh.design.load for each in found.meshes] == [
        Load(torque=-40.0, speed=900.0),
        Load(torque=60.0, speed=-600.0),
    ]
    for each, own in zip(found.meshes, designs, strict=True):
        alone = Check(report=False)
        assert alone.complete_document(alone.run(replace(own, load=each.mesh.design.load))) == each.document
