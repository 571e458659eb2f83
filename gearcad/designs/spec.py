"""Spec: the values of a spec's tables under their dotted keys, with "auto", materials and drawings of single gears.

What both gears of a pair share may stand in `[pair]`, so an error is led back to the key that the user wrote.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self, TypeVar

from gearcad.core.errors import GeometryError, InputError, ParameterError, SpecError, format_number, shown
from gearcad.core.quantities import FieldSchema, parts_of, schema_of
from gearcad.core.records import PerGear, Role, naming
from gearcad.core.units import module_of_pitch
from gearcad.designs.design import Where, require_plain_name, require_sane_tables
from gearcad.designs.keys import (
    ALTERNATIVES,
    FIELDS,
    GEAR_FIELDS,
    PARTS,
    PARTS_BESIDE,
    RACK_PARTS,
    SHARED,
    explain_unknown_key,
    field_of,
)
from gearcad.geometry import (
    NAMED_RACKS,
    BasicRack,
    Gear,
    GearPair,
    ShaperCutter,
    ShiftSplit,
    profile_shift_sum,
    split_profile_shift,
    zero_backlash_centre_distance,
)
from gearcad.geometry.feasibility import check_given
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.mating import tip_on_form_circle
from gearcad.geometry.tool_shelf import find_tool, module_given
from gearcad.geometry.tool_tables import PARTS as TOOL_PARTS
from gearcad.material import GRADED_GROUPS, Grade, Material, MaterialQuality, grade_of

if TYPE_CHECKING:
    from gearcad.drawing.options import DrawingOptions, PartDrawing


AUTO = "auto"

CLEAR = "clear"
"""Tip alteration of a ring whose tip stays off its pinion's fillet."""

_SAME = 1e-9
"""Difference of two modules or pressure angles that is rounding, as in GearPair."""

_FOLLOWING = ("profile_shift", "tip_alteration", "tip_diameter", "root_diameter")
"""Fields of a gear that may follow from the centre distance."""

GearInputs = Mapping[str, Any]
"""Keyword arguments of a Gear, where `profile_shift` and `tip_alteration` may still be "auto"."""


def resolve_profile_shifts(
    gears: PerGear[GearInputs], centre_distance: float | None, split: ShiftSplit | None
) -> PerGear[float]:
    """Profile shifts x with each "auto" replaced.

    One "auto" takes the rest of the sum that meshes without backlash at `centre_distance` (mm; thinning then gives the
    backlash). Two share the sum by `split` (None: equal specific sliding). Raises GeometryError where no shift can do it,
    and ParameterError for a number that is not permitted whatever the shifts are; parameters are led by their gear.
    """
    shifts: PerGear[Any] = gears.map(lambda gear: gear.get("profile_shift", 0.0))
    for role, gear in gears.items():
        require_sound_numbers(gear, role.value)
    automatic = [role for role, shift in shifts.items() if shift == AUTO]
    if split is not None and len(automatic) < len(Role):
        raise GeometryError("profile_shift_split", split, 'needs profile_shift = "auto" on both gears')
    if not automatic:
        return shifts
    if centre_distance is None:
        raise GeometryError(f"{automatic[0].value}.profile_shift", AUTO, "needs centre_distance in [pair]")
    if not _mate(gears):
        return PerGear(0.0, 0.0)  # GearPair refuses them, and says why
    total = profile_shift_sum(**_sizes(gears), centre_distance=centre_distance)
    if len(automatic) == len(Role):
        return _shared(total, gears, centre_distance, split or ShiftSplit.EQUAL_SPECIFIC_SLIDING)
    return PerGear.each(lambda role: total - shifts.pick(role.mate) if role in automatic else shifts.pick(role))


def resolve_tip_alterations(gears: PerGear[GearInputs], shift_sum: float, centre_distance: float | None) -> PerGear[float]:
    """Tip alterations k, in normal modules, with each "auto" (the default) replaced.

    k = (a - a_d)/m_n - (x_1 + x_2), never positive (DIN 3960). `centre_distance` None stands for the one without backlash.
    A gear whose tip diameter is given has none.
    """
    keeping = _clearance_keeping(gears, shift_sum, centre_distance) if _mate(gears) else 0.0

    def of(gear: GearInputs) -> float:
        value: Any = gear.get("tip_alteration", AUTO)
        automatic = 0.0 if "tip_diameter" in gear else keeping
        return automatic if value in (AUTO, CLEAR) else float(value)

    return gears.map(of)


