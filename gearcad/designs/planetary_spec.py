"""The values of a planetary train's spec, and how its gears come to theirs.

What the gears of the set share may stand in `[planetary]`; a gear's own value wins, and what two gears of a mesh have in
common, module and helix, may stand on either. A shared module that no gear is left with is refused. The hand follows: opposed
at a sun, the same in a ring.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import Any, ClassVar, Self, TypeVar

from gearcad.designs.auto import AUTO, CLEAR
from gearcad.designs.design import require_plain_name
from gearcad.designs.files import Where
from gearcad.designs.keys import OF_SETS, SHARED
from gearcad.designs.planetary_gears import TableMesh, TrainGears
from gearcad.designs.planetary_tables import MAIN, place_tables
from gearcad.designs.spec import Spec
from gearcad.errors import GeometryError, InputError, SpecError, format_number
from gearcad.geometry import Gear
from gearcad.geometry.diametral import MODULE_OR_PITCH
from gearcad.planetary import Central, Rim
from gearcad.schema import schema_of

__all__ = ["PlanetarySpec"]

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
        """Every value under its key, whichever way the tables were written. Raises SpecError."""
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
        """Those of the gears of the set, each once."""
        return tuple(dict.fromkeys((*self.meshes, *self.meshes.values())))

    def name_of(self, table: str) -> str:
        """What the user calls a gear."""
        given = self.values.get(f"{table}.name")
        return table if given is None else str(given.value)

    def stage_name(self, stage: str) -> str:
        """What the user calls a stage, by the beginning of its keys."""
        given = self.values.get(f"{stage}.name")
        if given is not None:
            return str(given.value)
        return f"stage_{self.stages.index(stage) + 1}" if stage in self.stages else stage.removeprefix(f"{MAIN}.")

    @property
    def _meshes(self) -> tuple[TableMesh, ...]:
        return tuple(TableMesh(central, rim, central.startswith("ring")) for central, rim in self.meshes.items())

    # ------------------------------------------------------------------ gears

    def members(self) -> tuple[tuple[Central, ...], tuple[Rim, ...], float | None]:
        """The centrals and rims with every "auto" resolved, and their centre distance (mm) where more than shifts fix it.

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
        """A central or a rim with what its table has beside the teeth."""
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
        """What stands in [planetary] is the first central's; a stepped planet's second mesh has to say its own."""
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
    """Whether a key names a part of the train, and not what it is made of."""
    return key.endswith(".name") and not key.endswith("material.name")
