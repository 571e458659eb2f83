"""Designs of planetary trains: `[planetary]` with the gears of its set, and pairs before and behind it.

What the gears of the set share may stand in `[planetary]`; a gear's own value wins, and what two gears of a mesh have in
common, module and helix, may stand on either. A shared module that no gear is left with is refused. The hand follows: opposed
at a sun, the same in a ring.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import Any, ClassVar, Self, TypeVar

from gearcad.check.options import CheckOptions
from gearcad.core.errors import GeometryError, InputError, ParameterError, SpecError, format_number
from gearcad.core.quantities import schema_of
from gearcad.core.records import JsonObject, Notice, Role
from gearcad.designs.design import Described, Where, require_plain_name
from gearcad.designs.gear_designs import ToothedDesign
from gearcad.designs.keys import BESIDE, OF_SETS, SHARED, SPEEDS, DesignKind
from gearcad.designs.pair_designs import PairSpec
from gearcad.designs.planetary_gears import MAIN, TableMesh, TrainGears, place_tables
from gearcad.designs.spec import AUTO, CLEAR, Spec, common_material, drawings_of, materials_of
from gearcad.dynamics.options import DynamicsOptions
from gearcad.geometry import Gear
from gearcad.geometry.gear_parts import MODULE_OR_PITCH
from gearcad.material import Material
from gearcad.meshing.options import MeshOptions
from gearcad.planetary import Carrier, Central, PairStage, PlanetaryTrain, Rim, TrainLoad
from gearcad.planetary.members import TrainMaterial
from gearcad.planetary.train_data import check_speeds
from gearcad.rating.options import RatingOptions

_OPPOSED = ("helix_angle", "double_helix.offset")
"""Fields of a gear that its mate has with the opposite sign, and a ring with the same."""

Part = TypeVar("Part", Central, Rim)


@dataclass(frozen=True)
class PlanetarySpec(Spec):
    """The values of a planetary train, and how to make its gears of them."""

    main: ClassVar[str] = MAIN

    meshes: Mapping[str, str] = field(default_factory=dict)
    stages: tuple[str, ...] = ()

    @classmethod
    def of(cls, tables: Mapping[str, Any], where: Where) -> Self:
        """Return every value under its key, whichever way the tables were written. Raises SpecError."""
        placed = place_tables(tables, where)
        return cls(placed.values, where, placed.names, placed.meshes, tuple(placed.stages))

    # ------------------------------------------------------------------ words of errors

    def _place(self, parameter: str, owner: str) -> tuple[str, str]:
        """An error is about a gear by its table, or by its name."""
        tables = {table: table for table in OF_SETS} | {self.name_of(table): table for table in self.tables}
        head, _, rest = parameter.partition(".")
        if rest and head in tables:
            return tables[head], rest
        for stage in (f"{MAIN}.pre_stage", *self.stages):
            if head == self.stage_name(stage) and f"{stage}.{rest}.on" in self.values:
                return stage, f"{rest}.on"
        return owner, parameter

    def _explained(self, error: InputError, owner: str) -> SpecError:
        """A name at fault is that of a part, if one has it."""
        if error.parameter == "name" and owner == MAIN:
            named = [key for key, given in self.values.items() if _is_name(key) and given.value == error.value]
            owner = next((key.removesuffix(".name") for key in reversed(named) if key != f"{MAIN}.name"), owner)
        return super()._explained(error, owner)

    def _words(self, owner: str) -> tuple[str, ...]:
        if owner not in OF_SETS:
            return ()
        return (AUTO, CLEAR) if owner.startswith("ring") else (AUTO,)

    def _shares(self, owner: str) -> bool:
        return owner in OF_SETS

    # ------------------------------------------------------------------ what there is

    @property
    def tables(self) -> tuple[str, ...]:
        """Tables of the gears of the set, each once."""
        return tuple(dict.fromkeys((*self.meshes, *self.meshes.values())))

    def name_of(self, table: str) -> str:
        """Return the name of the gear that a table describes: the user's name, otherwise that of the table."""
        given = self.values.get(f"{table}.name")
        return table if given is None else str(given.value)

    def stage_name(self, stage: str) -> str:
        """Return the name of a stage, given the beginning of its keys: the user's name, otherwise `stage_1` or the key."""
        given = self.values.get(f"{stage}.name")
        if given is not None:
            return str(given.value)
        return f"stage_{self.stages.index(stage) + 1}" if stage in self.stages else stage.removeprefix(f"{MAIN}.")

    @property
    def _meshes(self) -> tuple[TableMesh, ...]:
        return tuple(TableMesh(central, rim, central.startswith("ring")) for central, rim in self.meshes.items())

    # ------------------------------------------------------------------ gears

    def members(self) -> tuple[tuple[Central, ...], tuple[Rim, ...], float | None]:
        """Return the centrals and rims with every "auto" resolved, and their centre distance (mm) where more than shifts fix
        it.

        Raises SpecError.
        """
        self._check_names()
        self._share_values()
        inputs = {table: self._gear_of(table) for table in self.tables}
        self._check_teeth(inputs)
        with self.blame(MAIN):
            gears, distance = TrainGears(self, self._meshes).made(inputs)
        centrals = tuple(
            self._part(Central, table, gears[table], meshes=self.name_of(self.meshes[table])) for table in self.meshes
        )
        rims = tuple(self._part(Rim, table, gears[table]) for table in dict.fromkeys(self.meshes.values()))
        return centrals, rims, distance

    def _check_names(self) -> None:
        """Each can name a file, so that messages about them stay one line."""
        for key, given in self.values.items():
            if _is_name(key) and key != f"{MAIN}.name":
                with self.blame(key.removesuffix(".name")):
                    require_plain_name(given.value)

    def _gear_of(self, table: str) -> dict[str, Any]:
        """Keyword arguments of a gear as they are written, named as its table unless it has a name."""
        known = schema_of(Gear)
        with self.blame(table):
            inputs = {key: value for key, value in self.gear_inputs(table).items() if key in known}
            return {"name": table} | inputs

    def _part(self, kind: type[Part], table: str, gear: Gear, **others: str) -> Part:
        """Return a central or a rim with what its table has beside the teeth."""
        known = {each.name for each in fields(kind)}
        given = {key: value for key, value in self.fields_of(table).items() if key in known}
        with self.blame(table):
            try:
                return kind(**{"name": table} | given | {"gear": gear} | others)
            except InputError as error:  # led by the name, which may be that of another table
                error.parameter = error.parameter.removeprefix(f"{given.get('name', table)}.")
                raise

    def _share_values(self) -> None:
        """Give the gears what stands in [planetary] or on a mate, unless they have their own."""
        sizes = [f"{table}.{name}" for table in self.tables for name in MODULE_OR_PITCH]
        own = [key for key in sizes if key in self.values]
        for name in MODULE_OR_PITCH:
            self._spread(name)
        self._check_size_is_used(own)
        for name in _OPPOSED:
            self._spread_helix(name)
        for table in self.tables:
            renamed = f"{table}.rack" in self.values
            giving_way = self.giving_way(table)
            for key in SHARED:
                given = self.values.get(f"{MAIN}.{key}")
                if given is None or key in _OPPOSED or key in giving_way:
                    continue
                if not (renamed and key.startswith("rack")):
                    self.values.setdefault(f"{table}.{key}", given)

    def _check_size_is_used(self, own: Sequence[str]) -> None:
        """Raise SpecError for a shared module that no gear has, as every mesh takes that of its gear's `own` keys."""
        for name in MODULE_OR_PITCH:
            given = self.values.get(f"{MAIN}.{name}")
            if given is None or not all(
                any(f"{table}.{each}" in self.values for each in MODULE_OR_PITCH) for table in self.tables
            ):
                continue
            if all(self.values[key].value != given.value for key in own if key.endswith(name)):
                said = " and ".join(f"{self.values[key].key} = {format_number(self.values[key].value)}" for key in own)
                permitted = f"is no gear's: {said} counts before it, for mates too; leave one out, or make them agree"
                with self.blame(MAIN):
                    raise GeometryError(name, given.value, permitted, "mm" if name == "normal_module" else "1/inch")

    def _spread(self, key: str) -> None:
        """Let gears have what their mates have, from mesh to mesh: what two in mesh must share, with the sign it has."""
        alike = MODULE_OR_PITCH if key in MODULE_OR_PITCH else (key,)
        for mesh in (*self._meshes, *self._meshes):
            for own, mate in ((mesh.rim, mesh.central), (mesh.central, mesh.rim)):
                given = self.values.get(f"{mate}.{key}")
                if given is None or any(f"{own}.{each}" in self.values for each in alike):
                    continue
                turned = key in _OPPOSED and not mesh.ring and isinstance(given.value, float)
                self.values[f"{own}.{key}"] = given._replace(value=0.0 - given.value) if turned else given

    def _spread_helix(self, key: str) -> None:
        """Give the first central the helix value that stands in [planetary].

        Raises GeometryError for a value other than 0 if the second mesh of a stepped planet does not give its own.
        """
        first, second = self._meshes
        given = self.values.get(f"{MAIN}.{key}")
        if given is not None:
            self.values.setdefault(f"{first.central}.{key}", given)
        self._spread(key)
        if given is not None and given.value and f"{second.rim}.{key}" not in self.values:
            written = self._written(second.rim, key)
            permitted = f"is of {self.name_of(first.central)} and its mate only: give {written} too, 0 for spur teeth"
            with self.blame(MAIN):
                raise GeometryError(key, given.value, permitted, "deg" if key == "helix_angle" else "")

    def _check_teeth(self, inputs: Mapping[str, dict[str, Any]]) -> None:
        """The numbers of teeth by themselves, and the words for tips."""
        count = schema_of(Gear)["teeth"].permitted
        for table, gear in inputs.items():
            with self.blame(table):
                if count is not None:
                    count.require("teeth", gear["teeth"])
                if (gear["teeth"] < 0) is not table.startswith("ring"):
                    permitted = (
                        "must be negative, as a ring's (ISO 21771)" if gear["teeth"] > 0 else "must be above 0, for outer teeth"
                    )
                    raise GeometryError("teeth", gear["teeth"], f"{permitted}: write {-gear['teeth']}")
                if gear.get("tip_alteration") == CLEAR and not table.startswith("ring"):
                    raise GeometryError("tip_alteration", CLEAR, f'must be a number, or "{AUTO}": "{CLEAR}" is for rings')


