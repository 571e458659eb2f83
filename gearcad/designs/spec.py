"""Spec: the values of one spec's tables under their dotted keys, and how inputs are made of them.

What both gears of a pair share may stand in `[pair]`, so an error is led back to the key that the user wrote.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any, ClassVar, NamedTuple, Self, TypeVar

from gearcad.designs.auto import AUTO, CLEAR
from gearcad.designs.design import require_plain_name
from gearcad.designs.files import Where, require_sane_tables
from gearcad.designs.keys import ALTERNATIVES, FIELDS, GEAR_FIELDS, PARTS, PARTS_BESIDE, SHARED, explain_unknown_key, field_of
from gearcad.errors import GeometryError, InputError, ParameterError, SpecError, format_number, shown
from gearcad.geometry import NAMED_RACKS, BasicRack
from gearcad.per_gear import Role
from gearcad.schema import FieldSchema

__all__ = ["OF_SHIFT", "Given", "Spec"]

OF_SHIFT = (
    "profile_shift",
    "tip_alteration",
    "tooth_thinning",
    "tip_diameter",
    "root_diameter",
    "rack.addendum",
    "rack.dedendum",
    "rack.root_radius",
    "cutter.profile_shift",
    "cutter.tip_radius",
    "body.tip_chamfer",
)
"""Fields of a gear whose limits go with its profile shift."""

_DERIVED = ("normal_module", "tip_diameter", "root_diameter", "centre_distance", "mounting_distance")
_ROLES = tuple(role.value for role in Role)
_DIGITS_TOLD = 9
"""Decimals of a derived shift in words: beyond them it is rounding noise."""

_SWITCH = {"true": True, "false": False}
"""What cells of a table have for what is true or false."""

_OWN = ("material", "drawing")
"""Tables of a gear's own, which are read by themselves."""

_TABLES_OF_GEAR = (*PARTS, *_OWN)

Simple = TypeVar("Simple")


class Given(NamedTuple):
    """A value, the key under which the user wrote it, and how it came about if it was not written."""

    value: Any
    key: str
    note: str = ""


