"""A planetary train: `[planetary]` with the gears of its set, and pairs before and behind it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any, ClassVar, Self

from gearcad.check.options import CheckOptions
from gearcad.designs.design import Described, DesignKind, require_plain_name
from gearcad.designs.drawings import drawings_of
from gearcad.designs.files import Where
from gearcad.designs.keys import BESIDE, SPEEDS
from gearcad.designs.kinds.pair import PairSpec
from gearcad.designs.kinds.toothed import ToothedDesign
from gearcad.designs.materials import common_material, materials_of
from gearcad.designs.planetary_spec import PlanetarySpec
from gearcad.designs.planetary_tables import MAIN
from gearcad.dynamics.options import DynamicsOptions
from gearcad.errors import InputError, ParameterError
from gearcad.geometry import Gear
from gearcad.material import Material
from gearcad.meshing.options import MeshOptions
from gearcad.notice import Notice
from gearcad.per_gear import Role
from gearcad.planetary import Carrier, PairStage, PlanetaryTrain, TrainLoad
from gearcad.planetary.materials import TrainMaterial
from gearcad.planetary.speeds import check_speeds
from gearcad.rating.options import RatingOptions

__all__ = ["PlanetaryDesign"]

_OF_TRAINS = {each.name for each in fields(PlanetaryTrain)}
_REQUIRED = ("planets", "input", "output")

_TAKEN = ("kind", "name", "gearcad", "materials", "drawings", "assumed", SPEEDS, MAIN, *BESIDE)
"""What a document has beside its gears."""


@dataclass(frozen=True, kw_only=True)
class PlanetaryDesign(ToothedDesign):
    """A planetary train, and what later stages need.

    `speeds` (rpm) are those of members that are given beside the speed of the input: a differential needs one.
    """

    kind: ClassVar[DesignKind] = DesignKind.PLANETARY

    train: PlanetaryTrain
    load: TrainLoad | None = None
    speeds: Mapping[str, float] = field(default_factory=dict)
    material: TrainMaterial | None = None
    check: CheckOptions | None = None
    mesh: MeshOptions | None = None
    dynamics: DynamicsOptions | None = None
    rating: RatingOptions | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        names = [*self.train.members, *(rim.name for rim in self.train.rims)]
        names += [gear.name for stage in self.train.stages for gear in stage.pair.gears]
        for name in names:
            require_plain_name(name)
            if name in _TAKEN:
                raise ParameterError("name", name, "must be another word: documents have a table of this name")
            if names.count(name) > 1:
                raise ParameterError("name", name, "must be given once: every gear and the carrier have names of their own")
        pairs = [*(mesh.name for mesh in self.train.meshes), *(stage.name for stage in self.train.stages)]
        for name in pairs:
            require_plain_name(self.pair_name(name))
            if pairs.count(name) > 1:
                raise ParameterError("name", name, "must be given once: every mesh and stage has a spec of its own")

    @classmethod
    def read(cls, tables: Mapping[str, Any], where: Where, default_name: str) -> Self:
        """That of [planetary] and the tables of its gears. Raises SpecError."""
        spec = cls.spec(tables, where)
        given = {table: kind for table, kind in {**BESIDE, "load": TrainLoad}.items() if table != "material"}
        beside: dict[str, Any] = {table: spec.simple(table, kind) for table, kind in given.items() if table in tables}
        beside["drawings"] = {spec.name_of(table): own for table, own in drawings_of(spec).items()}
        name = spec.name(MAIN, default_name)
        inputs = _inputs(spec) | {"name": name}
        with spec.blame(MAIN):
            train = PlanetaryTrain(**inputs)
            beside["material"] = _material(spec, train, given="material" in tables)
            return cls(name=name, train=train, speeds=_speeds(spec, train, beside.get("load")), **beside)

    @classmethod
    def spec(cls, tables: Mapping[str, Any], where: Where) -> PlanetarySpec:
        """The values of a spec, whichever way the set is written. Raises SpecError."""
        return PlanetarySpec.of(tables, where)

    @property
    def gears(self) -> dict[str, Gear]:
        """Those of the train."""
        return self.train.gears

    @property
    def described(self) -> Mapping[str, Described]:
        """The gears, and the train that they make."""
        return {**self.gears, MAIN: self.train}

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Those of the gears, the train and the load."""
        return (*super().notices, *(self.load.notices if self.load is not None else ()))

    def pair_name(self, name: str) -> str:
        """What the design of a mesh or stage is called."""
        return f"{self.name}-{name}"

    def require_kind(self, *kinds: DesignKind, why: str) -> None:
        """Raise ParameterError unless it is of one of these kinds: jobs of pairs take the specs of its meshes."""
        specs = " and ".join(f"{mesh.name}.toml" for mesh in self.train.meshes)
        super().require_kind(*kinds, why=f"`gearcad planetary` writes the specs of its meshes for that, {specs}")

    def loaded(self, why: str) -> TrainLoad:
        """Its load. Raises ParameterError where there is none, that ends with why it is needed."""
        if self.load is None:
            permitted = f"must be given, in N·m on {self.train.output}, or load.input_torque, on {self.train.input}: {why}"
            raise ParameterError("load.output_torque", None, permitted)
        return self.load

    def to_dict(self) -> dict[str, Any]:
        """The document of `data.json`: gears under their names, the train under "planetary" (mm, degrees)."""
        return super().to_dict() | ({SPEEDS: dict(self.speeds)} if self.speeds else {})


