"""Specs and tables that gearcad writes: pairs of a train, results of searches, and a measured gear with its readings."""

from __future__ import annotations

import csv
import json
import math
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import MISSING, dataclass, fields, is_dataclass, replace
from enum import Enum
from functools import cached_property, reduce
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from gearcad.core.errors import InputError, ParameterError, SpecError, shown
from gearcad.core.output import staged_files
from gearcad.core.quantities import is_given, schema_of
from gearcad.core.records import PerGear, Role, is_assumed, is_usual
from gearcad.core.shelf_tables import Place
from gearcad.designs.cells import cell_text, write_found_rows
from gearcad.designs.design import LONGEST_NAME, Where, read_tables
from gearcad.designs.gear_designs import GearDesign
from gearcad.designs.keys import BESIDE, FIELDS, GEAR_FIELDS, SHAFTS, nearest_key, permitted_words
from gearcad.designs.pair_designs import PairDesign
from gearcad.designs.planetary_designs import PlanetaryDesign
from gearcad.designs.shaft_keys import SHAFT_LISTS
from gearcad.designs.shaft_spec import PairShafts
from gearcad.designs.spec import AUTO
from gearcad.designs.train_designs import plain_name
from gearcad.designs.train_meshes import free_name, mesh_design, under_load
from gearcad.drawing.options import PartDrawing
from gearcad.dynamics.engagement import PinionLoad
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.planetary.planetary_strength import ALTERNATING
from gearcad.dynamics.train_result import TrainStudy
from gearcad.dynamics.trains.train import EngagedMesh, Train
from gearcad.geometry import ISO53_A, Gear, GearPair
from gearcad.geometry.splined_bore import SplinedBore
from gearcad.geometry.tool_shelf import ToolName
from gearcad.geometry.tool_tables import PARTS as TOOL_PARTS
from gearcad.identify.candidates import Candidate as GearCandidate
from gearcad.identify.candidates import Identification
from gearcad.identify.measurements import Gauge, Measurements
from gearcad.load import Load
from gearcad.material import Grade, Material, Materials, grade_of
from gearcad.planetary.members import mesh_material, stage_material
from gearcad.planetary.power import FactorSource, MeshLoad, PowerFlow, mesh_loads, power_flow, stage_loads
from gearcad.planetary.search import PlanetarySet, SearchResult
from gearcad.shafts.arrangement import ShaftOptions

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

    from gearcad.sizing import SizedPair, SizeTask, Sizing
    from gearcad.sizing.planetary_sets import SizedSet, SizedSets


SpecTables = dict[str, dict[str, Any] | list[dict[str, Any]]]
"""Tables of a spec under their names, with flattened keys, and lists of tables."""

_ALWAYS = ("helix_angle", "profile_shift", "tip_alteration")
"""Fields of gears that are always written: without them a spec takes them from the mate, or as "auto"."""


def pair_text(design: PairDesign, comments: Sequence[str] = ()) -> str:
    """Return the TOML of a design of a pair, beginning with `comments`, a line each. Derived values replace "auto"."""
    return toml_text(pair_tables(design), comments)


def pair_tables(design: PairDesign) -> SpecTables:
    """Return the tables of a pair's spec with flattened keys, and its lists of tables. Derived values replace "auto"."""
    pair = design.pair
    tables: SpecTables = {
        "pair": dict(
            _pair_text_values(pair, ("name", "centre_distance", "centre_distance_tolerance", "axial_offset"), always=("name",))
        ),
        **{
            role.value: dict(_pair_text_values(gear, FIELDS[role.value], always=("name", *_ALWAYS)))
            for role, gear in pair.gears.items()
        },
        **_tables_beside(design, _materials(design)),
        **{f"{gear}.drawing": dict(_pair_text_values(own, schema_of(PartDrawing))) for gear, own in design.drawings.items()},
    }
    if design.shafts is None:
        return tables
    for role, mounted in design.shafts.mounted.items():
        tables[role.value] |= {"mesh_position": mounted.mesh_position, "coupling": mounted.shaft.coupling}  # type: ignore[operator]
    options = dict(_pair_text_values(design.shafts.options, schema_of(ShaftOptions)))
    return {**tables, **({SHAFTS: options} if options else {}), **_shaft_lists(design.shafts)}


