"""Does a planetary train hold: its meshes and stages by the full rating, and each gear by all of its meshes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from gearcad.errors import InputError, ParameterError
from gearcad.load import Load
from gearcad.notice import Notice, texts
from gearcad.per_gear import PerGear
from gearcad.planetary import PlanetaryTrain, SetMesh
from gearcad.planetary.materials import TrainMaterial, mesh_material, stage_material
from gearcad.planetary.mesh_loads import FactorSource, MeshLoad
from gearcad.rating.load_factors import LoadFactors
from gearcad.rating.options import RatingOptions
from gearcad.rating.strength import Part, PartStrength, StrengthRating, rate_strength
from gearcad.rating.strength.called import called
from gearcad.rating.strength.part import told
from gearcad.reprs import Pictured
from gearcad.schema import is_assumed
from gearcad.verdict import NOT_ASKED_WORDS, Verdict, strength_verdict

__all__ = ["GearStrength", "LeastSafety", "MeshFactors", "TrainStrength", "asks_strength", "train_strength"]


class MeshFactors(NamedTuple):
    """What the mesh with a planet has of its own: K_v with the masses of the set, None where it is not known, and why; Y_M;
    symbols of what of it is to be verified."""

    dynamic: float | None
    unknown: str
    mean_stress: PerGear[float]
    verify: tuple[str, ...]


class LeastSafety(NamedTuple):
    """The least safety of a flank or a root, and the mesh in which it is."""

    safety: float
    mesh: str


@dataclass(frozen=True)
class GearStrength:
    """What flanks and roots of one gear of a train bear, by the names of its meshes; two of the two flanks of a planet."""

    flank: Mapping[str, PartStrength]
    root: Mapping[str, PartStrength]

    def least(self, part: Part) -> LeastSafety | None:
        """The least safe place; None where no mesh was judged."""
        of = self.flank if part is Part.FLANK else self.root
        known = [LeastSafety(each.safety, mesh) for mesh, each in of.items() if each.safety is not None]
        return min(known, default=None)

    @property
    def every(self) -> Iterator[PartStrength]:
        """Flanks and roots in all meshes."""
        yield from self.flank.values()
        yield from self.root.values()

    def to_dict(self) -> dict[str, Any]:
        """The least safeties, each with its mesh; None where nothing was judged."""
        found = {part.value: self.least(part) for part in Part}
        return {
            **{name: None if least is None else least.safety for name, least in found.items()},
            **{f"{name}_mesh": None if least is None else least.mesh for name, least in found.items()},
        }


@dataclass(frozen=True, kw_only=True)
class TrainStrength(Pictured):
    """Full ratings of the `meshes` and stages of a train by their names; `unrated`: those without one, and why.

    `gears` are the names of the gears of each mesh and stage, `names` of all in their order. `asked` is whether limits,
    qualities or required safeties ask for a verdict on strength.
    """

    name: str
    options: RatingOptions
    meshes: Mapping[str, StrengthRating]
    unrated: Mapping[str, str]
    gears: Mapping[str, PerGear[str]]
    names: tuple[str, ...]
    asked: bool = True

    def __repr__(self) -> str:
        return f"<TrainStrength of {self.name!r}: {self.verdict}>"

    @property
    def members(self) -> dict[str, GearStrength]:
        """What each gear bears."""
        return {name: GearStrength(self._parts(Part.FLANK, name), self._parts(Part.ROOT, name)) for name in self.names}

    def _parts(self, part: Part, gear: str) -> dict[str, PartStrength]:
        return {
            mesh: rating.parts[part].pick(role)
            for mesh, rating in self.meshes.items()
            for role, name in self.gears[mesh].items()
            if name == gear
        }

    @property
    def strength(self) -> Verdict:
        """The verdict on strength of all meshes and stages by `strength_verdict`."""
        found = [verdict for each in self.meshes.values() for verdict in each.required_verdicts]
        return strength_verdict(self.asked, [*found, *(Verdict.NOT_JUDGED for _ in self.unrated)])

    @property
    def passed(self) -> bool | None:
        """Whether strength is passed or failed; None where it was not judged, or not asked for."""
        return {Verdict.PASSED: True, Verdict.FAILED: False}.get(self.strength)

    @property
    def not_judged(self) -> dict[str, str]:
        """What was not, and why."""
        found = {f"{mesh}, {part}": why for mesh, each in self.meshes.items() for part, why in each.not_judged.items()}
        return {**self.unrated, **found}

    @property
    def failed(self) -> tuple[str, ...]:
        """Flanks and roots below their required safeties, and meshes that scuff."""
        found = [
            f"{part} of {name} in {mesh}"
            for name, gear in self.members.items()
            for part, parts in (("flank", gear.flank), ("root", gear.root))
            for mesh, each in parts.items()
            if each.verdict is Verdict.FAILED
        ]
        scuffed = [f"scuffing of {mesh}" for mesh, each in self.meshes.items() if each.scuffing_verdict is Verdict.FAILED]
        return (*found, *scuffed)

    @property
    def life(self) -> float | None:
        """Hours until the first part that was judged fails, with the required safeties; can be infinite."""
        return min((each.life for each in self.meshes.values() if each.life is not None), default=None)

    @property
    def verdict(self) -> str:
        """In one line."""
        if self.strength is Verdict.FAILED:
            return "; ".join((f"strength NOT passed: {', '.join(self.failed)}", *self._scuffing_unasked))
        if self.strength is Verdict.PASSED:
            return "; ".join(("strength passed", *self._scuffing_unasked))
        if self.strength is Verdict.NOT_ASKED:
            return f"strength {NOT_ASKED_WORDS}"
        return f"strength not judged: {'; '.join(dict.fromkeys(self.not_judged.values()))}"

    @property
    def _scuffing_unasked(self) -> Iterator[str]:
        """Of meshes that may scuff where no safety is required."""
        return (f"{name}: {each.scuffing_unasked}" for name, each in self.meshes.items() if each.scuffing_unasked)

    @property
    def assumed(self) -> tuple[str, ...]:
        """What was not given, of all meshes."""
        return tuple(dict.fromkeys(each for rating in self.meshes.values() for each in rating.assumed))

    @property
    def verify(self) -> tuple[str, ...]:
        """Symbols of what rests on one source or on memory, of all meshes."""
        return tuple(dict.fromkeys(each for rating in self.meshes.values() for each in rating.verify))

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Those of each mesh."""
        return tuple(notice.within(name) for name, each in self.meshes.items() for notice in each.notices)

    def summary(self) -> dict[str, Any]:
        """What is said of the train: safeties of its gears, life (h), verdict."""
        return {
            "safety": {name: gear.to_dict() for name, gear in self.members.items()},
            "required": {
                "flank": self.options.required_safety_flank,
                "root": self.options.required_safety_root,
                "scuffing": self.options.required_safety_scuffing,
            },
            "life": told(self.life),
            "not_judged": self.not_judged,
            "strength": self.strength.value,
            "passed": self.passed,
        }

    def to_dict(self) -> dict[str, Any]:
        """What rate.json holds, but for kind and name."""
        return {
            "meshes": {name: each.to_dict() for name, each in self.meshes.items()},
            "unrated": dict(self.unrated),
            **self.summary(),
            "assumed": list(self.assumed),
            "verify": list(self.verify),
            "notices": [notice.to_dict() for notice in self.notices],
            "warnings": list(texts(self.notices)),
        }