def backlash_free_distance(gears: PerGear[GearInputs], shift_sum: float) -> float:
    """Return the centre distance (mm) at which these gears would mesh without backlash; negative with a ring. Raises
    GeometryError.
    """
    return zero_backlash_centre_distance(**_sizes(gears), shift_sum=shift_sum)


def clear_tip_alteration(gears: PerGear[GearInputs], centre_distance: float | None) -> float:
    """Tip alteration k of the ring, in normal modules, that ends its flank on the pinion's root form circle; never positive.

    The gears are resolved but for it. Raises InputError of the pinion, its parameter led by it.
    """
    with naming(Role.PINION):
        pinion = Gear(**gears.pinion)
    ring = GearData(**{**gears.wheel, "normal_module": module_of(gears.wheel), "tip_alteration": 0.0})
    if centre_distance is None:
        shift_sum = sum(gears.map(lambda gear: gear["profile_shift"]))
        try:
            centre_distance = zero_backlash_centre_distance(**_sizes(gears), shift_sum=shift_sum)
        except GeometryError:
            return 0.0  # no such centre distance: GearPair says so
    tip = tip_on_form_circle(ring, pinion, centre_distance)
    return 0.0 if tip is None else min((tip - ring.standard_tip_diameter) / (2 * ring.normal_module), 0.0)


def make_gears(gears: PerGear[GearInputs], automatic: PerGear[Collection[str]], centre_distance: float | None) -> PerGear[Gear]:
    """Return both gears from their resolved inputs; `automatic` names those that were given as "auto".

    Raises InputError: of the gear, its parameter led by the gear, or of the centre distance (mm) if that is what made it fail.
    """

    def made(role: Role) -> Gear:
        inputs = gears.pick(role)
        try:
            return Gear(**inputs)
        except InputError as error:
            own = error.parameter in inputs and error.parameter not in automatic.pick(role)
            if centre_distance is None or own or error.parameter not in _FOLLOWING:
                raise error.within(role.value) from error
            raise _led_back(error.within(role.value), gears, automatic, centre_distance) from error

    return PerGear(*map(made, Role))


def _led_back(
    fault: InputError, gears: PerGear[GearInputs], automatic: PerGear[Collection[str]], centre_distance: float
) -> InputError:
    """Return the fault of a gear as one of the centre distance (mm), if that caused it: tips without shortening show this."""
    made = []
    for role, inputs in gears.items():
        unshortened = {"tip_alteration": 0.0} if "tip_alteration" in automatic.pick(role) else {}
        try:
            made.append(Gear(**{**inputs, **unshortened}))
        except InputError as error:
            if "profile_shift" not in automatic.pick(role):
                return error.within(role.value)
    try:
        if len(made) == len(Role):
            pinion, wheel = made
            GearPair(pinion=pinion, wheel=wheel, centre_distance=centre_distance)
    except InputError as error:
        if error.parameter == "centre_distance":
            return error
    unit = f" {fault.unit}" if fault.unit else ""
    asked = sum(gears.map(lambda inputs: inputs["profile_shift"]))
    asks = f"asks for x1 + x2 = {asked:.6g} and " if any("profile_shift" in names for names in automatic) else ""
    makes = f"{asks}makes {fault.parameter} = {format_number(fault.value)}{unit}, which {fault.permitted}"
    return GeometryError("centre_distance", centre_distance, makes, "mm")


def _sizes(gears: PerGear[GearInputs]) -> dict[str, Any]:
    """Return the inputs of the formulas for profile shift and centre distance, under their names in GearPair."""
    return {
        "normal_module": module_of(gears.pinion),
        "teeth": gears.map(lambda gear: gear["teeth"]),
        "helix_angle": gears.pinion.get("helix_angle", 0.0),
        "pressure_angle": gears.pinion["rack"].pressure_angle,
    }


def module_of(gear: GearInputs) -> float:
    """Return the normal module, given itself or as a diametral pitch."""
    module: float | None = gear.get("normal_module")
    return module_of_pitch(gear["normal_diametral_pitch"]) if module is None else module