def gear_tables(design: GearDesign) -> SpecTables:
    """Return the tables of a single gear's spec with flattened keys."""
    materials = {} if design.material is None else {"material": design.material}
    return {
        "gear": dict(_pair_text_values(design.gear, FIELDS["gear"], always=("name", *_ALWAYS))),
        **_tables_beside(design, materials),
    }


def _tables_beside(design: GearDesign | PairDesign, materials: Mapping[str, Material]) -> SpecTables:
    """Return the tables that stand beside those of the gears."""
    given = {table: getattr(design, table, None) for table in BESIDE if table != "material"}
    return {
        **{table: dict(_pair_text_values(material, schema_of(Material))) for table, material in materials.items()},
        **{table: dict(_pair_text_values(own, FIELDS[table])) for table, own in given.items() if own is not None},
    }


def _shaft_lists(shafts: PairShafts) -> dict[str, list[dict[str, Any]]]:
    """Return the lists of tables that describe shafts."""
    found = {}
    for role, mounted in shafts.mounted.items():
        shaft = mounted.shaft
        for (name, kind), parts in zip(SHAFT_LISTS.items(), (shaft.segments, shaft.bearings, shaft.forces), strict=True):
            if parts:
                found[f"{role.value}.{name}"] = [dict(_pair_text_values(part, schema_of(kind))) for part in parts]
    return found


def toml_text(tables: Mapping[str, Mapping[str, Any] | Sequence[Mapping[str, Any]]], comments: Sequence[str] = ()) -> str:
    """Return the TOML of tables with flattened keys, and of lists of tables, beginning with `comments`, a line each."""
    blocks = ["\n".join(f"# {line}".rstrip() for line in comments)] if comments else []
    for table, content in tables.items():
        header, every = (f"[{table}]", [content]) if isinstance(content, Mapping) else (f"[[{table}]]", content)
        for values in every:
            plain = {key: value for key, value in values.items() if not _is_list_of_tables(value)}
            blocks.append("\n".join([header, *(f"{key} = {_toml(value)}" for key, value in plain.items())]))
            lists = {f"{table}.{key}": value for key, value in values.items() if key not in plain}
            blocks += [toml_text({key: value}).rstrip("\n") for key, value in lists.items()]
    return "\n\n".join(blocks) + "\n"


def _is_list_of_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(each, Mapping) for each in value)


def _materials(design: PairDesign) -> dict[str, Material]:
    """Return the materials of a pair by the tables that hold them."""
    if isinstance(design.material, PerGear):
        return {f"{role.value}.material": material for role, material in design.material.items()}
    return {} if design.material is None else {"material": design.material}


def _pair_text_values(instance: Any, keys: Any, always: Sequence[str] = ()) -> Iterator[tuple[str, Any]]:
    """Yield the fields under flattened keys, without those that are derived, or that say no more than their default."""
    left_out = _of_the_tool(instance)
    for key in keys:
        *parts, name = key.split(".")
        if key in left_out:
            continue
        owner = reduce(lambda of, part: getattr(of, part, None), parts, instance)
        if owner is None:  # a part that is not given
            continue
        value = getattr(owner, name)
        if is_dataclass(value) or value is None or not (isinstance(value, str | Enum | tuple) or is_given(value)):
            continue
        opposed = key == "double_helix.offset" and isinstance(instance, Gear) and instance.double_helix.present
        if key in always or opposed or not is_usual(value, _default(owner, name)):
            yield key, value


def _of_the_tool(instance: Any) -> Collection[str]:
    """Return the keys of a gear that its tool says, or that of the tool where no other folder may have its table."""
    if not isinstance(instance, Gear) or not isinstance(name := instance.tool, ToolName) or name.tool is None:
        return ()
    if name.tool.place is Place.DESIGN:
        return ("tool",)
    return [key for key in GEAR_FIELDS if key.partition(".")[0] in TOOL_PARTS]


