"""The meshes of planetary trains as designs and specs of pairs."""

import tomllib
from dataclasses import replace
from typing import Any

import pytest
from support.loaded_trains import alm_set, pre_stage, simple_set

from gearcad import Load, Material, check, dynamics, rate, stiffness
from gearcad.core.errors import ParameterError
from gearcad.designs import MeshPairs, PairDesign, PlanetaryDesign, design_from_tables
from gearcad.planetary import PlanetaryTrain, TrainLoad
from gearcad.rating.editions import Edition
from gearcad.rating.options import RatingOptions


def design(train: PlanetaryTrain, **given: Any) -> PlanetaryDesign:
    load = TrainLoad(torque=1600.0, speed=954.93)
    return PlanetaryDesign(**{"name": "train", "train": train, "load": load} | given)


def read(text: str) -> PairDesign:
    """The name of the file is no help."""
    found = design_from_tables(tomllib.loads(text), where=lambda key: key, default_name="unnamed")
    assert isinstance(found, PairDesign)
    return found


ALM = alm_set(stages=(pre_stage(),), input="pinion_1")
TRAINS = [ALM, simple_set(24, 21), simple_set(20, 32, helix_angle=12.5), simple_set(24, 21, fixed=None)]


@pytest.mark.parametrize("train", TRAINS, ids=lambda train: f"{train.set_type.value}{train.planets}")
def test_specs_give_the_pairs_to_the_last_digit(train: PlanetaryTrain) -> None:
    given = {"material": Material(name="steel", root_limit=400.0), "rating": RatingOptions(standard=Edition.DIN_1987)}
    speeds = {} if train.fixed else {"ring": 11.1}
    pairs = MeshPairs(design=design(train, speeds=speeds, **given), computed_factor=1.1)
    names = [*(mesh.name for mesh in train.meshes), *(stage.name for stage in train.stages)]
    assert list(pairs.texts) == [f"{name}.toml" for name in names]
    for name, text in zip(names, pairs.texts.values(), strict=True):
        assert read(text) == pairs.designs[name]
        assert read(text).pair.to_dict() == pairs.designs[name].pair.to_dict()
    for mesh in train.meshes:
        own = pairs.designs[mesh.name]
        assert own.name == own.pair.name == f"train-{mesh.name}"
        assert replace(own.pair, name=mesh.name) == mesh.pair


def test_loads_of_the_alm_thesis() -> None:
    pairs = MeshPairs(design=design(ALM))
    forces = {name: abs(each.load.torque) * 2000 / each.pair.pinion.base_diameter for name, each in pairs.designs.items()}
    assert forces["ring_4-rim_3"] == pytest.approx(5374.64, abs=0.005)
    assert forces["ring_5-rim_3p"] == pytest.approx(6063.69, abs=0.005)
    assert forces["pre_stage"] == pytest.approx(1014.84, abs=0.005)


def test_what_a_spec_says_of_its_load() -> None:
    """K_gamma as given, as computed, or none; nothing of a load that is not there."""
    simple = simple_set(24, 21)
    by_errors = MeshPairs(design=design(simple, load=TrainLoad(torque=200, application_factor=1.25)), computed_factor=1.2)
    text = by_errors.texts["sun-planet.toml"]
    assert "# application_factor is K_A 1.25 times K_gamma 1.2 (computed of the train's errors)." in text
    assert read(text).load.application_factor == 1.5
    assert "# they have 0.7 (Y_M of ISO 6336-3, recalled)." in text
    given = MeshPairs(design=design(simple, load=TrainLoad(torque=200, mesh_load_factor=1.3)), computed_factor=1.2)
    assert "K_gamma 1.3 (as given)" in given.texts["ring-planet.toml"]
    assert "K_gamma 1 (equal shares)" in MeshPairs(design=design(alm_set())).texts["ring_4-rim_3.toml"]
    assert "Y_M" not in MeshPairs(design=design(alm_set())).texts["ring_4-rim_3.toml"]
    bare = MeshPairs(design=design(simple, load=None)).texts["sun-planet.toml"]
    assert "# The train has no load." in bare
    assert read(bare).load is None


def test_jobs_of_pairs_name_the_specs() -> None:
    """check, stiffness and dynamics of a planetary train, in one line; its meshes are taken."""
    own = design(simple_set(24, 21))
    for job in (check, stiffness, dynamics):
        with pytest.raises(ParameterError) as caught:
            job(own)
        message = str(caught.value)
        assert "`gearcad planetary` writes the specs of its meshes for that, sun-planet.toml and ring-planet.toml" in message
        assert "\n" not in message
    pairs = MeshPairs(design=own).designs
    assert stiffness(pairs["ring-planet"], methods=["iso6336"]).load == pairs["ring-planet"].load
    twice = replace(pairs["sun-planet"], load=Load(torque=2 * pairs["sun-planet"].load.torque))
    stress, more = (rate(each).nominal.root_stresses.pinion for each in (pairs["sun-planet"], twice))
    assert more == pytest.approx(2 * stress)


def test_every_spec_has_a_file_of_its_own() -> None:
    twice = replace(pre_stage(), name="ring_4-rim_3")
    with pytest.raises(ParameterError, match=r"name = 'ring_4-rim_3': must be given once: every mesh and stage"):
        design(alm_set(stages=(twice,), input="pinion_1"))
    with pytest.raises(ParameterError, match="must be a plain file name"):
        design(alm_set(stages=(replace(pre_stage(), name="pre/stage"),), input="pinion_1"))