def _mate(gears: PerGear[GearInputs]) -> bool:
    """Return whether both gears have the same module and pressure angle."""
    pinion, wheel = gears.map(lambda gear: (module_of(gear), gear["rack"].pressure_angle))
    return all(abs(one - other) <= _SAME for one, other in zip(pinion, wheel, strict=True))


def require_sound_numbers(gear: GearInputs, owner: str) -> None:
    """Find single values out of range before any formula meets them; what depends on the shift is judged later.

    Raises ParameterError, led by the owner.
    """
    trial = {name: value for name, value in gear.items() if name != "tip_diameter"}
    for automatic in ("profile_shift", "tip_alteration"):
        if trial.get(automatic) in (AUTO, CLEAR):
            del trial[automatic]
    try:
        check_given(GearData(**trial))
    except ParameterError as error:
        raise error.within(owner) from error
    except GeometryError:
        return


def _shared(total: float, gears: PerGear[GearInputs], centre_distance: float, split: ShiftSplit) -> PerGear[float]:
    """Split the shift sum; equal sliding looks at the tips, so their alteration and chamfer count."""
    if split is ShiftSplit.EQUAL_SPECIFIC_SLIDING:
        for role, gear in gears.items():
            if "tip_diameter" in gear:
                permitted = "leaves no equal sliding to find: give the profile shifts, or another profile_shift_split"
                raise GeometryError(f"{role.value}.tip_diameter", gear["tip_diameter"], permitted, "mm")
    altered = resolve_tip_alterations(gears, total, centre_distance)

    def addendum(role: Role) -> float:
        gear = gears.pick(role)
        return float(gear["rack"].addendum + altered.pick(role) - gear["body"].tip_chamfer / module_of(gear))

    addenda = PerGear.each(addendum)
    return split_profile_shift(total, split, **_sizes(gears), centre_distance=centre_distance, addenda=addenda)


def _clearance_keeping(gears: PerGear[GearInputs], shift_sum: float, centre_distance: float | None) -> float:
    """k that keeps the rack's tip clearance at the given, or else the backlash-free, centre distance."""
    sizes = _sizes(gears)
    if gears.wheel["teeth"] < 0:
        return 0.0  # as of PairData.tip_alteration
    module: float = sizes["normal_module"]
    if centre_distance is None:
        try:
            centre_distance = zero_backlash_centre_distance(**sizes, shift_sum=shift_sum)
        except GeometryError:
            return 0.0  # no such centre distance: GearPair says so
    reference: float = module * sum(sizes["teeth"]) / math.cos(math.radians(sizes["helix_angle"])) / 2
    return min((centre_distance - reference) / module - shift_sum, 0.0)


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
"""Texts of table cells for true and false."""

_OWN = ("material", "drawing")
"""Tables of a gear's own, which are read by themselves."""

_TABLES_OF_GEAR: Mapping[str, type[Any] | None] = {**PARTS, **dict.fromkeys(_OWN)}

Simple = TypeVar("Simple")


class Given(NamedTuple):
    """A value, the key under which the user wrote it, and its origin if it was not written."""

    value: Any
    key: str
    note: str = ""


