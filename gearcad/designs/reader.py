"""Spec files: TOML in, a Design out. The keys are the field names of the inputs; README.md and the templates show them.

`[gear]`, or `[pair]` + `[pinion]` + `[wheel]`, decides the kind. What both gears share may stand in `[pair]`; a gear's own
value wins, and the wheel takes the opposite hand. Whatever is not understood is refused, so nothing is silently ignored.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from gearcad.check.options import CheckOptions
from gearcad.designs.auto import AUTO, make_gears, resolve_profile_shifts, resolve_tip_alterations
from gearcad.designs.design import Design, DesignKind, require_plain_name
from gearcad.designs.keys import KEYS, LISTS, PARTS, SHARED, explain_unknown_key, explain_unknown_table
from gearcad.designs.lines import explain_syntax, find_lines, nearest_line
from gearcad.designs.suffixes import is_table_name
from gearcad.dynamics.options import DynamicsOptions
from gearcad.errors import (
    GeometryError,
    InputError,
    ParameterError,
    SpecError,
    as_choice,
    format_number,
    printable,
    require_number,
    shown,
)
from gearcad.geometry import NAMED_RACKS, BasicRack, Body, FlankModification, Gear, GearPair, ShiftSplit
from gearcad.load import Load
from gearcad.material import Material
from gearcad.mounting import Mounting
from gearcad.rating.options import RatingOptions

__all__ = ["Cell", "Where", "design_from_tables", "read_spec", "read_tables", "spec_values"]

Where = Callable[[str], str]
"""Says where a key stands, such as `pair.toml line 7`, for the beginning of a message."""

_DERIVED = ("tip_diameter", "root_diameter", "centre_distance")
WHOLE_FIELDS = (
    "teeth",
    "body_teeth",
    "positions",
    "speeds",
    "harmonics",
    "frequencies",
    "accuracy_grade",
    "seed",
)
"""Fields that are whole numbers; elsewhere 2 means 2.0."""

_DEEPEST = 50
"""Levels of tables and lists in each other: no key of ours needs more than a few."""

_MOST_WHOLE = 10**15

Cell = int | float | str | tuple[float, ...]
"""What a spec and a cell of a design table can both hold."""

Simple = TypeVar("Simple", Material, Load, Mounting, CheckOptions, DynamicsOptions, RatingOptions)


class _Given(NamedTuple):
    """A value, the key under which the user wrote it, and how it came about if it was not written."""

    value: Any
    key: str
    note: str = ""


def read_spec(path: Path | str) -> Design:
    """Read a TOML spec. The name of the design is its own, else the stem of the file.

    Raises SpecError, one line that names the file, the line, the key and what is permitted.
    """
    tables, where = read_tables(path)
    return design_from_tables(tables, where=where, default_name=Path(path).stem)


def spec_values(path: Path | str) -> tuple[DesignKind, str, dict[str, Cell]]:
    """Kind and name of a spec, and its other values under their dotted keys as a design table holds them: "auto" is a text.

    The values need not make a gear. Raises SpecError, for a value that no cell can hold too.
    """
    tables, where = read_tables(path)
    kind = _kind(tables, where)
    spec = _Spec(_flatten(tables, where), where)
    name = spec.name(kind.value, Path(path).stem)
    values = {key: given.value for key, given in spec.values.items() if key != f"{kind.value}.name"}
    for key, value in values.items():
        if key in LISTS and isinstance(value, list) and all(type(item) in (int, float) for item in value):
            values[key] = tuple(float(item) for item in value)
        elif isinstance(value, bool) or not isinstance(value, int | float | str):
            raise SpecError(f"{where(key)}: {key} = {format_number(value)}: must be a number or a text")
    return kind, name, values


def read_tables(path: Path | str) -> tuple[dict[str, Any], Where]:
    """The tables of a TOML spec as they are written, and what locates a key of theirs for messages. Raises SpecError."""
    path, file = Path(path), printable(str(path))
    try:
        text = path.read_bytes().decode("utf-8-sig")
    except OSError as error:
        raise SpecError(
            f"{file}: cannot be read ({error.strerror}); give a spec file, or make one with `gearcad new`"
        ) from error
    except UnicodeDecodeError as error:
        _refuse_table(path)
        raise SpecError(f"{file}: is not UTF-8 text (byte {error.start}); save it as UTF-8") from error
    try:
        tables = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        _refuse_table(path)
        raise SpecError(f"{file}{explain_syntax(error, text)}") from error
    except ValueError as error:
        raise SpecError(f"{file}: has a whole number of thousands of digits; write a smaller one") from error
    except RecursionError as error:
        raise SpecError(f"{file}: has lists or tables in each other, hundreds deep") from error
    lines = find_lines(text)

    def where(key: str) -> str:
        line = nearest_line(lines, key)
        return f"{file} line {line}" if line else file

    require_sane_tables(tables, where)
    return tables, where


def _refuse_table(path: Path) -> None:
    if is_table_name(path):
        raise SpecError(f"{path}: is a design table, not the spec of one design; use `gearcad batch {path}`")


def require_sane_tables(content: Any, where: Where, key: str = "", depth: int = 0) -> None:
    """Raise SpecError for a whole number in the tables of a spec that a float could not hold, and for tables too deep."""
    if depth > _DEEPEST:
        raise SpecError(f"{where(key)}: {shown(key)}: has lists or tables in each other, more than {_DEEPEST} deep", key)
    if isinstance(content, Mapping):
        for name, inner in content.items():
            require_sane_tables(inner, where, f"{key}.{name}" if key else name, depth + 1)
    elif isinstance(content, list | tuple):
        for number, inner in enumerate(content):
            require_sane_tables(inner, where, f"{key}[{number}]" if isinstance(inner, Mapping) else key, depth + 1)
    elif isinstance(content, int) and abs(content) > _MOST_WHOLE:
        raise SpecError(f"{where(key)}: {shown(key)}: must be a smaller number; this is {format_number(content)}", key)


def design_from_tables(tables: Mapping[str, Any], *, where: Where, default_name: str) -> Design:
    """The design that parsed tables describe: {"gear": {"teeth": 20, "rack": {...}, ...}}, one mapping per TOML table.

    `where` locates a dotted key for messages. Raises SpecError.
    """
    kind = _kind(tables, where)
    spec = _Spec(_flatten(tables, where), where)
    material = spec.simple("material", Material) if "material" in tables else None
    load = spec.simple("load", Load) if "load" in tables else None
    mounting = spec.simple("mounting", Mounting) if "mounting" in tables else None
    check = spec.simple("check", CheckOptions) if "check" in tables else None
    dynamics = spec.simple("dynamics", DynamicsOptions) if "dynamics" in tables else None
    rating = spec.simple("rating", RatingOptions) if "rating" in tables else None
    main = kind.value
    name = spec.name(main, default_name)
    gear = spec.gear(name) if kind is DesignKind.GEAR else None
    pair = spec.pair(name) if kind is DesignKind.PAIR else None
    with spec.blame(main):
        return Design(
            kind=kind,
            name=name,
            gear=gear,
            pair=pair,
            material=material,
            load=load,
            mounting=mounting,
            check=check,
            dynamics=dynamics,
            rating=rating,
        )


def _kind(tables: Mapping[str, Any], where: Where) -> DesignKind:
    if "train" in tables:
        raise SpecError(f"{where('train')}: [train] describes a train, which only `gearcad dynamics` can treat")
    for table, content in tables.items():
        if table not in KEYS:
            raise SpecError(f"{where(table)}: {shown(table)}: {explain_unknown_table(table)}")
        if not isinstance(content, Mapping):
            raise SpecError(f"{where(table)}: {table} = {format_number(content)}: must be a table, headed [{table}]")
    if "gear" in tables:
        for other in ("pair", "pinion", "wheel"):
            if other in tables:
                raise SpecError(f"{where(other)}: [{other}] cannot stand beside [gear]: one spec makes a gear or a pair")
        return DesignKind.GEAR
    if not any(table in tables for table in ("pair", "pinion", "wheel")):
        raise SpecError(f"{where('')}: makes nothing yet: must have [gear], or [pair] with [pinion] and [wheel]")
    for table in ("pair", "pinion", "wheel"):
        if table not in tables:
            raise SpecError(f"{where('')}: [{table}] is missing: a pair needs [pair], [pinion] and [wheel]")
    return DesignKind.PAIR


def _flatten(tables: Mapping[str, Any], where: Where) -> dict[str, _Given]:
    """Every value under its dotted key, whole numbers turned into floats where floats are meant."""
    values = {}
    for table, content in tables.items():
        for field, value in _entries(content):
            key = f"{table}.{field}"
            if field not in KEYS[table]:
                raise SpecError(f"{where(key)}: {shown(key)}: {explain_unknown_key(table, field)}")
            require_sane_tables(value, where, key)
            if isinstance(value, int) and not isinstance(value, bool):
                value = value if field in WHOLE_FIELDS else float(value)
            # The sum makes -0.0 a plain zero, so that equal inputs give equal files.
            values[key] = _Given(value + 0.0 if isinstance(value, float) else value, key)
    return values


def _entries(content: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Keys and values of one table, those of `rack`, `body` and `modification` joined to them with a dot."""
    for field, value in content.items():
        if field in PARTS and isinstance(value, Mapping):
            yield from ((f"{field}.{inner}", item) for inner, item in value.items())
        else:
            yield field, value