def train_strength(
    train: PlanetaryTrain,
    loads: Mapping[str, MeshLoad],
    stages: Mapping[str, Load],
    factors: Mapping[str, MeshFactors],
    material: TrainMaterial | None,
    options: RatingOptions,
    unrated: Mapping[str, str] | None = None,
) -> TrainStrength:
    """Rate every mesh of a set under `loads`, and every stage, as `rate_strength` rates a pair.

    Of a mesh with planets K_gamma is that of its load, K_v of Method B and Y_M are those of its `factors`; a central has a
    contact with each planet in one turn against the carrier, a planet one on each of its flanks. `unrated` are those that have
    no rating even without load factors, and why.
    """
    pairs = {mesh.name: mesh.pair for mesh in train.meshes} | {stage.name: stage.pair for stage in train.stages}
    made_of = {mesh.name: mesh_material(material, mesh) for mesh in train.meshes}
    made_of |= {stage.name: stage_material(material, stage) for stage in train.stages}
    gears = {mesh.name: _names(mesh) for mesh in train.meshes}
    gears |= {stage.name: stage.pair.gears.map(lambda gear: gear.name) for stage in train.stages}
    rated, without = dict[str, StrengthRating](), dict(unrated or {})
    for name, pair in pairs.items():
        if name in without:
            continue
        try:
            if name not in loads:
                rated[name] = called(rate_strength(pair, made_of[name], stages[name], options), gears[name])
                continue
            load, own = loads[name], _of_mesh(loads[name], factors[name], options)
            rating = rate_strength(pair, made_of[name], load.even, own, driver=load.driver)
            rating = replace(rating, assumed=(*_assumed(load), *rating.assumed), verify=(*factors[name].verify, *rating.verify))
            found = {} if options.dynamic_factor != "B" else {"K_v": _OF_SET}
            found |= (
                {} if load.mesh_load_factor.source is FactorSource.GIVEN else {"K_gamma": load.mesh_load_factor.source.value}
            )
            rated[name] = called(_sourced(rating, found), gears[name])
        except InputError as error:
            without[name] = str(error)
    names = tuple(dict.fromkeys((*train.gears, *(name for pair in gears.values() for name in pair))))
    return TrainStrength(
        name=train.name,
        options=options,
        meshes=rated,
        unrated=without,
        gears=gears,
        names=names,
        asked=asks_strength(material, options),
    )