@dataclass(frozen=True)
class Spec:
    """The values of one spec under their dotted keys, and the methods that make inputs of them.

    The values of an owner, such as a gear, are those of the table of its name, unless it is among `names`.
    """

    main: ClassVar[str] = "pair"
    """The table that holds what gears share."""

    values: dict[str, Given]
    where: Where
    names: Mapping[str, str] = dataclasses.field(default_factory=dict)

    @classmethod
    def of(cls, tables: Mapping[str, Any], where: Where) -> Self:
        """Return every value under its dotted key,
        whole numbers turned into floats where floats are meant. Raises SpecError.
        """
        values = {}
        for table, content in tables.items():
            for field, value in entries(content, PARTS_BESIDE.get(table, _TABLES_OF_GEAR)):
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
        """Return the owner and the field that the parameter of an error about `owner` means."""
        if (first := parameter.partition(".")[0]) in _ROLES or (first == "rack" and owner == "pair"):
            owner, _, parameter = parameter.partition(".")
        return owner, parameter

    def _written(self, owner: str, field: str) -> str:
        """Return the key under which the user writes, or would write, a field of an owner."""
        return f"{self.names.get(owner, owner)}.{field}"

    def _words(self, owner: str) -> tuple[str, ...]:
        """Return the owner's words that stand for a profile shift, and for a tip alteration, besides."""
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
        """Return whether an owner's values may stand in the main table too."""
        return owner in _ROLES or (owner == "rack" and any(f"{role}.teeth" in self.values for role in _ROLES))

    def _automatic_cause(self, owner: str, field: str) -> str:
        """Return a reminder that the profile shift of the gear at fault was derived, and from what, where the fault depends on
        it.
        """
        shift = self.values.get(f"{owner}.profile_shift")
        if field == "profile_shift" or field not in OF_SHIFT or shift is None or not shift.note:
            return ""
        return f"; its profile_shift is {round(shift.value, _DIGITS_TOLD) + 0.0:.6g} ({shift.note})"

    def _unwritten(self, owner: str, field: str) -> Given:
        """Return the origin of a value that is not written: a named rack, a derivation, the file's name or a default."""
        named = self.values.get(f"{owner}.rack")
        if named and field.startswith("rack."):
            return named._replace(key=self._written(owner, field), note=f"of {named.value}")
        tool = self.values.get(f"{owner}.tool")
        if tool and field.partition(".")[0] in TOOL_PARTS:
            return tool._replace(key=self._written(owner, field), note=f"of the tool {shown(str(tool.value))}")
        note = "derived" if field in _DERIVED else "from the file's name" if field == "name" else "by default"
        return Given(None, self._written(owner, field), note)

    def name(self, main: str, default: str) -> str:
        """Name of the design: that of its main table, or else of the file."""
        given = self.values.get(f"{main}.name")
        with self.blame(main):
            require_plain_name(default if given is None else given.value)
        return default if given is None else str(given.value)

    def giving_way(self, owner: str) -> set[str]:
        """Return the fields that an owner does not share, because it has them or an alternative to them."""
        given: list[tuple[str, ...]] = [
            each for each in ALTERNATIVES if any(f"{owner}.{field}" in self.values for field in each)
        ]
        if any(key.startswith(f"{owner}.premachining.") for key in self.values):
            given.append(_OTHER_TOOLS)
        if f"{owner}.tool" in self.values:
            given.append(tuple(field for field in SHARED if field.partition(".")[0] in TOOL_PARTS))
        elif any(key.startswith(tuple(f"{owner}.{part}" for part in TOOL_PARTS)) for key in self.values):
            given.append(("tool",))
        return {field for each in given for field in each}

    def fields_of(self, owner: str) -> dict[str, Any]:
        """Return the values of one table, still flat: `rack.root_radius` is one key."""
        return {key[len(owner) + 1 :]: given.value for key, given in self.values.items() if key.startswith(owner + ".")}

    def given_of(self, owner: str) -> dict[str, Given]:
        """Return the values of one table, still flat, with the keys that the user wrote."""
        return {key[len(owner) + 1 :]: given for key, given in self.values.items() if key.startswith(f"{owner}.")}

    def simple(self, owner: str, kind: type[Simple], values: Mapping[str, Any] | None = None) -> Simple:
        """Return the object that a table of plain `values` makes: a Material, a Load, a Mounting, or a job's options.

        Without `values` those of the owner's table are used. Raises SpecError.
        """
        values = self.fields_of(owner) if values is None else values
        with self.blame(owner):
            return kind(**_missing(FIELDS[owner.rpartition(".")[2]]) | _with_parts(values, PARTS_BESIDE.get(owner, {})))

    def gear_inputs(self, owner: str) -> dict[str, Any]:
        """Return keyword arguments of Gear: "auto" is not yet resolved, missing values are None so that Gear reports them."""
        return self._inputs_of(owner, PARTS, GEAR_FIELDS)

    def rack_inputs(self, owner: str) -> dict[str, Any]:
        """Return keyword arguments of Rack; missing values are None."""
        return self._inputs_of(owner, RACK_PARTS, FIELDS["rack"])

    def _inputs_of(self, owner: str, kinds: Mapping[str, type[Any]], fields: Mapping[str, FieldSchema]) -> dict[str, Any]:
        """Return keyword arguments for a type with parts of these kinds and with these fields."""
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
        if "tool" in given and "tool" in fields:
            inputs |= _tool_inputs(given)
        if "rack" in given:
            rack = _named_rack(given["rack"])
            with _within("rack"):
                inputs["rack"] = replace(rack, **parts["rack"])
        for part, kind in kinds.items():
            if part not in inputs:
                with _within(part):
                    inputs[part] = kind(**_with_parts(parts[part], parts_of(kind)))
        _refuse_other_tools(given)
        return inputs