def _default(owner: Any, name: str) -> Any:
    return type(owner).__dataclass_fields__[name].default


def _toml(value: Any) -> str:
    if isinstance(value, Enum):
        value = value.value
    if isinstance(value, SplinedBore):
        value = value.designation
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, tuple | list):
        return f"[{', '.join(map(_toml, value))}]"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)  # texts of JSON are texts of TOML
    # Python's own numbers are written with the fewest digits that give them back.
    return repr(float(value) if isinstance(value, float) else int(value))


def pair_specs(study: TrainStudy) -> dict[str, str]:
    """Return the spec of each pair of a train, under the name of its file."""
    found: dict[str, str] = {}
    for place, mesh in enumerate(study.train.meshes):
        if isinstance(mesh, EngagedMesh):
            found[_file(mesh, found)] = pair_text(loaded_pair(study.train, mesh), list(_comments(study, mesh, place)))
    return found


def _file(mesh: EngagedMesh, taken: dict[str, str]) -> str:
    """Return a name that no other has, also where large and small letters are the same."""
    return f"{free_name(plain_name(mesh.name), {each.removesuffix('.toml').casefold() for each in taken})}.toml"


def loaded_pair(train: Train, mesh: EngagedMesh) -> PairDesign:
    """Return the pair of a mesh, with the torque and speed that the train gives its pinion, and the inertias of the train."""
    own = mesh_design(mesh)
    name = plain_name(f"{train.name}-{mesh.name}"[:LONGEST_NAME])
    course = mesh.course
    loaded = under_load(own, PinionLoad(course.torque, train.speed * train.speed_ratios[mesh.pinion], course.driver))
    return replace(loaded, name=name, pair=replace(own.pair, name=name), dynamics=_dynamics(train, mesh, own))


def _dynamics(train: Train, mesh: EngagedMesh, own: PairDesign) -> DynamicsOptions:
    """Return [dynamics] options for one pair: stiffness method, damping ratio and inertias (kg·m²) of the train."""
    inertias = {each.name: each.inertia for each in train.inertias}
    options = replace(
        own.dynamics or DynamicsOptions(),
        stiffness=mesh.course.cycle.method,
        pinion_inertia=inertias[mesh.pinion],
        wheel_inertia=inertias[mesh.wheel],
    )
    ratio = mesh.damping_ratio
    return options if ratio is None or not 0 < ratio < 1 else replace(options, damping_ratio=ratio)


def _comments(study: TrainStudy, mesh: EngagedMesh, place: int) -> Iterator[str]:
    """Yield the comment lines that say where the spec of a pair comes from."""
    yield f"Mesh {mesh.name} of the train {study.train.name}, written by `gearcad dynamics`: a pair for `gearcad check`,"
    yield "`gearcad build` and every other command of pairs; the rest of the train is left out."
    drives = "the pinion drives" if mesh.course.driver is Role.PINION else "the wheel drives: the torque is against the turn"
    yield f"The load is what the train at rest gives the pinion; {drives}."
    if mesh.course.driver is Role.WHEEL:
        yield "`gearcad dynamics` of this pair alone meets flanks as if the pinion drove: K_v of modified flanks may differ."
    course, chart = study.course, study.up
    most = int(chart.factors[:, place].argmax())
    yield (
        f"Its dynamic factor in the train is {course.kv[place]:.4g} at {course.speed:.6g} rpm of the first pinion, and"
        f" {chart.factors[most, place]:.4g} at most, at {study.speeds[most]:.6g} rpm; ratings take that of ISO 6336-1."
    )


_SOURCES = {
    FactorSource.GIVEN: "as given",
    FactorSource.COMPUTED: "computed of the train's errors",
    FactorSource.EQUAL: "equal shares",
}


