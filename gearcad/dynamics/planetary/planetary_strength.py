"""Rating of a planetary train: its meshes and stages as pairs, each gear by all of its meshes, and published K_gamma."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from gearcad.core.errors import InputError, ParameterError
from gearcad.core.records import (
    NOT_ASKED_WORDS,
    JsonObject,
    Notice,
    PerGear,
    Pictured,
    Verdict,
    is_assumed,
    strength_verdict,
    texts,
)
from gearcad.dynamics.planetary.planar_model import TrainMasses
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Materials
from gearcad.planetary import PlanetaryTrain, SetMesh
from gearcad.planetary.members import TrainMaterial, mesh_material, stage_material
from gearcad.planetary.power import FactorSource, MeshLoad
from gearcad.rating.dynamic_factor import DynamicFactor
from gearcad.rating.load_factors import LoadFactors
from gearcad.rating.nominal_rating import Rating, rate
from gearcad.rating.options import RatingOptions
from gearcad.rating.strength import PartStrength, RatedPart, StrengthRating, rate_strength
from gearcad.rating.strength.duty import told
from gearcad.rating.strength.rating import called


@dataclass(frozen=True, kw_only=True)
class PublishedFactor:
    """K_gamma of a source for the planets of a train; `recalled`: not read in the source itself, to be verified."""

    source: str
    factor: float
    recalled: bool

    def to_dict(self) -> JsonObject:
        """Return a dictionary for JSON."""
        return {"source": self.source, "factor": self.factor, "recalled": self.recalled}


@dataclass(frozen=True, kw_only=True)
class PublishedFactors:
    """K_gamma of a source by the number of planets, up to `most` of them.

    The value of the last key holds for more planets where `most` allows.
    """

    source: str
    by_planets: Mapping[int, float]
    most: int
    recalled: bool

    def of(self, planets: int) -> PublishedFactor | None:
        """Return the factor for a number of planets; None where the source has none."""
        known = [count for count in self.by_planets if count <= planets]
        if not known or planets > self.most:
            return None
        return PublishedFactor(source=self.source, factor=self.by_planets[max(known)], recalled=self.recalled)


_ANY = 10**6

PUBLISHED = (
    PublishedFactors(
        source="ABS, as the FVA-Workbench applies it",
        by_planets={1: 1.0, 4: 1.2, 5: 1.3, 6: 1.4},
        most=_ANY,
        recalled=False,
    ),
    PublishedFactors(
        source="IEC 61400-4",
        by_planets={3: 1.10, 4: 1.25, 5: 1.35, 6: 1.44},
        most=6,
        recalled=True,
    ),
)
"""ABS is read in the help of the FVA-Workbench (attribute abs_force_distribution_factor). ANSI/AGMA 6123 has a table by level
of application, which was not at hand; ISO 6336-1 itself has none."""


def published_factors(planets: int) -> tuple[PublishedFactor, ...]:
    """Return K_gamma of each source that has one for a number of planets.

    >>> [(each.factor, each.recalled) for each in published_factors(4)]
    [(1.2, False), (1.25, True)]
    """
    found = (table.of(planets) for table in PUBLISHED)
    return tuple(each for each in found if each is not None)


class MeshFactors(NamedTuple):
    """Factors of the mesh with a planet: K_v with the masses of the set, and Y_M.

    `dynamic` is None where K_v is not known, and `unknown` says why. `verify` are the symbols of factors that are to be
    verified.
    """

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
    """Strength of flanks and roots of one gear of a train, by the names of its meshes; two for the two flanks of a planet."""

    flank: Mapping[str, PartStrength]
    root: Mapping[str, PartStrength]

    def least(self, part: RatedPart) -> LeastSafety | None:
        """Return the least safety and its mesh; None where no mesh was judged."""
        of = self.flank if part is RatedPart.FLANK else self.root
        known = [LeastSafety(each.safety, mesh) for mesh, each in of.items() if each.safety is not None]
        return min(known, default=None)

    @property
    def every(self) -> Iterator[PartStrength]:
        """Flanks and roots in all meshes."""
        yield from self.flank.values()
        yield from self.root.values()

    def to_dict(self) -> JsonObject:
        """Return the least safeties, each with its mesh; None where nothing was judged."""
        found = {part.value: self.least(part) for part in RatedPart}
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
        """Strength of each gear, by its name."""
        return {
            name: GearStrength(self._parts(RatedPart.FLANK, name), self._parts(RatedPart.ROOT, name)) for name in self.names
        }

    def _parts(self, part: RatedPart, gear: str) -> dict[str, PartStrength]:
        return {
            mesh: rating.parts[part].pick(role)
            for mesh, rating in self.meshes.items()
            for role, name in self.gears[mesh].items()
            if name == gear
        }

    @property
    def strength(self) -> Verdict:
        """Verdict on strength of all meshes and stages by `strength_verdict`."""
        found = [verdict for each in self.meshes.values() for verdict in each.required_verdicts]
        return strength_verdict(self.asked, [*found, *(Verdict.NOT_JUDGED for _ in self.unrated)])

    @property
    def passed(self) -> bool | None:
        """Whether strength is passed or failed; None where it was not judged, or not asked for."""
        return {Verdict.PASSED: True, Verdict.FAILED: False}.get(self.strength)

    @property
    def not_judged(self) -> dict[str, str]:
        """Meshes and parts that were not judged, and the reasons."""
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
        """Verdict in one line."""
        if self.strength is Verdict.FAILED:
            return "; ".join((f"strength NOT passed: {', '.join(self.failed)}", *self._scuffing_unasked))
        if self.strength is Verdict.PASSED:
            return "; ".join(("strength passed", *self._scuffing_unasked))
        if self.strength is Verdict.NOT_ASKED:
            return f"strength {NOT_ASKED_WORDS}"
        return f"strength not judged: {'; '.join(dict.fromkeys(self.not_judged.values()))}"

    @property
    def _scuffing_unasked(self) -> Iterator[str]:
        """Words for meshes that may scuff where no safety is required."""
        return (f"{name}: {each.scuffing_unasked}" for name, each in self.meshes.items() if each.scuffing_unasked)

    @property
    def assumed(self) -> tuple[str, ...]:
        """Inputs that were assumed, of all meshes."""
        return tuple(dict.fromkeys(each for rating in self.meshes.values() for each in rating.assumed))

    @property
    def verify(self) -> tuple[str, ...]:
        """Symbols of values that rest on one source or on memory, of all meshes."""
        return tuple(dict.fromkeys(each for rating in self.meshes.values() for each in rating.verify))

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices of each mesh."""
        return tuple(notice.within(name) for name, each in self.meshes.items() for notice in each.notices)

    def summary(self) -> dict[str, Any]:
        """Return the summary of the train: safeties of its gears, life (h), verdict."""
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

    def to_dict(self) -> JsonObject:
        """Return the contents of rate.json, without kind and name."""
        return {
            "meshes": {name: each.to_dict() for name, each in self.meshes.items()},
            "unrated": dict(self.unrated),
            **self.summary(),
            "assumed": list(self.assumed),
            "verify": list(self.verify),
            "unconfirmed": list(self.verify),
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

    A mesh with planets has K_gamma of its load, and K_v of Method B and Y_M of its `factors`. A central has a contact with each
    planet in one turn against the carrier, a planet one on each of its flanks. `unrated` are meshes and stages that have no
    rating even without load factors, and why.
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
"""Source of K_v of a mesh with planets where K_v was not given."""


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
    """Return the names of both gears of a mesh, those of the central and the rim."""
    return PerGear.each(lambda role: mesh.central.name if role is mesh.central_role else mesh.rim.name)


def _of_mesh(load: MeshLoad, factors: MeshFactors, options: RatingOptions) -> RatingOptions:
    """Return the options of a pair that stands for one of N meshes; options that are given are kept.

    Raises ParameterError.
    """
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


ALTERNATING = 0.7
"""Y_M of teeth that bend both ways in every turn, over that of teeth that bend one way: idlers and planets (recalled)."""

_RECALLED = {"K_v": "the inertias that count in K_v", "Y_M": f"Y_M = {ALTERNATING:g} of planets that bend both ways"}
"""Meaning of each symbol."""


@dataclass(frozen=True, kw_only=True)
class MeshRating:
    """The rating of the mesh with the planet that carries most, under K_A K_gamma.

    `dynamic_factor` K_v of ISO 6336-1, Method B, is that of the pinion's speed against the carrier, not in the stresses of the
    `rating`. It is None where it is not known, and `no_dynamic_factor` says why. `mean_stress_factor` Y_M of each gear divides
    the root stress before it is held against a limit of teeth that bend one way.
    """

    load: MeshLoad
    rating: Rating
    dynamic_factor: float | None
    no_dynamic_factor: str
    mean_stress_factor: PerGear[float]

    @property
    def planets_verify(self) -> tuple[str, ...]:
        """Symbols of values for planets only that are to be verified, since the text of the standard was not at hand."""
        idlers = (f"{role.value}.Y_M" for role, factor in self.mean_stress_factor.items() if factor != 1)
        return (*(["K_v"] if self.dynamic_factor is not None else ()), *idlers)

    @property
    def verify(self) -> tuple[str, ...]:
        """Symbols to verify of all of the rating, those for planets included."""
        return (*self.rating.verify, *self.planets_verify)

    def to_dict(self) -> JsonObject:
        """Return the rating as a part of `rate.json`, with K_gamma, K_v, Y_M and the load of the mesh."""
        found = self.rating.to_dict()
        for role, factor in self.mean_stress_factor.items():
            found[role.value]["Y_M"] = factor
        carried = self.load.to_dict()
        found |= {name: carried[name] for name in ("K_A", "K_gamma", "K_gamma_source")}
        found |= {"K_v": self.dynamic_factor, "load": carried, "verify": list(self.verify), "unconfirmed": list(self.verify)}
        return found | ({"K_v_unknown": self.no_dynamic_factor} if self.no_dynamic_factor else {})


@dataclass(frozen=True, kw_only=True)
class TrainRating:
    """Ratings of the meshes of a train's set and of its stages by their names.

    `unrated`: those that cannot be rated, and why.
    """

    meshes: Mapping[str, MeshRating]
    stages: Mapping[str, Rating]
    unrated: Mapping[str, str]
    strength: TrainStrength

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices of values for planets that are to be verified, and of unknown ones.

        The warnings of each rating are in the rating itself.
        """
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

    def to_dict(self) -> JsonObject:
        """Return a dictionary for JSON: nominal ratings by the names of meshes and stages.

        The full rating of each is its "rate".
        """
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
    """Return the inertias (kg·m²) that count in one mesh, or the reason why they are not known (recalled of ISO 6336-1).

    All of the planet counts, the N-th part of a central; a held central counts as infinite.
    """
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
    """Return K_v at the load's speed and an empty text, or None and the reason."""
    if isinstance(inertias, str):
        return None, inertias
    try:
        return float(DynamicFactor.of(pair, material, load, inertias, options).values(load.speed)), ""
    except InputError as error:
        return None, str(error)