_OTHER_TOOLS = ("rack.dedendum", "rack.root_radius", *(f"cutter.{name}" for name in schema_of(ShaperCutter)))
"""Keys of a tool that makes the whole tooth, which one that cuts before finishing replaces."""


def _refuse_other_tools(given: Mapping[str, Any]) -> None:
    """Raise GeometryError for keys of another tool beside those of one that cuts before finishing."""
    if any(key.startswith("premachining.") for key in given):
        for key in _OTHER_TOOLS:
            if key in given:
                raise GeometryError(key, given[key], "must be left out: the tool of premachining makes the root")


def _tool_inputs(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the tool that a gear names, and the parts that it fills. Raises InputError, also for keys of another tool."""
    name = given["tool"]
    for key, value in given.items():
        if key.partition(".")[0] in TOOL_PARTS:
            raise GeometryError(key, value, f"must be left out: the tool is given (tool = {format_number(name)})")
    tool = find_tool(name, module_given(given.get("normal_module"), given.get("normal_diametral_pitch")))
    assert tool.tool is not None
    return {"tool": tool} | tool.tool.parts


@contextmanager
def _within(part: str) -> Iterator[None]:
    """Let errors about a field of a part say so: `body.bore`."""
    try:
        yield
    except InputError as error:
        raise error.within(part) from error


def _with_parts(values: Mapping[str, Any], kinds: Mapping[str, type[Any]]) -> dict[str, Any]:
    """Return the values of a table, those of its parts made into these; none of those of which nothing is given."""
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


def entries(content: Mapping[str, Any], parts: Mapping[str, type[Any] | None]) -> Iterator[tuple[str, Any]]:
    """Yield the keys and values of one table, those of its parts, such as `rack` and `body`, joined to them with a dot."""
    for field, value in content.items():
        if field in parts and isinstance(value, Mapping):
            kind = parts[field]
            yield from ((f"{field}.{inner}", item) for inner, item in entries(value, parts_of(kind) if kind else {}))
        else:
            yield field, value


def _named_rack(name: Any) -> BasicRack:
    if not isinstance(name, str) or name not in NAMED_RACKS:
        names = ", ".join(repr(known) for known in NAMED_RACKS)
        raise ParameterError("rack", name, f"must be one of {names}, or be described by rack.addendum, rack.dedendum ...")
    return NAMED_RACKS[name]


_OF_PAIR = ("centre_distance", "teeth")
"""Faults of a pair that may come from the shift of its ring."""


@contextmanager
def khk_reminder(role: str, ring: Mapping[str, Any], make: Callable[[Mapping[str, Any]], object]) -> Iterator[None]:
    """Add to a GeometryError that may come from a ring's profile shift that the opposite one would do, where it would.

    `ring` are the inputs of the gear of `role`; `make` raises InputError for those that will not do. Nothing is added where
    the gear is no ring or its shift no number.
    """
    try:
        yield
    except GeometryError as error:
        shift, teeth = ring.get("profile_shift"), ring["teeth"]
        field = error.parameter.removeprefix(f"{role}." if role else "")
        if not isinstance(shift, float) or shift == 0 or teeth >= 0 or field not in (*OF_SHIFT, *_OF_PAIR):
            raise
        try:
            make({**ring, "profile_shift": -shift})
        except InputError:
            raise error from None
        key = f"{role}.profile_shift" if role else "profile_shift"
        reminder = f"; is the profile shift in KHK's sign? then write {key} = {format_number(-shift)}"
        raise GeometryError(error.parameter, error.value, error.permitted + reminder, error.unit) from error


_DRAWINGS_TABLE = ".drawing."


def drawings_of(spec: Spec) -> dict[str, PartDrawing]:
    """Return the drawing options that gears have of their own, by their tables. Raises SpecError."""
    owners = dict.fromkeys(key.partition(_DRAWINGS_TABLE)[0] for key in spec.values if _DRAWINGS_TABLE in key)
    if not owners:
        return {}
    from gearcad.drawing.options import PartDrawing

    return {owner: spec.simple(f"{owner}.drawing", PartDrawing) for owner in owners}


def drawing_documents(drawing: DrawingOptions | None, drawings: Mapping[str, PartDrawing]) -> dict[str, Any]:
    """Return the entries of a document about drawings; empty if no options are given.

    A template is given by its file name alone.
    """
    found: dict[str, Any] = {}
    if drawing is not None:
        template = Path(drawing.template).name if drawing.template else None
        found["drawing"] = asdict(drawing) | {"template": template}
    if drawings:
        given = {name: asdict(part).items() for name, part in drawings.items()}
        found["drawings"] = {name: {key: value for key, value in own if value is not None} for name, own in given.items()}
    return found


_TABLE = "material"


def materials_of(spec: Spec, gears: Sequence[str]) -> Material | dict[str, Material] | None:
    """Return the material of all gears, or one for each gear if any has its own, or None if none is given. Raises SpecError.

    A value in a gear's own table counts before its name in [material], and that before the rest of [material]. A name such as
    "Eh MQ" replaces group and quality, and a group or a quality replaces such a name.
    """
    common = _common(spec, gears)
    own = {gear: _own(spec, gear) for gear in gears}
    if not any(own.values()):
        return common_material(spec, gears) if common else None
    return {gear: _gear_material(spec, gear, _merged(common, layers)) for gear, layers in own.items()}


def common_material(spec: Spec, gears: Sequence[str]) -> Material:
    """Return the material of the gears that have none of their own. Raises SpecError."""
    values = {key: given.value for key, given in _common(spec, gears).items()}
    return spec.simple(_TABLE, Material, values=values)


def _common(spec: Spec, gears: Sequence[str]) -> dict[str, Given]:
    """Return the values of [material] that apply to all gears, by key. Raises SpecError."""
    common = {key: given for key, given in spec.given_of(_TABLE).items() if key not in gears}
    for key in common.keys() - schema_of(Material).keys():
        full = f"{_TABLE}.{key}"
        there = f"those here are {' and '.join(gears)}" if gears else "here it is that of [material]: write name"
        raise SpecError(f"{spec.where(full)}: {full}: is the material of one gear among several; {there}", full)
    return common


def _own(spec: Spec, gear: str) -> list[Mapping[str, Given]]:
    """Return the values that a spec gives for the material of one gear, in layers; the last counts most. Raises SpecError."""
    layers: list[Mapping[str, Given]] = []
    if (named := spec.values.get(f"{_TABLE}.{gear}")) is not None:
        if not isinstance(named.value, str) or grade_of(named.value) is None:
            raise SpecError(f"{spec.where(named.key)}: {named.key} = {format_number(named.value)}: {_permitted()}", named.key)
        layers.append({"name": named})
    if table := spec.given_of(f"{gear}.{_TABLE}"):
        layers.append(table)
    return layers


def _permitted() -> str:
    groups = ", ".join(group.value for group in GRADED_GROUPS)
    qualities = ", ".join(quality.value for quality in MaterialQuality)
    return f'must be a group and a quality of ISO 6336-5, such as "Eh MQ": {groups}; {qualities}'


def _merged(common: Mapping[str, Given], layers: Sequence[Mapping[str, Given]]) -> dict[str, Given]:
    """Return the values of all layers, each in place of those before it."""
    merged = dict(common)
    for layer in layers:
        if "name" in layer and _grade(layer["name"]) is not None:
            merged = {key: given for key, given in merged.items() if key not in Grade._fields}
        elif not layer.keys().isdisjoint(Grade._fields) and (grade := _grade(name := merged.get("name"))) and name:
            del merged["name"]
            merged |= {key: name._replace(value=value) for key, value in grade._asdict().items()}
        merged |= layer
    return merged


def _grade(name: Given | None) -> Grade | None:
    return grade_of(name.value) if name is not None and isinstance(name.value, str) else None


def _gear_material(spec: Spec, gear: str, values: Mapping[str, Given]) -> Material:
    """Return the material of a gear. Errors name the key that the user wrote."""
    for key, given in values.items():
        spec.values[f"{gear}.{_TABLE}.{key}"] = given
    return spec.simple(f"{gear}.{_TABLE}", Material, values={key: given.value for key, given in values.items()})
