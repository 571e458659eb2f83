"""Inertias of a train that are from the solids of its gears: against trimesh, the pair alone, and numbers that are given."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import gearcad
from gearcad import Body, Gear, GearPair, Load, Material
from gearcad.core.errors import ParameterError, SpecError
from gearcad.core.records import PerGear
from gearcad.designs import read_spec
from gearcad.dynamics import DynamicsOptions, Inertia, MeshPair, Shaft, ToothMesh, Train, engaged, study_train
from gearcad.dynamics.pair_result import PairStudy
from gearcad.solids.facets.tessellation import tessellate

QUICK = DynamicsOptions(stiffness="potential-energy", speeds=3, speed_from=900.0, speed_to=1100.0, harmonics=4)

FACETS = 2e-3
"""Relative: what flat facets of 0.01 mm leave of an inertia."""


def gear(teeth: int, **more: Any) -> Gear:
    return Gear(teeth=teeth, normal_module=2.0, face_width=20.0, tooth_thinning=0.03, body=Body(bore=12.0), **more)


def pair(pinion: int = 20, wheel: int = 31) -> GearPair:
    return GearPair(pinion=gear(pinion), wheel=gear(wheel), name="z")


def train(*inertias: Inertia, material: Any = None) -> Train:
    of = MeshPair(pair=pair(), material=material or Material())
    return Train(
        inertias=inertias,
        meshes=(ToothMesh(name="m", pinion="p", wheel="w", pair=of, backlash=None),),
        torques={"p": 50.0, "w": 77.5},
        speed=1000.0,
    )


def test_an_inertia_from_its_solid_is_that_of_its_facets() -> None:
    """Steel and a wheel of bronze: volume integrals by trimesh of the flat facets of the same gear."""
    bronze = Material(density=8800.0)
    found = train(Inertia(name="p"), Inertia(name="w"), material=PerGear(Material(), bronze))
    for each, teeth, density in zip(found.inertias, (20, 31), (7850.0, 8800.0), strict=True):
        mesh = tessellate(gear(teeth)).to_trimesh()
        mesh.density = density * 1e-9
        about_axis = float(mesh.moment_inertia[2, 2]) * 1e-6
        assert each.inertia == pytest.approx(about_axis, rel=FACETS)


def test_a_train_of_solids_is_the_pair_alone_of_its_solids() -> None:
    """A pair alone has the inertias of its solids by itself."""
    alone = gearcad.dynamics(pair(), Load(torque=50.0, speed=1000.0), dynamics=QUICK)
    assert isinstance(alone, PairStudy)
    found = engaged(train(Inertia(name="p"), Inertia(name="w")), QUICK)
    assert [each.inertia for each in found.inertias] == pytest.approx(list(alone.inertias), rel=1e-12)
    study = study_train(found, QUICK)
    assert study.modes.frequency[1] == pytest.approx(alone.study.modes.frequency[1], rel=1e-9)
    notices = [notice for notice in study.notices if notice.code == "inertia-from-solid"]
    assert [notice.where for notice in notices] == ["p", "w"]
    assert "is from its solid, pinion of m" in notices[0].text


def test_what_is_given_counts_and_is_not_told() -> None:
    found = train(Inertia(name="p", inertia=0.5), Inertia(name="w"))
    assert found.inertias[0].inertia == 0.5
    notices = [notice.where for notice in study_train(found, QUICK).notices if notice.code == "inertia-from-solid"]
    assert notices == ["w"]
    other = replace(found, meshes=[replace(found.meshes[0], pair=pair(20, 62))], torques={"p": 50.0, "w": 155.0})
    assert 12 < other.inertias[1].inertia / found.inertias[1].inertia < 20  # about the fourth power of the diameter


def test_an_idler_counts_once_and_two_gears_on_one_inertia_together() -> None:
    idler = (("a", "b", pair(20, 31)), ("b", "c", pair(31, 40)))
    block = (("a", "b", pair(20, 31)), ("b", "c", pair(18, 40)))
    single = train(Inertia(name="p"), Inertia(name="w")).inertias[1].inertia
    eighteen = Train(
        inertias=(Inertia(name="p"), Inertia(name="w")), meshes=(ToothMesh(name="m", pinion="p", wheel="w", pair=pair(18, 40)),)
    ).inertias[0].inertia  # fmt: skip
    for pairs, expected in ((idler, single), (block, single + eighteen)):
        meshes = [ToothMesh(name=f"{a}{b}", pinion=a, wheel=b, pair=of) for a, b, of in pairs]
        found = Train(inertias=[Inertia(name=name) for name in "abc"], meshes=meshes)
        assert found.inertias[1].inertia == pytest.approx(expected, rel=1e-12)
        assert math.isfinite(found.inertias[0].inertia)


def test_what_is_no_gear_of_a_pair_must_be_given(tmp_path: Path) -> None:
    shaft = Shaft(name="s", start="motor", end="p", torsional_stiffness=1e4)
    inertias = [Inertia(name=name) for name in ("motor", "p", "w")]
    with pytest.raises(ParameterError, match=r"motor\.inertia is missing: must be given in kg·m²: it is no gear of a pair"):
        replace(train(*inertias[1:]), inertias=inertias, shafts=[shaft])
    spec = tmp_path / "train.toml"
    text = "[train]\n[[train.inertia]]\nname = 'a'\n[[train.inertia]]\nname = 'b'\ninertia = 1.0\n"
    text += "[[train.shaft]]\nname = 's'\nstart = 'a'\nend = 'b'\ntorsional_stiffness = 1e4\n"
    spec.write_text(text, encoding="utf-8")
    with pytest.raises(SpecError, match="must be given in kg·m²"):
        read_spec(spec)