@dataclass(frozen=True)
class Spec:
    """The values of one spec under their dotted keys, and how to make inputs of them.

    The values of an owner, such as a gear, are those of the table of its name, unless it is among `names`.
    """

    main: ClassVar[str] = "pair"
    """The table that holds what gears share."""

    values: dict[str, Given]
    where: Where
    names: Mapping[str, str] = dataclasses.field(default_factory=dict)

    @classmethod
    def of(cls, tables: Mapping[str, Any], where: Where) -> Self:
        """Every value under its dotted key, whole numbers turned into floats where floats are meant. Raises SpecError."""
        values = {}
        for table, content in tables.items():
            for field, value in _entries(content, PARTS_BESIDE.get(table, _TABLES_OF_GEAR)):
                key = f"{table}.{field}"
                said = field_of(table, field)
                if said is None:
                    raise SpecError(f"{where(key)}: {shown(key)}: {explain_unknown_key(table, field)}")
                require_sane_tables(value, where, key)
                if said.switch and isinstance(value, str):
                    value = _SWITCH.get(value, value)
                if isinstance(value, int) and not isinstance(value, bool):
                    value = value if said.whole else float(value)
                # The sum makes -0.0 a plain zero, so that equal inputs give equal files.
                values[key] = Given(value + 0.0 if isinstance(value, float) else value, key)
        return cls(values, where)

    @contextmanager
    def blame(self, owner: str) -> Iterator[None]:
        """Turn an InputError about a field of `owner` into a SpecError about the key that set it."""
        try:
            yield
        except InputError as error:
            raise self._explained(error, owner) from error

    def _place(self, parameter: str, owner: str) -> tuple[str, str]:
        """Whose a parameter of an error about `owner` is, and which field of it."""
        if (first := parameter.partition(".")[0]) in _ROLES or (first == "rack" and owner == "pair"):
            owner, _, parameter = parameter.partition(".")
        return owner, parameter

    def _written(self, owner: str, field: str) -> str:
        """The key under which the user writes, or would write, a field of an owner."""
        return f"{self.names.get(owner, owner)}.{field}"

    def _words(self, owner: str) -> tuple[str, ...]:
        """The owner's words that stand for a profile shift, and for a tip alteration, besides."""
        if owner not in _ROLES:
            return ()
        return (AUTO, CLEAR) if owner == "wheel" else (AUTO,)

    def _explained(self, error: InputError, owner: str) -> SpecError:
        owner, field = self._place(error.parameter, owner)
        # The profile knows the chamfer, not whose it is.
        field = "body.tip_chamfer" if field == "tip_chamfer" and owner != "rack" else field
        permitted = error.permitted.replace(f"[{self.main}]", f"[{self.names.get(self.main, self.main)}]")
        if field in ("profile_shift", "tip_alteration") and isinstance(error, ParameterError):
            words = self._words(owner)
            permitted += f', or "{AUTO}"' if AUTO in words else ""
            permitted += f', or of a ring "{CLEAR}"' if field == "tip_alteration" and CLEAR in words else ""
        given = self.values.get(f"{owner}.{field}")
        if given is None and error.value is None:
            key = self._written(owner, field)
            main = self.names.get(self.main, self.main)
            shared = f" (here or in [{main}])" if self._shares(owner) and field in SHARED else ""
            return SpecError(f"{self.where(key)}: {key} is missing: {permitted}{shared}", key)
        if given is None:
            given = self._unwritten(owner, field)
        note = f" ({given.note})" if given.note else ""
        unit = f" {error.unit}" if error.unit else ""
        cause = self._automatic_cause(owner, field) if isinstance(error, GeometryError) else ""
        text = f"{self.where(given.key)}: {given.key} = {format_number(error.value)}{unit}{note}: {permitted}{cause}"
        return SpecError(text, given.key)

    def _shares(self, owner: str) -> bool:
        """Whether an owner's values may stand in the main table too."""
        return owner in _ROLES or (owner == "rack" and any(f"{role}.teeth" in self.values for role in _ROLES))

    def _automatic_cause(self, owner: str, field: str) -> str:
        """A reminder that the profile shift of the gear at fault was derived, and from what, where the fault depends on it."""
        shift = self.values.get(f"{owner}.profile_shift")
        if field == "profile_shift" or field not in OF_SHIFT or shift is None or not shift.note:
            return ""
        return f"; its profile_shift is {round(shift.value, _DIGITS_TOLD) + 0.0:.6g} ({shift.note})"

    def _unwritten(self, owner: str, field: str) -> Given:
        """Where a value that nobody wrote comes from."""
        named = self.values.get(f"{owner}.rack")
        if named and field.startswith("rack."):
            return named._replace(key=self._written(owner, field), note=f"of {named.value}")
        note = "derived" if field in _DERIVED else "from the file's name" if field == "name" else "by default"
        return Given(None, self._written(owner, field), note)

    def name(self, main: str, default: str) -> str:
        """The name of the design, which its main table or else the file gives."""
        given = self.values.get(f"{main}.name")
        with self.blame(main):
            require_plain_name(default if given is None else given.value)
        return default if given is None else str(given.value)

    def giving_way(self, owner: str) -> set[str]:
        """What an owner does not share, as it has that or something in its place."""
        given = [each for each in ALTERNATIVES if any(f"{owner}.{field}" in self.values for field in each)]
        return {field for each in given for field in each}

    def fields_of(self, owner: str) -> dict[str, Any]:
        """Values of one table, still flat: `rack.root_radius` is one key."""
        return {key[len(owner) + 1 :]: given.value for key, given in self.values.items() if key.startswith(owner + ".")}

    def given_of(self, owner: str) -> dict[str, Given]:
        """The same with the keys that the user wrote."""
        return {key[len(owner) + 1 :]: given for key, given in self.values.items() if key.startswith(f"{owner}.")}

    def simple(self, owner: str, kind: type[Simple], values: Mapping[str, Any] | None = None) -> Simple:
        """What a table of plain `values`, or those of its owner, makes: a Material, a Load, a Mounting, or a job's options."""
        values = self.fields_of(owner) if values is None else values
        with self.blame(owner):
            if not isinstance(values.get("name", ""), str):
                raise ParameterError("name", values["name"], "must be a text")
            return kind(**_missing(FIELDS[owner.rpartition(".")[2]]) | _with_parts(values, PARTS_BESIDE.get(owner, {})))

    def gear_inputs(self, owner: str) -> dict[str, Any]:
        """Keyword arguments of Gear; "auto" not yet resolved, what is missing as None for Gear to complain about."""
        return self._inputs_of(owner, PARTS, GEAR_FIELDS)

    def rack_inputs(self, owner: str) -> dict[str, Any]:
        """Keyword arguments of Rack; what is missing as None."""
        return self._inputs_of(owner, {"rack": BasicRack}, FIELDS["rack"])

    def _inputs_of(self, owner: str, kinds: Mapping[str, type[Any]], fields: Mapping[str, FieldSchema]) -> dict[str, Any]:
        """Keyword arguments of what has parts of these kinds, and these fields."""
        given = self.fields_of(owner)
        parts: dict[str, dict[str, Any]] = {part: {} for part in kinds}
        inputs = _missing(fields)
        for key, value in given.items():
            part, _, field = key.partition(".")
            if part in _OWN:
                continue
            if field:
                parts[part][field] = value
            elif key != "rack":
                inputs[key] = value
        if "rack" in given:
            rack = _named_rack(given["rack"])
            with _within("rack"):
                inputs["rack"] = replace(rack, **parts["rack"])
        for part, kind in kinds.items():
            if part not in inputs:
                with _within(part):
                    inputs[part] = kind(**parts[part])
        return inputs


@contextmanager
def _within(part: str) -> Iterator[None]:
    """Let errors about a field of a part say so: `body.bore`."""
    try:
        yield
    except InputError as error:
        raise error.within(part) from error


def _with_parts(values: Mapping[str, Any], kinds: Mapping[str, type[Any]]) -> dict[str, Any]:
    """The values of a table, those of its parts made into these; none of those of which nothing is given."""
    found = {key: value for key, value in values.items() if "." not in key}
    for part, kind in kinds.items():
        given = {key.removeprefix(f"{part}."): value for key, value in values.items() if key.startswith(f"{part}.")}
        if given:
            with _within(part):
                found[part] = kind(**given)
    return found


def _missing(fields: Mapping[str, FieldSchema]) -> dict[str, Any]:
    """None for every field that must be given: its type complains about it."""
    return {key: None for key, field in fields.items() if field.required}


def _entries(content: Mapping[str, Any], parts: Collection[str]) -> Iterator[tuple[str, Any]]:
    """Keys and values of one table, those of its parts, such as `rack` and `body`, joined to them with a dot."""
    for field, value in content.items():
        if field in parts and isinstance(value, Mapping):
            yield from ((f"{field}.{inner}", item) for inner, item in value.items())
        else:
            yield field, value


def _named_rack(name: Any) -> BasicRack:
    if not isinstance(name, str) or name not in NAMED_RACKS:
        names = ", ".join(repr(known) for known in NAMED_RACKS)
        raise ParameterError("rack", name, f"must be one of {names}, or be described by rack.addendum, rack.dedendum ...")
    return NAMED_RACKS[name]