@dataclass(frozen=True, kw_only=True)
class MeshPairs:
    """The pairs of a planetary train by the names of its meshes and stages, with the load that one planet carries.

    `computed_factor` is the K_gamma used if the load gives none. Without a load the pairs have none. Members that need loads
    raise what `power_flow` and `mesh_loads` raise.
    """

    design: PlanetaryDesign
    computed_factor: float | None = None

    @cached_property
    def flow(self) -> PowerFlow | None:
        """The flow of power; None without a load."""
        design = self.design
        return None if design.load is None else power_flow(design.train, design.load, design.speeds)

    @cached_property
    def loads(self) -> dict[str, MeshLoad]:
        """Loads of the set's meshes by name; empty without a load."""
        return {} if self.flow is None else mesh_loads(self.design.train, self.flow, self.computed_factor)

    @cached_property
    def stage_loads(self) -> dict[str, Load]:
        """Loads of the stages by name; empty without a load."""
        return {} if self.flow is None else stage_loads(self.design.train, self.flow)

    @cached_property
    def designs(self) -> dict[str, PairDesign]:
        """A design for each mesh, and for each stage, with the train's material and options of [rating], [check] and [mesh]."""
        found, material = dict[str, PairDesign](), self.design.material
        for mesh in self.design.train.meshes:
            load = self.loads.get(mesh.name)
            found[mesh.name] = self._design(
                mesh.name, mesh.pair, load.load if load else None, mesh_material(material, mesh) if material else None
            )
        for stage in self.design.train.stages:
            made_of = stage_material(material, stage) if material else None
            found[stage.name] = self._design(stage.name, stage.pair, self.stage_loads.get(stage.name), made_of)
        return found

    @property
    def texts(self) -> dict[str, str]:
        """The spec of each pair under the name of its file."""
        return {f"{name}.toml": pair_text(design, list(self._comments(name))) for name, design in self.designs.items()}

    def _design(self, name: str, pair: GearPair, load: Load | None, material: Materials | None) -> PairDesign:
        own = self.design
        # By the train's name, too: results of the suns of two trains have folders of their own.
        full = own.pair_name(name)
        return PairDesign(
            name=full,
            pair=replace(pair, name=full),
            load=load,
            material=material,
            rating=own.rating,
            check=own.check,
            mesh=own.mesh,
        )

    def _comments(self, name: str) -> Iterator[str]:
        """Yield the comment lines that say where the spec of a pair comes from."""
        train = self.design.train
        mesh = next((mesh for mesh in train.meshes if mesh.name == name), None)
        yield f"{'Mesh' if mesh else 'Stage'} {name} of the planetary train {self.design.name}, written by `gearcad planetary`:"
        yield "a pair for `gearcad check`, `gearcad stiffness` and every other command of pairs; other meshes are left out."
        if mesh is None:
            return
        if (load := self.loads.get(name)) is None:
            yield "The train has no load."
            return
        factor = load.mesh_load_factor
        yield f"The load is that of one of {train.planets} planets, on the pinion; its speed is that against the carrier."
        assumed = " (assumed)" if is_assumed(load.application_factor) else ""
        product = f"K_A {load.application_factor:g}{assumed} times K_gamma {factor.value:g} ({_SOURCES[factor.source]})"
        yield f"application_factor is {product}."
        if not train.stepped:
            yield f"Teeth of {mesh.rim.name} bend both ways in every turn: of a root limit for teeth that bend one way"
            yield f"they have {ALTERNATING:g} (Y_M of ISO 6336-3, recalled)."


_DIGITS = 12
"""Significant digits of the numbers of a task, without those that are rounding."""


def pair_keys(sized: SizedPair) -> dict[str, dict[str, Any]]:
    """Return the values of a pair's spec by table and key. The wheel's shift follows from the centre distance."""
    task = sized.task
    one, other = task.materials
    tables: dict[str, dict[str, Any]] = {
        "pair": {
            "name": sized.name,
            "centre_distance": sized.centre_distance,
            "normal_module": sized.normal_module,
            "helix_angle": sized.helix_angle,
            "face_width": sized.face_width,
            **(_changed_fields("rack.", task.rack, ISO53_A) if task.tool is None else {"tool": str(task.tool)}),
        },
        "pinion": {"teeth": sized.teeth.pinion, "profile_shift": sized.pinion_shift},
        "wheel": {"teeth": sized.teeth.wheel, "profile_shift": AUTO},
        "load": _changed_fields("", task.load),
        "rating": _changed_fields("", task.rating),
        "check": {} if task.friction is None else {"friction": task.friction},
    }
    if one == other:
        tables["material"] = _material("", one)
    else:
        tables["pinion"] |= _material("material.", one)
        tables["wheel"] |= _material("material.", other)
    return {table: values for table, values in tables.items() if values}


