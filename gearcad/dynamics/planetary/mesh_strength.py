"""The strength of a planetary train: each of its meshes, and its stages, as a pair under what one planet carries."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from gearcad.dynamics.planetary.masses import TrainMasses
from gearcad.dynamics.planetary.mesh_rating import ALTERNATING, mesh_dynamic_factor
from gearcad.errors import InputError, ParameterError
from gearcad.load import Load
from gearcad.material import Materials
from gearcad.notice import Notice, texts
from gearcad.per_gear import Role
from gearcad.planetary import PlanetaryTrain
from gearcad.planetary.materials import TrainMaterial, mesh_material, stage_material
from gearcad.planetary.mesh_loads import FactorSource, MeshLoad
from gearcad.rating.options import RatingOptions
from gearcad.rating.strength import StrengthRating, rate_strength
from gearcad.verdict import Verdict, together

__all__ = ["TrainStrength", "train_strength"]


@dataclass(frozen=True, kw_only=True)
class TrainStrength:
    """The ratings of all meshes of a train by their names; `unrated`: those that cannot be rated, and why."""

    name: str
    meshes: Mapping[str, StrengthRating]
    unrated: Mapping[str, str]

    @property
    def strength(self) -> Verdict:
        """Passed if all meshes are."""
        found = [each.strength for each in self.meshes.values()]
        return together([*found, *(Verdict.NOT_JUDGED for _ in self.unrated)])

    @property
    def passed(self) -> bool | None:
        """None where not all was judged, and nothing failed."""
        return None if self.strength is Verdict.NOT_JUDGED else self.strength is Verdict.PASSED

    @property
    def verdict(self) -> str:
        """In one line."""
        told = [f"{name}: {each.verdict}" for name, each in self.meshes.items()]
        return "; ".join([*told, *(f"{name}: not rated: {why}" for name, why in self.unrated.items())])

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Those of each mesh."""
        return tuple(notice.within(name) for name, each in self.meshes.items() for notice in each.notices)

    def to_dict(self) -> dict[str, Any]:
        """What rate.json holds, but for kind and name."""
        return {
            "meshes": {name: each.to_dict() for name, each in self.meshes.items()},
            "unrated": dict(self.unrated),
            "strength": self.strength.value,
            "passed": self.passed,
            "warnings": list(texts(self.notices)),
        }


def train_strength(
    train: PlanetaryTrain,
    loads: Mapping[str, MeshLoad],
    stages: Mapping[str, Load],
    masses: TrainMasses,
    material: TrainMaterial | None = None,
    options: RatingOptions | None = None,
) -> TrainStrength:
    """Rate the meshes of a train under `loads`, and its stages; see `rate_strength`."""
    options = options or RatingOptions()
    found, unrated = dict[str, StrengthRating](), dict[str, str]()
    makes: dict[str, Callable[[], StrengthRating]] = {
        name: partial(_of_mesh, train, load, masses, mesh_material(material, load.mesh), options)
        for name, load in loads.items()
    }
    for stage in train.stages:
        makes[stage.name] = partial(rate_strength, stage.pair, stage_material(material, stage), stages[stage.name], options)
    for name, make in makes.items():
        try:
            found[name] = make()
        except InputError as error:
            unrated[name] = str(error)
    return TrainStrength(name=train.name, meshes=found, unrated=unrated)


def _of_mesh(
    train: PlanetaryTrain, load: MeshLoad, masses: TrainMasses, material: Materials, options: RatingOptions
) -> StrengthRating:
    """With K_gamma, load cycles, Y_M and the masses of planets, where the options say nothing else of them."""
    mesh, own = load.mesh, RatingOptions()
    given: dict[str, Any] = {"mesh_load_factor": load.mesh_load_factor.value}
    if options.contacts_per_turn == own.contacts_per_turn:
        given["contacts_per_turn"] = tuple(map(float, load.contacts))
    if options.mean_stress_factor == own.mean_stress_factor and not train.stepped:
        given["mean_stress_factor"] = tuple(ALTERNATING if role is mesh.rim_role else 1.0 for role in Role)
    if options.dynamic_factor == "B" and load.load.speed:
        factor, why = mesh_dynamic_factor(train, load, masses, material, options)
        if factor is None:
            raise ParameterError("rating.dynamic_factor", None, f"must be given, for K_v is not known: {why}")
        given["dynamic_factor"] = factor
    found = rate_strength(mesh.pair, material, load.even, replace(options, **given))
    equal = load.mesh_load_factor.source is FactorSource.EQUAL
    told = ("mesh_load_factor = 1 in [load]: all planets carry alike",) if equal else ()
    return replace(found, assumed=(*told, *found.assumed))
