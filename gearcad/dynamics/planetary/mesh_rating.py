"""The rating of a planetary train's meshes and stages as pairs, with what is peculiar to planets beside it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from gearcad.dynamics.planetary.masses import TrainMasses
from gearcad.dynamics.planetary.strength import MeshFactors, TrainStrength, train_strength
from gearcad.errors import InputError
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Materials
from gearcad.notice import Notice
from gearcad.per_gear import PerGear
from gearcad.planetary import PlanetaryTrain
from gearcad.planetary.materials import TrainMaterial, mesh_material, stage_material
from gearcad.planetary.mesh_loads import MeshLoad
from gearcad.rating.dynamic_factor import DynamicFactor
from gearcad.rating.options import RatingOptions
from gearcad.rating.rate import Rating, rate

__all__ = ["ALTERNATING", "MeshRating", "TrainRating", "rate_train"]

ALTERNATING = 0.7
"""Y_M of teeth that bend both ways in every turn, over that of teeth that bend one way: idlers and planets (recalled)."""

_RECALLED = {"K_v": "the inertias that count in K_v", "Y_M": f"Y_M = {ALTERNATING:g} of planets that bend both ways"}
"""What each symbol stands for."""


@dataclass(frozen=True, kw_only=True)
class MeshRating:
    """The rating of the mesh with the planet that carries most, under K_A K_gamma.

    `dynamic_factor` K_v of ISO 6336-1, Method B, is that of the pinion's speed against the carrier, not in the stresses of the
    `rating`; None where it is not known, and `no_dynamic_factor` why. `mean_stress_factor` Y_M of each gear divides the root
    stress before it is held against a limit of teeth that bend one way.
    """

    load: MeshLoad
    rating: Rating
    dynamic_factor: float | None
    no_dynamic_factor: str
    mean_stress_factor: PerGear[float]

    @property
    def planets_verify(self) -> tuple[str, ...]:
        """Symbols of what is peculiar to planets and rests on a text of the standard that was not at hand."""
        idlers = (f"{role.value}.Y_M" for role, factor in self.mean_stress_factor.items() if factor != 1)
        return (*(["K_v"] if self.dynamic_factor is not None else ()), *idlers)

    @property
    def verify(self) -> tuple[str, ...]:
        """The same of all of the rating."""
        return (*self.rating.verify, *self.planets_verify)

    def to_dict(self) -> dict[str, Any]:
        """As `rate.json` has it, K_gamma, K_v and Y_M beside the rest, and what the mesh carries."""
        found = self.rating.to_dict()
        for role, factor in self.mean_stress_factor.items():
            found[role.value]["Y_M"] = factor
        carried = self.load.to_dict()
        found |= {name: carried[name] for name in ("K_A", "K_gamma", "K_gamma_source")}
        found |= {"K_v": self.dynamic_factor, "load": carried, "verify": list(self.verify)}
        return found | ({"K_v_unknown": self.no_dynamic_factor} if self.no_dynamic_factor else {})


@dataclass(frozen=True, kw_only=True)
class TrainRating:
    """Of the meshes of a train's set and of its stages by their names; `unrated`: those that cannot be rated, and why."""

    meshes: Mapping[str, MeshRating]
    stages: Mapping[str, Rating]
    unrated: Mapping[str, str]
    strength: TrainStrength

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What of planets is to be verified, and what is not known; what each rating warns of stands with it."""
        symbols = {symbol.rpartition(".")[2] for each in self.meshes.values() for symbol in each.planets_verify}
        found = []
        if symbols:
            words = " and ".join(_RECALLED[symbol] for symbol in sorted(symbols))
            text = f"{words}: as remembered of ISO 6336, whose text was not at hand: verify them before they decide"
            found.append(Notice("planets-to-verify", text))
        for name, each in self.meshes.items():
            if each.no_dynamic_factor:
                found.append(Notice("no-dynamic-factor", f"K_v is not known: {each.no_dynamic_factor}", where=name))
        found += [Notice("unrated", f"no rating: {why}", where=name) for name, why in self.unrated.items()]
        return tuple(notice.within("rating") for notice in found)

    def to_dict(self) -> dict[str, Any]:
        """For JSON: nominal ratings by the names of meshes and stages, and the full one of each as its "rate"."""
        meshes = {name: each.to_dict() for name, each in self.meshes.items()}
        stages = {name: each.to_dict() for name, each in self.stages.items()}
        found = meshes | stages | {name: {"unrated": why} for name, why in self.unrated.items()}
        for name, each in self.strength.meshes.items():
            found[name]["rate"] = {key: value for key, value in each.to_dict().items() if key != "nominal"}
        return found


def rate_train(
    train: PlanetaryTrain,
    loads: Mapping[str, MeshLoad],
    stages: Mapping[str, Load],
    masses: TrainMasses,
    material: TrainMaterial | None = None,
    options: RatingOptions | None = None,
) -> TrainRating:
    """Rate the meshes of a train under `loads`, and its stages, as `gearcad.rate` rates a pair."""
    options = options or RatingOptions()
    meshes, rated, unrated = dict[str, MeshRating](), dict[str, Rating](), dict[str, str]()
    for name, load in loads.items():
        try:
            meshes[name] = _mesh_rating(train, load, masses, material, options)
        except InputError as error:
            unrated[name] = str(error)
    for stage in train.stages:
        try:
            rated[stage.name] = rate(stage.pair, stage_material(material, stage), stages[stage.name], options)
        except InputError as error:
            unrated[stage.name] = str(error)
    factors = {
        name: MeshFactors(each.dynamic_factor, each.no_dynamic_factor, each.mean_stress_factor, each.planets_verify)
        for name, each in meshes.items()
    }
    strength = train_strength(train, loads, stages, factors, material, options, unrated)
    return TrainRating(meshes=meshes, stages=rated, unrated=unrated, strength=strength)


def _mesh_rating(
    train: PlanetaryTrain, load: MeshLoad, masses: TrainMasses, material: TrainMaterial | None, options: RatingOptions
) -> MeshRating:
    mesh = load.mesh
    made_of = mesh_material(material, mesh)
    rating = rate(mesh.pair, made_of, load.load, options)
    factor, why = _dynamic_factor(mesh.pair, made_of, load.load, _inertias(train, load, masses), options)
    bends = PerGear.each(lambda role: ALTERNATING if role is mesh.rim_role and not train.stepped else 1.0)
    return MeshRating(load=load, rating=rating, dynamic_factor=factor, no_dynamic_factor=why, mean_stress_factor=bends)


def _inertias(train: PlanetaryTrain, load: MeshLoad, masses: TrainMasses) -> PerGear[float] | str:
    """kg·m² that count in one mesh (recalled of ISO 6336-1): all of the planet, the N-th part of a central, what is held
    infinite; or why they are not known."""
    central, planet = masses.members[load.mesh.central.name], masses.planet
    held = train.fixed == load.mesh.central.name
    own = math.inf if held else central.inertia
    if own is None or planet.inertia is None:
        return planet.why if planet.inertia is None else central.why
    counted = {load.mesh.central_role: own / train.planets, load.mesh.rim_role: planet.inertia}
    return PerGear.each(lambda role: counted[role])


def _dynamic_factor(
    pair: GearPair, material: Materials, load: Load, inertias: PerGear[float] | str, options: RatingOptions
) -> tuple[float | None, str]:
    """K_v at the load's speed, or None and why."""
    if isinstance(inertias, str):
        return None, inertias
    try:
        return float(DynamicFactor.of(pair, material, load, inertias, options).values(load.speed)), ""
    except InputError as error:
        return None, str(error)