def _changed_fields(prefix: str, instance: DataclassInstance, usual: DataclassInstance | None = None) -> dict[str, Any]:
    """Return the fields that differ from their defaults, or from those of another instance."""
    found = {}
    for each in fields(instance):
        value, default = getattr(instance, each.name), each.default if usual is None else getattr(usual, each.name)
        if value is not None and (default is MISSING or not is_usual(value, default)):
            found[prefix + each.name] = value
    return found


def _material(prefix: str, material: Material) -> dict[str, Any]:
    """Return the keys of a material, without group and quality if its name implies them."""
    found = _changed_fields(prefix, material)
    if grade_of(material.name) is not None:
        found = {key: value for key, value in found.items() if key.removeprefix(prefix) not in Grade._fields}
    return found


def write_pairs(result: Sizing, path: Path) -> None:
    """Write the design table of all that was found, best first."""
    said = f"best by {result.task.criterion.value} first. Next: gearcad batch {path.name}"
    _write_table(result.task, [dict(_cells(sized)) for sized in result.found], said, path)


def write_front(result: Sizing, path: Path) -> None:
    """Write the design table of the front's sample, lightest first; names are numbered, for some differ in width alone."""
    rows = [{**dict(_cells(each)), "name": f"{number:02d}-{each.name}"} for number, each in enumerate(result.front_sample, 1)]
    said = f"{len(rows)} of {len(result.front)} variants on the front of mass and safety / lightest first / not refined"
    _write_table(result.task, rows, f"{said}. Next: gearcad batch {path.name} --do rate", path)


def _write_table(task: SizeTask, rows: list[dict[str, str]], said: str, path: Path) -> None:
    """Write rows below a line that says what they are for."""
    wanted = f"{task.load.torque:g} N·m at {task.load.speed:g} rpm / u = {task.ratio:g} within {task.ratio_tolerance:g} %"
    write_found_rows(rows, f"Pairs for {wanted}; {said}", path)


def _cells(sized: SizedPair) -> Iterator[tuple[str, str]]:
    for table, values in pair_keys(sized).items():
        for key, value in values.items():
            plain = float(f"{value:.{_DIGITS}g}") if isinstance(value, float) else value
            yield "name" if key == "name" and table == "pair" else f"{table}.{key}", cell_text(_word(plain))


def _word(value: Any) -> Any:
    """Return the value of an enum's member; other values unchanged."""
    return getattr(value, "value", value)


def sized_pair_text(sized: SizedPair, comments: Sequence[str]) -> str:
    """Return the spec of one of the pairs, beginning with `comments`, a line each."""
    return toml_text(_tables(sized), comments)


def _tables(sized: SizedPair) -> Mapping[str, Mapping[str, Any]]:
    order = ("pair", "pinion", "wheel", "material", "load", "rating", "check")
    keys = pair_keys(sized)
    return {table: keys[table] for table in order if table in keys}


_GEARS = ("sun", "planet", "ring", "planet_2", "sun_2", "ring_2")

_RIM = 5.0
"""Thickness of a ring's rim outside its root circle, in modules of diameter."""