def asks_strength(material: TrainMaterial | None, options: RatingOptions | None) -> bool:
    """Return whether a material of a train, or a required safety, asks for a verdict on strength."""
    materials = material.values() if isinstance(material, Mapping) else () if material is None else (material,)
    return (options is not None and options.asks_strength) or any(each.asks_strength for each in materials)


_OF_SET = "ISO 6336-1, 6, Method B, with the masses of the set"
"""The source of K_v of a mesh with planets that nobody gave."""


def _sourced(rating: StrengthRating, sources: Mapping[str, str]) -> StrengthRating:
    """Return a rating whose load factors have these sources, by their symbols."""
    if not sources or rating.governing is None or rating.load_factors is None:
        return rating

    def own(factors: LoadFactors) -> LoadFactors:
        return replace(factors, sources={**factors.sources, **sources})

    cases = tuple(replace(case, factors=own(case.factors)) for case in rating.cases)
    at = rating.governing_number
    governing = replace(rating.governing, factors=own(rating.governing.factors)) if at is None else cases[at - 1]
    return replace(rating, load_factors=own(rating.load_factors), cases=cases, governing=governing)


def _names(mesh: SetMesh) -> PerGear[str]:
    """Of both gears of a mesh, those of the central and the rim."""
    return PerGear.each(lambda role: mesh.central.name if role is mesh.central_role else mesh.rim.name)


def _of_mesh(load: MeshLoad, factors: MeshFactors, options: RatingOptions) -> RatingOptions:
    """The options of a pair that stands for one of N meshes, where they do not say themselves. Raises ParameterError."""
    if options.mesh_load_factor != 1:
        permitted = "must be left out: that of a planetary train is mesh_load_factor of its [load], or computed"
        raise ParameterError("rating.mesh_load_factor", options.mesh_load_factor, permitted)
    if options.dynamic_factor == "B":
        if factors.dynamic is None:
            raise ParameterError("K_v", None, f"must be known: {factors.unknown}")
        options = replace(options, dynamic_factor=factors.dynamic)
    own = dict[str, Any]()
    if is_assumed(options.contacts_per_turn):
        own["contacts_per_turn"] = tuple(map(float, load.contacts))
    if is_assumed(options.mean_stress_factor):
        own["mean_stress_factor"] = tuple(factors.mean_stress)
    return replace(options, mesh_load_factor=load.mesh_load_factor.value, **own)


def _assumed(load: MeshLoad) -> Iterator[str]:
    if load.mesh_load_factor.source is FactorSource.EQUAL:
        yield "mesh_load_factor = 1 in [load]: all planets carry alike"