def _material(spec: PlanetarySpec, train: PlanetaryTrain, *, given: bool) -> TrainMaterial | None:
    """That of all gears, or of each by its name; None where the spec says nothing. Raises SpecError."""
    found = materials_of(spec, spec.tables)
    if not isinstance(found, dict):
        return Material() if found is None and given else found
    common = common_material(spec, spec.tables)
    return {**dict.fromkeys(train.gears, common), **{spec.name_of(table): material for table, material in found.items()}}


def _inputs(spec: PlanetarySpec) -> dict[str, Any]:
    """Keyword arguments of the train. Raises SpecError."""
    centrals, rims, distance = spec.members()
    carrier = _carrier(spec)
    stages = [_stage(spec, f"{MAIN}.pre_stage", carrier.name)] if spec.fields_of(f"{MAIN}.pre_stage") else []
    stages += [_stage(spec, stage, "") for stage in spec.stages]
    given = {key: value for key, value in spec.fields_of(MAIN).items() if key in _OF_TRAINS}
    parts = {"centrals": centrals, "rims": rims, "carrier": carrier, "stages": tuple(stages)}
    return dict.fromkeys(_REQUIRED) | given | parts | ({} if distance is None else {"centre_distance": distance})


def _carrier(spec: PlanetarySpec) -> Carrier:
    with spec.blame(MAIN):
        given = spec.fields_of(f"{MAIN}.carrier")
        try:
            return Carrier(**given)
        except InputError as error:
            field = error.parameter.removeprefix(f"{given.get('name', Carrier.name)}.")
            raise type(error)(f"carrier.{field}", error.value, error.permitted, error.unit) from error


def _stage(spec: PlanetarySpec, owner: str, wheel_on: str) -> PairStage:
    """The pair of a table; of a pre-stage the wheel is on the carrier, unless it says otherwise."""
    given = {key: spec.values[f"{owner}.{key}"] for key in spec.fields_of(owner)}
    name = spec.stage_name(owner)
    of_stage = {key: given[key].value for key in ("angle", "axial_position") if key in given}
    on = {role: given[f"{role.value}.on"].value for role in Role if f"{role.value}.on" in given}
    of_pair = {
        key if key.partition(".")[0] in (role.value for role in Role) else f"pair.{key}": value
        for key, value in given.items()
        if key not in ("name", *of_stage, *(f"{role.value}.on" for role in Role))
    }
    names = {"pair": owner} | {role.value: f"{owner}.{role.value}" for role in Role}
    pair = PairSpec(of_pair, spec.where, names).pair(name)
    shafts = {role.value: on.get(role, gear.name) for role, gear in pair.gears.items()}
    if wheel_on and not on:
        shafts[Role.WHEEL.value] = wheel_on
    with spec.blame(owner):
        try:
            return PairStage(name=name, pair=pair, **shafts, **of_stage)
        except InputError as error:
            field = error.parameter.removeprefix(f"{name}.")
            raise type(error)(field, error.value, error.permitted, error.unit) from error


def _speeds(spec: PlanetarySpec, train: PlanetaryTrain, load: TrainLoad | None) -> dict[str, float]:
    """What is given of the speeds of members. Raises ParameterError where one contradicts the others, or that of the load."""
    given = spec.fields_of(f"{MAIN}.{SPEEDS}")
    of_load = {} if load is None or not load.speed else {train.input: load.speed}
    if of_load and train.input in given:
        permitted = f"must not be given too: load.speed is that of {train.input}"
        raise ParameterError(f"{SPEEDS}.{train.input}", given[train.input], permitted, "rpm")
    check_speeds(train, of_load | given)
    return given