def write_found(result: SearchResult, path: Path) -> None:
    """Write the table of the sets that were found, complete or not at all. Raises ParameterError for a name that is not that of
    a table, and if nothing was found.
    """
    if path.suffix.lower() != ".csv":
        raise ParameterError("output", str(path), "must end in .csv")
    if not result.found:
        raise ParameterError("output", str(path), "cannot be written: no set was found")
    rows = [_found_sets_cells(candidate) for candidate in result.found]
    columns = _columns(rows)
    with staged_files(path.parent) as staging, (staging / path.name).open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        wanted = f"i = {result.task.ratio:g} within {result.task.tolerance:g} %, module {result.task.module:g}"
        writer.writerow([f"# Planetary sets for {wanted.replace(',', ' and')}; best first. Next: gearcad batch {path.name}"])
        writer.writerow(columns)
        writer.writerows([row.get(column, "") for column in columns] for row in rows)


def _columns(rows: Sequence[dict[str, str]]) -> list[str]:
    """Return the columns that any row has: the name, then the train, then gear by gear."""
    there = set().union(*rows)
    tables = ("name", "planetary", *_GEARS)
    keys = list(dict.fromkeys(key for row in rows for key in row if key in there))
    return sorted(keys, key=lambda key: tables.index(key.partition(".")[0]))


def _found_sets_cells(candidate: PlanetarySet) -> dict[str, str]:
    """Return a row by its columns."""
    return {"name": candidate.name} | {key: _plain(value) for key, value in set_keys(candidate).items()}


def set_keys(candidate: PlanetarySet) -> dict[str, object]:
    """Return the values of a set's spec by full key. The shifts of centrals follow from the centre distance.

    The thinning is listed so that the user can fill it in: without it no set has backlash.
    """
    task, roles = candidate.task, candidate.task.roles(candidate.kind)
    train: dict[str, object] = {
        "planets": candidate.planets,
        **roles._asdict(),
        "centre_distance": candidate.centre_distance,
        "tip_distance": task.least_distance,
        "normal_module": task.module,
        "face_width": task.width,
        "tooth_thinning": 0.0,
    }
    if task.helix_angle:
        train["helix_angle"] = task.helix_angle
    found = {f"planetary.{key}": value for key, value in train.items()}
    for name in candidate.teeth:
        found |= {f"{name}.{key}": value for key, value in _of_gear(candidate, name).items()}
    return found


def _plain(value: object) -> str:
    """Return a cell, without the last digits of a float, which are rounding: 37.8 and not 37.800000000000004."""
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def _of_gear(candidate: PlanetarySet, name: str) -> dict[str, object]:
    """Return the values that belong to one gear of the set, by key."""
    own: dict[str, object] = {"teeth": candidate.teeth[name]}
    rim = name.startswith("planet")
    own["profile_shift"] = candidate.profile_shifts[name] if rim else AUTO
    if name == "planet_2":
        own |= {"normal_module": candidate.modules[name], "axial_position": candidate.second_height}
        if candidate.task.helix_angle:
            own["helix_angle"] = candidate.helix_angles[name]
    if name.startswith("ring"):
        own["tip_alteration"] = candidate.tip_alterations[name]
        rim_diameter = abs(candidate.gear(name).root_diameter) + _RIM * candidate.modules[name]
        own["body.rim_diameter"] = float(math.ceil(rim_diameter))
    return own


def sized_keys(sized: SizedSet) -> dict[str, dict[str, Any]]:
    """Return the values of a sized set's spec by table and key."""
    tables: dict[str, dict[str, Any]] = {"planetary": {"name": sized.name}}
    for key, value in set_keys(sized.candidate).items():
        table, _, name = key.partition(".")
        tables.setdefault(table, {})[name] = value
    del tables["planetary"]["tooth_thinning"]
    for central in sized.train.centrals:
        if central.gear.internal:
            tables[central.name]["body.rim_diameter"] = central.gear.body.rim_diameter
    tables["load"] = _sized_sets_given(sized.load)
    tables["rating"] = _sized_sets_given(sized.strength.options)
    common = next(iter(sized.materials.values()))
    tables["material"] = _sized_sets_given(common)
    for name, material in sized.materials.items():
        if material != common:
            tables[name] |= {f"material.{key}": value for key, value in _sized_sets_given(material).items()}
    return {table: values for table, values in tables.items() if values}