@dataclass(frozen=True)
class _Spec:
    """The values of one spec under their dotted keys, and how to make inputs of them."""

    values: dict[str, _Given]
    where: Where

    @contextmanager
    def blame(self, owner: str) -> Iterator[None]:
        """Turn an InputError about a field of `owner` into a SpecError about the key that set it."""
        try:
            yield
        except InputError as error:
            raise self._explained(error, owner) from error

    def _explained(self, error: InputError, owner: str) -> SpecError:
        field = error.parameter
        if field.startswith(("pinion.", "wheel.")):
            owner, _, field = field.partition(".")
        # The profile knows the chamfer, not whose it is.
        field = "body.tip_chamfer" if field == "tip_chamfer" else field
        permitted = error.permitted
        if owner in ("pinion", "wheel") and field in ("profile_shift", "tip_alteration") and isinstance(error, ParameterError):
            permitted += f', or "{AUTO}"'
        given = self.values.get(f"{owner}.{field}")
        if given is None and error.value is None:
            shared = " (here or in [pair])" if owner in ("pinion", "wheel") and field in SHARED else ""
            key = f"{owner}.{field}"
            return SpecError(f"{self.where(key)}: {key} is missing: {permitted}{shared}", key)
        if given is None:
            given = self._unwritten(owner, field)
        note = f" ({given.note})" if given.note else ""
        unit = f" {error.unit}" if error.unit else ""
        cause = self._automatic_cause(owner, field)
        text = f"{self.where(given.key)}: {given.key} = {format_number(error.value)}{unit}{note}: {permitted}{cause}"
        return SpecError(text, given.key)

    def _automatic_cause(self, owner: str, field: str) -> str:
        """A reminder that the profile shift of the gear at fault was derived, and from what."""
        shift = self.values.get(f"{owner}.profile_shift")
        if field == "profile_shift" or shift is None or not shift.note:
            return ""
        return f"; its profile_shift is {shift.value:.6g} ({shift.note})"

    def _unwritten(self, owner: str, field: str) -> _Given:
        """Where a value that nobody wrote comes from."""
        named = self.values.get(f"{owner}.rack")
        if named and field.startswith("rack."):
            return named._replace(key=f"{owner}.{field}", note=f"of {named.value}")
        note = "derived" if field in _DERIVED else "from the file's name" if field == "name" else "by default"
        return _Given(None, f"{owner}.{field}", note)

    def name(self, main: str, default: str) -> str:
        """The name of the design, which its main table or else the file gives."""
        given = self.values.get(f"{main}.name")
        with self.blame(main):
            require_plain_name(default if given is None else given.value)
        return default if given is None else str(given.value)

    def fields_of(self, owner: str) -> dict[str, Any]:
        """Values of one table, still flat: `rack.root_radius` is one key."""
        return {key.partition(".")[2]: given.value for key, given in self.values.items() if key.startswith(owner + ".")}

    def simple(self, owner: str, kind: type[Simple]) -> Simple:
        """A Material, a Load, a Mounting, or the options of a check, of the dynamics or of the rating."""
        values = self.fields_of(owner)
        with self.blame(owner):
            if not isinstance(values.get("name", ""), str):
                raise ParameterError("name", values["name"], "must be a text")
            if kind is Load:
                values.setdefault("torque", None)
            return kind(**values)

    def gear(self, name: str) -> Gear:
        """The one gear of `[gear]`."""
        with self.blame("gear"):
            inputs = self._gear_inputs("gear")
            for key in ("profile_shift", "tip_alteration"):
                if inputs.get(key) == AUTO:
                    raise GeometryError(key, AUTO, "must be a number: only the gears of a pair know what to derive it from")
            return Gear(**inputs | {"name": name})

    def pair(self, name: str) -> GearPair:
        """The pair of `[pair]`, `[pinion]` and `[wheel]`, with every "auto" resolved."""
        self._share_values()
        self._oppose_helix()
        inputs = {}
        for owner in ("pinion", "wheel"):
            with self.blame(owner):
                inputs[owner] = {"name": owner} | self._gear_inputs(owner)
        with self.blame("pair"):
            given = self._pair_inputs()
            split = given.pop("profile_shift_split", None)
            self._resolve_auto(inputs, given.get("centre_distance"), split)
            gears = make_gears(inputs, {owner: self._automatic(owner) for owner in inputs}, given.get("centre_distance"))
            return GearPair(pinion=gears["pinion"], wheel=gears["wheel"], **given | {"name": name})

    def _automatic(self, owner: str) -> list[str]:
        """Fields of a gear that stood as "auto"."""
        values = {field: self.values.get(f"{owner}.{field}") for field in ("profile_shift", "tip_alteration")}
        return [field for field, given in values.items() if given is not None and given.note.startswith(AUTO)]

    def _pair_inputs(self) -> dict[str, Any]:
        given = {key: value for key, value in self.fields_of("pair").items() if key not in SHARED}
        if "centre_distance" in given:
            require_number("centre_distance", given["centre_distance"], "mm", above=0)
        if "profile_shift_split" in given:
            given["profile_shift_split"] = as_choice("profile_shift_split", given["profile_shift_split"], ShiftSplit)
        return given

    def _share_values(self) -> None:
        """Give both gears what stands in [pair], unless they have their own; the helix angle is the pinion's."""
        for owner in ("pinion", "wheel"):
            renamed = f"{owner}.rack" in self.values
            for field in SHARED:
                given = self.values.get(f"pair.{field}")
                if given is None or (field == "helix_angle" and owner == "wheel"):
                    continue
                if not (renamed and field.startswith("rack")):
                    self.values.setdefault(f"{owner}.{field}", given)

    def _oppose_helix(self) -> None:
        """The gear without a helix angle takes the mate's, of the opposite hand."""
        for owner, mate in (("wheel", "pinion"), ("pinion", "wheel")):
            given = self.values.get(f"{mate}.helix_angle")
            if given is not None and f"{owner}.helix_angle" not in self.values:
                value = 0.0 - given.value if isinstance(given.value, float) else given.value
                self.values[f"{owner}.helix_angle"] = given._replace(value=value)

    def _gear_inputs(self, owner: str) -> dict[str, Any]:
        """Keyword arguments of Gear; "auto" not yet resolved, what is missing as None for Gear to complain about."""
        given = self.fields_of(owner)
        parts: dict[str, dict[str, Any]] = {part: {} for part in PARTS}
        inputs: dict[str, Any] = dict.fromkeys(("teeth", "normal_module", "face_width"))
        for key, value in given.items():
            part, _, field = key.partition(".")
            if field:
                parts[part][field] = value
            elif key != "rack":
                inputs[key] = value
        try:
            base = _named_rack(given["rack"]) if "rack" in given else BasicRack()
            inputs["rack"] = BasicRack(**{f.name: getattr(base, f.name) for f in fields(base)} | parts["rack"])
        except InputError as error:
            if error.parameter == "rack":
                raise
            raise error.within("rack") from error
        for part, kind in (("body", Body), ("modification", FlankModification)):
            try:
                inputs[part] = kind(**parts[part])
            except InputError as error:
                raise error.within(part) from error
        return inputs

    def _resolve_auto(self, inputs: dict[str, dict[str, Any]], distance: float | None, split: ShiftSplit | None) -> None:
        pinion, wheel = inputs["pinion"], inputs["wheel"]
        shifts = resolve_profile_shifts(pinion, wheel, distance, split)
        alterations = resolve_tip_alterations(pinion, wheel, shifts, distance)
        asked = "" if distance is None else f": centre distance {distance:g} mm asks for x1 + x2 = {sum(shifts):.6g}"
        for owner, shift, alteration in zip(inputs, shifts, alterations, strict=True):
            for field, value, note in (("profile_shift", shift, AUTO + asked), ("tip_alteration", alteration, AUTO)):
                if inputs[owner].get(field, AUTO if field == "tip_alteration" else 0.0) == AUTO:
                    key = self.values.get(f"{owner}.{field}", _Given(AUTO, f"{owner}.{field}")).key
                    self.values[f"{owner}.{field}"] = _Given(value, key, note)
            inputs[owner] |= {"profile_shift": shift, "tip_alteration": alteration}


def _named_rack(name: Any) -> BasicRack:
    if not isinstance(name, str) or name not in NAMED_RACKS:
        names = ", ".join(repr(known) for known in NAMED_RACKS)
        raise ParameterError("rack", name, f"must be one of {names}, or be described by rack.addendum, rack.dedendum ...")
    return NAMED_RACKS[name]