def _is_name(key: str) -> bool:
    """Return whether a key names a part of the train rather than one of its inputs."""
    return key.endswith(".name") and not key.endswith("material.name")


_OF_TRAINS = {each.name for each in fields(PlanetaryTrain)}
_REQUIRED = ("planets", "input", "output")

_RESERVED_KEYS = ("kind", "name", "gearcad", "materials", "drawings", "assumed", SPEEDS, MAIN, *BESIDE)
"""Keys of a document beside its gears."""


@dataclass(frozen=True, kw_only=True)
class PlanetaryDesign(ToothedDesign):
    """A planetary train, with the inputs that later stages need.

    `speeds` (rpm) are those of members that are given in addition to the speed of the input: a differential needs one.
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
            if name in _RESERVED_KEYS:
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
        """Return the design that [planetary] and the tables of its gears describe. Raises SpecError."""
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
        """Return the values of a spec, whichever way the set is written. Raises SpecError."""
        return PlanetarySpec.of(tables, where)

    @property
    def gears(self) -> dict[str, Gear]:
        """Gears of the train by name."""
        return self.train.gears

    @property
    def described(self) -> Mapping[str, Described]:
        """The gears, and the train that they make."""
        return {**self.gears, MAIN: self.train}

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices of the gears, the train and the load."""
        return (*super().notices, *(self.load.notices if self.load is not None else ()))

    def pair_name(self, name: str) -> str:
        """Return the design name of the pair of a mesh or stage: `DESIGN-NAME`."""
        return f"{self.name}-{name}"

    def require_kind(self, *kinds: DesignKind, why: str) -> None:
        """Raise ParameterError unless it is of one of these kinds: jobs of pairs take the specs of its meshes."""
        specs = " and ".join(f"{mesh.name}.toml" for mesh in self.train.meshes)
        super().require_kind(*kinds, why=f"`gearcad planetary` writes the specs of its meshes for that, {specs}")

    def loaded(self, why: str) -> TrainLoad:
        """Return the load. Raises ParameterError if there is none; the message ends with `why` it is needed."""
        if self.load is None:
            permitted = f"must be given, in N·m on {self.train.output}, or load.input_torque, on {self.train.input}: {why}"
            raise ParameterError("load.output_torque", None, permitted)
        return self.load

    def to_dict(self) -> JsonObject:
        """Return the document of `data.json`: gears under their names, the train under "planetary" (mm, degrees)."""
        return super().to_dict() | ({SPEEDS: dict(self.speeds)} if self.speeds else {})