def _sized_sets_given(instance: DataclassInstance) -> dict[str, Any]:
    """Return the fields that differ from their defaults."""
    values = ((each, getattr(instance, each.name)) for each in fields(instance))
    return {
        each.name: value
        for each, value in values
        if value is not None and (each.default is MISSING or not is_usual(value, each.default))
    }


def write_sized_sets(result: SizedSets, path: Path) -> None:
    """Write the design table of all that was found, lightest first."""
    rows = [dict(_sized_sets_cells(each)) for each in result.found]
    task = result.task
    wanted = f"{task.torque_words} at {task.speed:g} rpm / i = {task.sets.ratio:g}"
    write_found_rows(rows, f"Planetary sets for {wanted}; lightest first. Next: gearcad batch {path.name}", path)


def _sized_sets_cells(sized: SizedSet) -> Iterator[tuple[str, str]]:
    for table, values in sized_keys(sized).items():
        for key, value in values.items():
            named = key == "name" and table == "planetary"
            yield "name" if named else f"{table}.{key}", cell_text(getattr(value, "value", value))


def sized_set_text(sized: SizedSet, comments: list[str]) -> str:
    """Return the spec of one of the sets, beginning with `comments`, a line each."""
    return toml_text(sized_keys(sized), comments)


_TABLE = "measured"
_UNCERTAIN = re.compile(r"\s*(?:\+-|\+/-|±)\s*")
_SIZED = {gauge.value: gauge for gauge in Gauge if gauge.sized}


def read_measurements(path: Path | str, others: Mapping[str, Any] = MappingProxyType({})) -> Measurements:
    """Read the [measured] of a TOML file; `others`, under the same keys, count before what it says.

    Raises SpecError, one line that names the file, the line, the key and what is permitted, and ParameterError for `others`.
    """
    tables, where = read_tables(path)
    for table in tables:
        if table != _TABLE:
            raise SpecError(f"{where(table)}: [{shown(table)}]: unknown table; what was measured stands in [{_TABLE}]", table)
    if not isinstance(found := tables.get(_TABLE, {}), Mapping):
        raise SpecError(f"{where(_TABLE)}: {_TABLE}: must be a table, [{_TABLE}]", _TABLE)
    values = dict(_values(found, where))
    given = values | {key: {**(values.get(key) or {}), **value} if key in _SIZED else value for key, value in others.items()}
    if "teeth" not in given:
        raise SpecError(f"{where(_TABLE)}: {_TABLE}.teeth is missing: must be given, as counted", f"{_TABLE}.teeth")
    try:
        return Measurements(**given)
    except InputError as error:
        key = error.parameter.partition(".")[0]
        key = "span" if key == "span_teeth" else key
        if key in others or key not in values:
            raise
        full = f"{_TABLE}.{key}{_size(values[key], error.value) if key in _SIZED else ''}"
        raise SpecError(f"{where(full)}: {_TABLE}.{error}", full) from error


def _size(readings: Mapping[float, Any], wrong: Any) -> str:
    """Return the end of the key of a reading that is wrong, or whose size is."""
    found = (size for size, value in readings.items() if wrong in (size, value) or (isinstance(value, list) and wrong in value))
    return "".join(f".{size:g}" for size in list(found)[:1])


def _values(table: Mapping[str, Any], where: Where) -> Iterator[tuple[str, Any]]:
    fields = schema_of(Measurements)
    for key, value in table.items():
        full = f"{_TABLE}.{key}"
        if key not in fields:
            near = nearest_key(key, fields)
            hint = f"did you mean {near}?" if near else permitted_words(key, tuple(fields))
            raise SpecError(f"{where(full)}: {shown(full)}: unknown key; {hint}", full)
        try:
            yield key, _by_size(_SIZED[key], value) if key in _SIZED else _reading(key, value)
        except ParameterError as error:
            raise SpecError(f"{where(f'{full}.{error.value}')}: {_TABLE}.{error}", full) from error


