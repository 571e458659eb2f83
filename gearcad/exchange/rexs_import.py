"""Import of REXS: a spec for each cylindrical stage, or for each gear of a file without stages; the rest is told."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gearcad.core.errors import SpecError, shown
from gearcad.core.quantities import schema_of
from gearcad.core.records import Role
from gearcad.designs.design import Design, tables_of_text
from gearcad.designs.keys import BESIDE, FIELDS, SHAFTS
from gearcad.designs.reader import design_from_tables
from gearcad.designs.spec import AUTO
from gearcad.designs.spec_writers import SpecTables, toml_text
from gearcad.designs.train_designs import plain_name
from gearcad.designs.train_meshes import free_name
from gearcad.drawing.options import PartDrawing
from gearcad.exchange.rexs_attributes import NOT_GIVEN, OF_LUBRICANT, OF_MATERIAL
from gearcad.exchange.rexs_gears import DIAMETERS, GEARS, RexsGear, values_of
from gearcad.exchange.rexs_model import RexsComponent, RexsModel, read_model
from gearcad.exchange.rexs_power import ModelPower
from gearcad.exchange.rexs_shafts import coupling_position, position_on_segments, shaft_lists
from gearcad.geometry import GearPair
from gearcad.material import Material
from gearcad.shafts.arrangement import ShaftOptions

_MOST_SPECS = 200
_SAME = 1e-6
"""Difference (mm) of a diameter in a file from that of a gear which is rounding."""


@dataclass(frozen=True)
class ImportedSpec:
    """A spec of a file: its name, its text, the design that it makes, and lines about what was left out or assumed."""

    name: str
    text: str
    design: Design
    told: tuple[str, ...]


@dataclass(frozen=True)
class RexsImport:
    """Content of a REXS file as specs, and lines about the parts that no spec has."""

    file: str
    version: str
    application: str
    specs: tuple[ImportedSpec, ...]
    told: tuple[str, ...]


def import_rexs(path: Path | str) -> RexsImport:
    """Return the specs of a file of REXS. Raises SpecError, one line that names the file, the component and what is wrong."""
    model = read_model(path)
    stages = model.of_kind("cylindrical_stage")
    if (count := len(stages or model.of_kind(*GEARS))) > _MOST_SPECS:
        raise SpecError(f"{model.file}: has {count} stages or gears: at most {_MOST_SPECS} are read")
    specs: list[ImportedSpec] = []
    flow = ModelPower(model)
    told = list(_left_out(model))
    for stage in stages:
        specs.append(_StageSpec(model, stage, flow).spec([each.name for each in specs]))
    if not stages:
        for gear in model.of_kind(*GEARS):
            specs.append(_single(model, gear, [each.name for each in specs]))
    if not specs:
        raise SpecError(f"{model.file}: has no cylindrical gears, and gearcad has no others")
    return RexsImport(model.file, model.version, model.application, tuple(specs), (*told, *flow.told))


_ELSEWHERE = {
    "bevel_stage": "bevel stages",
    "worm_stage": "worm stages",
    "planetary_stage": "planetary stages: their meshes are written, each as a pair",
    "involute_spline_connection": "splined connections",
    "coupling": "couplings between shafts",
    "switchable_coupling": "switched couplings",
    "assembly_group": "assembly groups of other programs",
}
"""Types of components that no spec of a pair has, and their words."""


def _left_out(model: RexsModel) -> Iterator[str]:
    for kind, words in _ELSEWHERE.items():
        if count := len(model.of_kind(kind)):
            yield f"{count} of {kind}: left out ({words})"
    if model.load_cases > 1:
        yield f"load cases: the first of {model.load_cases} is taken"


def _single(model: RexsModel, gear: RexsComponent, taken: Sequence[str]) -> ImportedSpec:
    """Return the spec of a gear by itself."""
    told: list[str] = []
    reader = RexsGear(model, gear, told)
    keys = reader.keys()
    name = _name_of(model, gear.name or "gear", taken)
    if not _is_own(model):
        keys.pop("name", None)
    if keys.get("profile_shift", 0.0) == AUTO:
        keys["profile_shift"] = 0.0
        told.append("profile_shift is not in the file: 0 is taken")
    tables: SpecTables = {"gear": {**keys, "name": name}}
    if (material := _material_of(model, gear)) is not None:
        tables["material"] = _material_keys(material)
    tables |= _kept_tables(model, ())
    return _checked(model, name, tables, {"gear": reader.informed}, told)


def _name_of(model: RexsModel, called: str, taken: Sequence[str]) -> str:
    """Return a name that no other spec of the file has; those of other programs lose their spaces."""
    return free_name(plain_name(called if _is_own(model) else "-".join(called.split())), {each.casefold() for each in taken})


def _is_own(model: RexsModel) -> bool:
    return model.application == "gearcad"


def _checked(
    model: RexsModel, name: str, tables: SpecTables, informed: Mapping[str, Mapping[str, float]], told: list[str]
) -> ImportedSpec:
    """Return the spec of tables that a design can be read from: diameters and shafts that make none are left out."""
    comments = [f"{name}, from {model.file} (REXS {shown(model.version, 8)} of {shown(model.application or 'unknown', 40)})"]
    while True:
        text = toml_text(tables, [*comments, *told])
        try:
            read, where = tables_of_text(text, model.file, Path())
            design = design_from_tables(read, where=where, default_name=name)
        except SpecError as error:
            if _dropped(tables, [*informed], error, told, own=_is_own(model)):
                continue
            raise SpecError(f"{model.file}: {name}: {str(error).partition(': ')[2] or error}", error.key) from error
        if _settled(design, tables, informed, told):
            return ImportedSpec(name, toml_text(tables, [*comments, *told]), design, tuple(told))


def _dropped(tables: SpecTables, gears: Sequence[str], error: SpecError, told: list[str], *, own: bool) -> bool:
    """Leave out what a spec cannot hold of a foreign file, and return whether there was such a thing."""
    reason = str(error).partition(": ")[2]
    if any(key in error.key for key in (".shaft", ".bearing", ".force", "mesh_position", SHAFTS)) and _without_shafts(tables):
        told.append(f"shafts are left out: {reason}")
        return True
    if own:
        return False
    for gear in gears:
        keys = tables[gear]
        assert isinstance(keys, dict)
        for key in DIAMETERS:
            if error.key == f"{gear}.{key}" and isinstance(keys.get(key), float):
                told.append(f"{error.key} = {keys.pop(key):g} mm is left out: {reason}")
                return True
    return False


def _without_shafts(tables: SpecTables) -> bool:
    """Take the shafts out of the tables of a pair, and return whether there were any."""
    had = False
    for name in [*tables]:
        if name == SHAFTS or isinstance(tables[name], list):
            del tables[name]
            had = True
    for role in Role:
        keys = tables.get(role.value)
        if isinstance(keys, dict):
            for key in ("mesh_position", "coupling"):
                keys.pop(key, None)
    return had


def _settled(design: Design, tables: SpecTables, informed: Mapping[str, Mapping[str, float]], told: list[str]) -> bool:
    """Take over the diameters of a file that gearcad's own keys do not give, and return whether there were none.

    Another program may have changed them in a file of gearcad.
    """
    settled = True
    for name, sizes in informed.items():
        keys = tables[name]
        assert isinstance(keys, dict)
        for key, size in sizes.items():
            made = float(getattr(design.gears[name], key))
            if abs(made - size) > _SAME and key not in keys:
                where = f"{name}.{key}"
                told.append(f"{where} = {size:g} mm is that of the file; the other keys would give {made:.6g} mm")
                keys[key], settled = size, False
    return settled


def _material_of(model: RexsModel, *owners: RexsComponent) -> RexsComponent | None:
    """Return the material to which the first owner refers that refers to one."""
    known = (each for each in owners if "material" not in each.list_of(NOT_GIVEN))
    return next((part for each in known for part in model.referenced(each.number, "material")), None)


def _material_keys(material: RexsComponent) -> dict[str, Any]:
    keys: dict[str, Any] = {"name": material.text("material_designation") or material.name or "material"}
    keys |= values_of(material, OF_MATERIAL)
    for kind in ("vickers", "brinell"):
        if (hardness := material.float_of(f"surface_hardness_{kind}")) is not None:
            keys.setdefault("hardness", hardness)
    for key in material.list_of(NOT_GIVEN):
        keys.pop(key, None)
    return keys | material.custom(schema_of(Material))


def _kept_tables(model: RexsModel, gears: Sequence[str]) -> dict[str, dict[str, Any]]:
    """Return the tables that gearcad keeps on the gear unit, and the life there."""
    tables: dict[str, dict[str, Any]] = {}
    units = model.of_kind("gear_unit")
    if not units or not _is_own(model):
        return tables
    fields = {table: [*FIELDS[table]] for table in BESIDE if table != "material"}
    fields[SHAFTS] = [*schema_of(ShaftOptions)]
    fields |= {f"{gear}.drawing": [*schema_of(PartDrawing)] for gear in gears}
    for table, keys in fields.items():
        found = units[0].custom([f"{table}.{key}" for key in keys])
        if found:
            tables[table] = {key.removeprefix(f"{table}."): value for key, value in found.items()}
    return tables


class _StageSpec:
    """The spec of a cylindrical stage."""

    def __init__(self, model: RexsModel, stage: RexsComponent, flow: ModelPower) -> None:
        self.model, self.stage, self.flow, self.told = model, stage, flow, list[str]()

    def spec(self, taken: Sequence[str]) -> ImportedSpec:
        """Return the spec, under a name that none of those taken has."""
        gears = self._gears()
        name, own = _name_of(self.model, self.stage.name or "pair", taken), _is_own(self.model)
        pair: dict[str, Any] = {"name": name}
        tables: SpecTables = {"pair": pair}
        informed = {}
        for role, gear in gears.items():
            reader = RexsGear(self.model, gear, self.told)
            keys = reader.keys()
            if not own:
                keys.pop("name", None)
            tables[role.value], informed[role.value] = keys, reader.informed
        self._distance(pair, gears)
        self._shifts(tables)
        self._materials(tables, gears)
        self._load(tables, gears)
        self._rating(tables)
        for table, kept in _kept_tables(self.model, [role.value for role in gears]).items():
            there = tables.get(table, {})
            assert isinstance(there, dict)
            tables[table] = {**there, **kept}
        self._shafts(tables, gears)
        return _checked(self.model, name, tables, informed, self.told)

    def _gears(self) -> dict[Role, RexsComponent]:
        """Return pinion and wheel; a ring is the wheel."""
        for relation in self.model.related("stage", "stage", self.stage.number):
            numbers = [relation.roles.get(name) for name in ("gear_1", "gear_2")]
            both = [self.model.components[each] for each in numbers if each is not None]
            if len(both) == 2 and all(each.kind in GEARS for each in both):
                if both[0].kind == "ring_gear":
                    both.reverse()
                return dict(zip(Role, both, strict=True))
        self.stage.fault("gears", " are missing: a relation stage must name gear_1 and gear_2")

    def _distance(self, keys: dict[str, Any], gears: Mapping[Role, RexsComponent]) -> None:
        if "centre_distance" not in self.stage.list_of(NOT_GIVEN):
            distance = self.stage.float_of("center_distance")
            if distance is not None:
                keys["centre_distance"] = -abs(distance) if gears[Role.WHEEL].kind == "ring_gear" else abs(distance)
        keys |= self.stage.custom(schema_of(GearPair))

    def _shifts(self, tables: SpecTables) -> None:
        """Say which profile shifts follow from the centre distance; without one they are 0."""
        for role in Role:
            keys = tables[role.value]
            if isinstance(keys, dict) and keys.get("profile_shift") == AUTO:
                where = f"{role.value}.profile_shift"
                if "centre_distance" in tables["pair"]:
                    self.told.append(f"{where} is not in the file: it follows from the centre distance")
                else:
                    keys["profile_shift"] = 0.0
                    self.told.append(f"{where} is not in the file: 0 is taken")

    def _materials(self, tables: SpecTables, gears: Mapping[Role, RexsComponent]) -> None:
        found = {role: _material_of(self.model, gear, *self._shaft_of(gear)) for role, gear in gears.items()}
        pinion, wheel = found[Role.PINION], found[Role.WHEEL]
        if pinion is not None and pinion is wheel:
            tables["material"] = _material_keys(pinion)
            return
        for role, material in found.items():
            if material is not None:
                tables[f"{role.value}.material"] = _material_keys(material)

    def _shaft_of(self, gear: RexsComponent) -> list[RexsComponent]:
        """Return the shaft that a gear is on."""
        numbers = [
            each.roles["assembly"] for each in self.model.related("assembly", "part", gear.number) if "assembly" in each.roles
        ]
        return [self.model.components[each] for each in numbers if self.model.components[each].kind == "shaft"][:1]

    def _load(self, tables: SpecTables, gears: Mapping[Role, RexsComponent]) -> None:
        torque, speed = self.flow.of_stage(self.stage.number, gears[Role.PINION].number)
        if torque is None:
            return
        load: dict[str, Any] = {"torque": torque}
        if speed:
            load["speed"] = speed
        factor = self.stage.float_of("application_factor_iso_6336_2006")
        if factor is not None:
            load["application_factor"] = factor
        tables["load"] = load

    def _rating(self, tables: SpecTables) -> None:
        casings, units = self.model.of_kind("gear_casing"), self.model.of_kind("gear_unit")
        keys: dict[str, Any] = {}
        for owner in (self.stage, *casings):
            for oil in self.model.referenced(owner.number, "lubricant"):
                keys = {**values_of(oil, OF_LUBRICANT), **keys}
            temperature = owner.float_of("temperature_lubricant")
            if temperature is not None:
                keys.setdefault("oil_temperature", temperature)
        life = units[0].float_of("operating_time") if units else None
        if life:
            keys["life"] = life
        if keys:
            tables["rating"] = keys

    def _shafts(self, tables: SpecTables, gears: Mapping[Role, RexsComponent]) -> None:
        """Add the shafts of both gears that have sections, with what holds them."""
        angle = self.stage.float_of("rotating_angle_around_neg_u_axis")
        any_shaft = False
        for role, gear in gears.items():
            for shaft in self._shaft_of(gear):
                others = [each for each in self.model.parts(shaft.number, *GEARS) if each is not gear]
                rows = shaft_lists(self.model, shaft, others, self.told)
                if not rows["shaft"]:
                    continue
                any_shaft = True
                keys = tables[role.value]
                assert isinstance(keys, dict)
                place = gear.needed("u_coordinate_on_shaft")
                keys["mesh_position"] = position_on_segments(self.model, shaft, place)
                coupling = coupling_position(self.model, shaft, others)
                keys["coupling"] = 0.0 if coupling is None else position_on_segments(self.model, shaft, coupling)
                for name, listed in rows.items():
                    if listed:
                        tables[f"{role.value}.{name}"] = listed
        if any_shaft and angle:
            options = tables.get(SHAFTS, {})
            assert isinstance(options, dict)
            tables[SHAFTS] = {**options, "mesh_angle": 0.0 - angle}
        if not any_shaft:
            tables.pop(SHAFTS, None)