def _material(spec: PlanetarySpec, train: PlanetaryTrain, *, given: bool) -> TrainMaterial | None:
    """Return the material of all gears, or one for each gear by name, or None if the spec gives none. Raises SpecError."""
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


_OF_STAGE = ("angle", "axial_position", "pinion_inertia", "wheel_inertia")
"""Keys of a stage beside those of its pair."""


def _stage(spec: PlanetarySpec, owner: str, wheel_on: str) -> PairStage:
    """Return the pair of a table; of a pre-stage the wheel is on the carrier, unless it says otherwise."""
    given = {key: spec.values[f"{owner}.{key}"] for key in spec.fields_of(owner)}
    name = spec.stage_name(owner)
    of_stage = {key: given[key].value for key in _OF_STAGE if key in given}
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
    """Return the given speeds of members (rpm) by name.

    Raises ParameterError if one contradicts another or the speed of the load.
    """
    given = spec.fields_of(f"{MAIN}.{SPEEDS}")
    of_load = {} if load is None or not load.speed else {train.input: load.speed}
    if of_load and train.input in given:
        permitted = f"must not be given too: load.speed is that of {train.input}"
        raise ParameterError(f"{SPEEDS}.{train.input}", given[train.input], permitted, "rpm")
    check_speeds(train, of_load | given)
    return given