def _by_size(gauge: Gauge, given: Any) -> dict[float, Any]:
    """{3: 15.40}; `over_pins.3.5 = 52.9`, which TOML takes for {3: {5: 52.9}}, is meant as one reads it."""
    name = gauge.value
    if not isinstance(given, Mapping):
        example = "span.3 = 15.40" if gauge is Gauge.SPAN else f"{name}.3.5 = 52.95"
        raise ParameterError(name, given, f"must have the {gauge.size_in_words} before the reading: {example}")
    found: dict[float, Any] = {}
    for text, value in given.items():
        inner = {f"{text}.{part}": each for part, each in value.items()} if isinstance(value, Mapping) else {text: value}
        for size, reading in inner.items():
            found[size_of(gauge, size)] = _reading(name, reading)
    return found


def size_of(gauge: Gauge, text: str) -> float:
    """Return the number of teeth spanned, or the diameter of pins or balls, that a text stands for. Raises ParameterError."""
    try:
        return int(text) if gauge is Gauge.SPAN else float(text)
    except ValueError:
        raise ParameterError(gauge.value, text, f"must have a number for the {gauge.size_in_words}") from None


def _reading(name: str, value: Any) -> Any:
    return reading_of(name, value) if isinstance(value, str) else value


def reading_of(name: str, text: str) -> float | tuple[float, float]:
    """Return a reading, with its own uncertainty if there is one: "52.3+-0.1". Raises ParameterError."""
    try:
        numbers = tuple(map(float, _UNCERTAIN.split(text.strip())))
    except ValueError:
        raise ParameterError(name, text, "must be a number, or a number and its uncertainty: 52.3 or 52.3+-0.1") from None
    if len(numbers) > 2:
        raise ParameterError(name, text, "must have one uncertainty: 52.3+-0.1")
    return numbers[0] if len(numbers) == 1 else (numbers[0], numbers[1])


def identified_text(found: Identification, candidate: GearCandidate, name: str) -> str:
    """Return the spec of a candidate, under a name."""
    return toml_text({"gear": _keys(candidate, name)}, list(_identified_comments(found, candidate)))


def _keys(candidate: GearCandidate, name: str) -> dict[str, Any]:
    gear = candidate.gear
    pitch = candidate.diametral_pitch
    keys: dict[str, Any] = {
        "name": name,
        "teeth": gear.teeth,
        **({"normal_module": float(gear.normal_module)} if pitch is None else {"normal_diametral_pitch": pitch}),
        "face_width": gear.face_width,
        "helix_angle": gear.helix_angle,
        "profile_shift": gear.profile_shift,
        "tooth_thinning": gear.tooth_thinning,
        "rack.pressure_angle": gear.rack.pressure_angle,
        "rack.addendum": gear.rack.addendum,
        "rack.dedendum": gear.rack.dedendum,
        "rack.root_radius": gear.rack.root_radius,
    }
    return keys | ({"tip_alteration": gear.tip_alteration} if gear.tip_alteration else {})


def _identified_comments(found: Identification, candidate: GearCandidate) -> Iterator[str]:
    number = found.candidates.index(candidate) + 1
    share = f"{100 * candidate.probability:.3g} %"
    yield f"Candidate {number} of what was measured, probability {share}; rack: {candidate.rack.name}"
    if candidate.tools:
        yield f"its root is left by these tools of the shelf: {', '.join(candidate.tools)}"
    yield "certain" if number == 1 and found.certain else "not certain: see what else there is before this is made"
    yield ""
    yield f"{'':26}{'read':>12}{'uncertainty':>13}{'this gear':>12}"
    for reading, value in zip(found.measured.readings, candidate.predicted, strict=True):
        yield (
            f"{found.measured.label(reading):26}{abs(reading.value):12.4f}{reading.uncertainty:13.4g}{value:12.4f}"
            f" {reading.gauge.unit}"
        )
    yield ""
    yield f"profile shift to ±{candidate.shift_uncertainty:.2g}, thinning to ±{candidate.thinning_uncertainty:.2g} mm" + (
        f", helix angle to ±{candidate.helix_uncertainty:.2g} deg" if candidate.gear.helix_angle else ""
    )
    yield "Face width, root radius and bore were not measured: change them. The hand of a helix is right unless said otherwise."
