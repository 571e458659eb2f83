"""Designs of pairs: `[pair]` with `[pinion]` and `[wheel]`, or with `[pinion]` and `[rack]`.

Values that both parts share may stand in `[pair]`. A part's own value wins. A wheel or rack takes the opposite hand, a ring the
same hand.
"""

from __future__ import annotations

import itertools
import math
from bisect import bisect_left
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, ClassVar, Self

from gearcad.core.errors import GeometryError, InputError, ParameterError, SpecError, as_choice, require_number
from gearcad.core.quantities import NOT_GIVEN, is_given, schema_of
from gearcad.core.records import JsonObject, Notice, PerGear, Role, naming
from gearcad.designs.design import Described, Where
from gearcad.designs.gear_designs import GearedDesign, ToothedDesign, beside_teeth, require_tables, require_tables_of_racks
from gearcad.designs.keys import (
    FIELDS,
    MAIN_TABLES,
    OF_GEAR_PAIRS,
    OF_RACK_PAIRS,
    RIGID_SHAFTS,
    SHARED,
    DesignKind,
    has_shafts,
    without_shafts,
)
from gearcad.designs.spec import (
    AUTO,
    CLEAR,
    Given,
    Spec,
    clear_tip_alteration,
    khk_reminder,
    make_gears,
    module_of,
    resolve_profile_shifts,
    resolve_tip_alterations,
)
from gearcad.geometry import Gear, GearPair, Rack, RackPair, ShaperCutter, ShiftSplit
from gearcad.geometry.mating import check_ring, wrong_side
from gearcad.load import Load
from gearcad.material import Material, Materials, of_both
from gearcad.rating.options import RatingOptions

if TYPE_CHECKING:
    from gearcad.check.options import CheckOptions
    from gearcad.check.task import CheckTask
    from gearcad.designs.shaft_spec import PairShafts, ShaftArrangement
    from gearcad.dynamics.options import DynamicsOptions
    from gearcad.meshing.options import MeshOptions
    from gearcad.rating.load_factors import FaceLoadSource


@dataclass(frozen=True, kw_only=True)
class PairDesign(GearedDesign):
    """A pair of gears, with the inputs that later stages need; `material` is that of both gears, or one for each."""

    kind: ClassVar[DesignKind] = DesignKind.PAIR

    pair: GearPair
    material: Materials | None = None
    shafts: PairShafts | None = None
    """Shafts of its gears, which `gearcad shafts` and `gearcad check --model 3d` take into account."""

    @classmethod
    def read(cls, tables: Mapping[str, Any], where: Where, default_name: str) -> Self:
        """Return the design that [pair], [pinion] and [wheel] describe. Raises SpecError."""
        spec, teeth = cls.spec(tables, where), without_shafts(tables)
        beside = beside_teeth(spec, teeth, PerGear._fields)
        name = spec.name("pair", default_name)
        pair = spec.pair(name)
        if has_shafts(tables):
            from gearcad.designs.shaft_spec import read_pair_shafts  # which few specs need

            beside["shafts"] = read_pair_shafts(tables, pair, where)
        with spec.blame("pair"):
            return cls(name=name, pair=pair, **beside)

    @cached_property
    def arrangement(self) -> ShaftArrangement | None:
        """Shafts of its gears with stations and speeds, with their mesh if there is a load; None without shafts."""
        if self.shafts is None:
            return None
        from gearcad.designs.shaft_spec import pair_arrangement

        found = pair_arrangement(self.shafts, self.pair, self.load, self.materials, mounting=self.mounting, rating=self.rating)
        return replace(found, name=self.name)

    @property
    def face_load(self) -> FaceLoadSource | None:
        """The function by which a rating finds the load over the face on the shafts; None without shafts."""
        if self.arrangement is None or self.arrangement.mesh is None:
            return None
        from gearcad.designs.shaft_spec import face_load_of

        return face_load_of(self.arrangement.mesh, 0.0 if self.mounting is None else self.mounting.misalignment)

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices of gears and pair, and where shafts are taken into account."""
        if self.shafts is None:
            return super().notices
        text = (
            'shafts count in `gearcad shafts`, `gearcad check --model 3d` and by face_load_factor = "shafts"; elsewhere the '
            "gears are held on rigid ones"
        )
        return (*super().notices, Notice(RIGID_SHAFTS, text))

    @classmethod
    def spec(cls, tables: Mapping[str, Any], where: Where) -> PairSpec:
        """Return the values of a spec that has all tables of a pair, without those of shafts. Raises SpecError."""
        tables = without_shafts(tables)
        require_tables(tables, where)
        _require_pair(tables, where)
        spec = PairSpec.of(tables, where)
        if (key := f"pair.{OF_RACK_PAIRS[0]}") in spec.values:
            raise SpecError(f"{where(key)}: {key}: applies to a pinion and a [rack]; did you mean centre_distance?", key)
        return spec

    @property
    def materials(self) -> PerGear[Material]:
        """Materials of both gears; steel if none is given."""
        return of_both(self.material or Material())

    @property
    def made_of(self) -> tuple[str, ...]:
        return PerGear._fields

    @property
    def gears(self) -> dict[str, Gear]:
        """Pinion and wheel."""
        return {role.value: gear for role, gear in self.pair.gears.items()}

    @property
    def assembly(self) -> GearPair:
        """The pair in mesh."""
        return self.pair

    @property
    def described(self) -> Mapping[str, Described]:
        """The gears, and the pair that they make."""
        return {**self.gears, "pair": self.pair}

    def to_dict(self) -> JsonObject:
        """Return the document of `data.json`, with the sizes of the shafts if there are any."""
        document = super().to_dict()
        if self.shafts is None:
            return document
        sizes = {
            role.value: {"mesh_position": own.mesh_position} | own.shaft.sizes() for role, own in self.shafts.mounted.items()
        }
        return document | {"shafts": sizes}

    def loaded(self, why: str) -> Load:
        """Return the load. Raises ParameterError if there is none; the message ends with `why` it is needed."""
        if self.load is None:
            raise ParameterError("load.torque", None, f"must be given, in N·m on the pinion: {why}")
        return self.load

    def check_task(self, why: str, options: CheckOptions | None = None) -> CheckTask:
        """Return the task of a check of the pair in its mounting, with its own options where none are given.

        Raises ParameterError if there is no load; the message ends with `why` it is needed. Raises ParameterError and
        GeometryError for a pair or a load that cannot be checked.
        """
        from gearcad.check.task import check_task

        material, load = self.material or Material(), self.loaded(why)
        shafts = None if self.arrangement is None else self.arrangement.mesh
        return check_task(self.pair, material, load, options or self.check, self.mounting, self.rating, self.face_load, shafts)


def _require_pair(tables: Mapping[str, Any], where: Where) -> None:
    """Raise SpecError unless all tables of a pair are there."""
    needed = MAIN_TABLES[DesignKind.PAIR]
    if not any(table in tables for table in needed):
        raise SpecError(f"{where('')}: makes nothing yet: must have [gear], or [pair] with [pinion] and [wheel]")
    for table in needed:
        if table not in tables:
            raise SpecError(f"{where('')}: [{table}] is missing: a pair needs [pair], [pinion] and [wheel]")


_ROUNDING = 1e-9
"""Change of a tip alteration, in normal modules, that is rounding."""

_MORE_TEETH = (1, 2, 4, 8, 16, 32, 64, 128)
"""Numbers of teeth beyond the pinion's that are tried for a ring, each twice the last, before those between."""

_OPPOSED = ("helix_angle", "double_helix.offset")
"""Fields of a gear that its mate has with the opposite sign, and a ring with the same."""


class PairSpec(Spec):
    """The values of a pair's spec, and the methods that make its gears from them."""

    def pair(self, name: str) -> GearPair:
        """Return the pair of `[pair]`, `[pinion]` and `[wheel]`, with every "auto" resolved."""
        self._share_values()
        self._match_helix()
        inputs = PerGear(*map(self._inputs, Role))
        with self.blame("pair"):
            self._check_teeth(name, inputs)
            self._check_words(inputs)
            with khk_reminder("wheel", inputs.wheel, partial(self._tried, name, inputs)):
                return self._made(name, inputs)

    def _made(self, name: str, inputs: PerGear[dict[str, Any]]) -> GearPair:
        """Return the pair, with every "auto" resolved. Raises InputError."""
        given = self._pair_inputs()
        split = given.pop("profile_shift_split", None)
        distance = given.get("centre_distance")
        resolved = self._resolve_auto(inputs, distance, split)
        gears = self._gears(resolved, given)
        return self._cleared(GearPair(pinion=gears.pinion, wheel=gears.wheel, **given | {"name": name}))

    def _gears(self, resolved: PerGear[dict[str, Any]], given: Mapping[str, Any]) -> PerGear[Gear]:
        """Return both gears. The message for a ring whose cutter cannot make its tip also says what the pair requires. Raises
        InputError.
        """
        automatic, distance = PerGear.each(self._automatic), given.get("centre_distance")
        try:
            return make_gears(resolved, automatic, distance)
        except GeometryError as error:
            if error.parameter != "wheel.tip_diameter" or resolved.wheel["cutter"].teeth is None:
                raise
            try:
                gears = make_gears(resolved._replace(wheel={**resolved.wheel, "cutter": ShaperCutter()}), automatic, distance)
                GearPair(pinion=gears.pinion, wheel=gears.wheel, **given)
            except GeometryError as other:
                if other.parameter in ("wheel.tip_diameter", "wheel.teeth") and other.permitted != error.permitted:
                    besides = f"; whatever the cutter, {other.parameter} {other.permitted}"
                    raise GeometryError(error.parameter, error.value, error.permitted + besides, error.unit) from error
            raise

    def _tried(self, name: str, inputs: PerGear[dict[str, Any]], wheel: Mapping[str, Any]) -> GearPair:
        """Return the pair with another wheel, without a trace among the values. Raises InputError."""
        return replace(self, values=dict(self.values))._made(name, inputs._replace(wheel=dict(wheel)))

    @property
    def _ring(self) -> bool:
        """Whether the wheel is a ring."""
        teeth = self.values.get("wheel.teeth")
        return teeth is not None and isinstance(teeth.value, int) and teeth.value < 0

    def _check_teeth(self, name: str, inputs: PerGear[dict[str, Any]]) -> None:
        """The numbers of teeth by themselves, and which gear may be a ring; of how many teeth is added where that is found."""
        if (count := schema_of(Gear)["teeth"].permitted) is not None:
            inputs.map(lambda gear: count.require("teeth", gear["teeth"]))
        try:
            check_ring(inputs.map(lambda gear: gear["teeth"]))
        except GeometryError as error:
            if error.parameter != "wheel.teeth" or (fewest := self._fewest_teeth(name, inputs)) is None:
                raise
            permitted = f"{error.permitted}; with the other numbers as they are at most {-fewest}"
            raise GeometryError(error.parameter, error.value, permitted) from error

    def _fewest_teeth(self, name: str, inputs: PerGear[dict[str, Any]]) -> int | None:
        """Return the fewest ring teeth that fit the pinion with all other inputs unchanged, or None if none was found."""
        pinion: int = inputs.pinion["teeth"]

        def makes(more: int) -> bool:
            try:
                self._tried(name, inputs, {**inputs.wheel, "teeth": -pinion - more})
            except InputError:
                return False
            return True

        enough = next(filter(makes, _MORE_TEETH), None)
        if enough is None:
            return None
        fewer = range(enough // 2 + 1, enough)
        return pinion + enough // 2 + 1 + bisect_left(fewer, True, key=makes)

    def _check_words(self, inputs: PerGear[dict[str, Any]]) -> None:
        """Raise SpecError if "clear" is given for a gear other than a ring."""
        for role, gear in inputs.items():
            if gear.get("tip_alteration") != CLEAR:
                continue
            if role is Role.PINION or not self._ring:
                permitted = f'must be a number, or "{AUTO}": "{CLEAR}" is for the ring of an internal pair'
                raise GeometryError(f"{role.value}.tip_alteration", CLEAR, permitted)
            if "tip_diameter" in gear:
                permitted = f'must be left out, or tip_alteration not be "{CLEAR}"'
                raise GeometryError("wheel.tip_diameter", gear["tip_diameter"], permitted, "mm")

    def _inputs(self, role: Role) -> dict[str, Any]:
        """Return the inputs of a gear as written; its name is its role unless the spec gives one. Raises SpecError."""
        with self.blame(role.value):
            return {"name": role.value} | self.gear_inputs(role.value)

    def _automatic(self, role: Role) -> list[str]:
        """Return the fields of a gear that stood as "auto"."""
        values = {field: self.values.get(f"{role.value}.{field}") for field in ("profile_shift", "tip_alteration")}
        return [field for field, given in values.items() if given is not None and given.note.startswith(AUTO)]

    def _pair_inputs(self) -> dict[str, Any]:
        given = {key: value for key, value in self.fields_of("pair").items() if key not in SHARED}
        if "centre_distance" in given:
            require_number("centre_distance", distance := given["centre_distance"], "mm")
            if distance == 0:
                raise wrong_side(distance, ring=self._ring)
            if (distance < 0) is not self._ring:
                raise GeometryError("centre_distance", distance, wrong_side(distance, ring=self._ring).permitted, "mm")
        if "profile_shift_split" in given:
            given["profile_shift_split"] = as_choice("profile_shift_split", given["profile_shift_split"], ShiftSplit)
        return given

    def _share_values(self) -> None:
        """Give both gears what stands in [pair], unless they have their own; what is opposed is the pinion's."""
        for role in Role:
            renamed = f"{role.value}.rack" in self.values
            giving_way = self.giving_way(role.value)
            for field in SHARED:
                given = self.values.get(f"pair.{field}")
                if given is None or (field in _OPPOSED and role is Role.WHEEL) or field in giving_way:
                    continue
                if not (renamed and field.startswith("rack")):
                    self.values.setdefault(f"{role.value}.{field}", given)

    def _match_helix(self) -> None:
        """The gear without a helix angle, or offset of its halves, takes the mate's: opposed, or the same in a ring."""
        for role, field in itertools.product((Role.WHEEL, Role.PINION), _OPPOSED):
            own, given = f"{role.value}.{field}", self.values.get(f"{role.mate.value}.{field}")
            if given is None or own in self.values:
                continue
            opposed = isinstance(given.value, float) and not self._ring
            self.values[own] = given._replace(value=0.0 - given.value) if opposed else given

    def _resolve_auto(
        self, inputs: PerGear[dict[str, Any]], distance: float | None, split: ShiftSplit | None
    ) -> PerGear[dict[str, Any]]:
        """Return the inputs with each "auto" replaced, which is noted among the values."""
        shifts = resolve_profile_shifts(inputs, distance, split)
        alterations = resolve_tip_alterations(inputs, sum(shifts), distance)
        asked = "" if distance is None else f": centre distance {distance:g} mm asks for x1 + x2 = {sum(shifts):.6g}"

        def resolved(role: Role) -> dict[str, Any]:
            found = {"profile_shift": shifts.pick(role), "tip_alteration": alterations.pick(role)}
            written = {"profile_shift": 0.0, "tip_alteration": AUTO} | inputs.pick(role)
            for field, note in (("profile_shift", AUTO + asked), ("tip_alteration", AUTO)):
                if written[field] == AUTO:
                    self._note(f"{role.value}.{field}", found[field], note)
            return inputs.pick(role) | found

        gears = PerGear.each(resolved)
        if inputs.wheel.get("tip_alteration") == CLEAR:
            gears.wheel["tip_alteration"] = clear_tip_alteration(gears, distance)
            self._note("wheel.tip_alteration", gears.wheel["tip_alteration"], CLEAR)
        return gears

    def _note(self, key: str, value: float, note: str) -> None:
        """Record what the words "auto" and "clear" stand for among the values."""
        self.values[key] = Given(value, self.values.get(key, Given(AUTO, key)).key, note)

    def _cleared(self, pair: GearPair) -> GearPair:
        """Return the pair. If the ring's tip is to be clear and still cuts the pinion's fillet, the tip is drawn in further."""
        given, tip = self.values.get("wheel.tip_alteration"), pair.wheel.tip_diameter
        if given is None or given.note != CLEAR or (clear := pair.clear_tip_diameter) is None:
            return pair
        change = (clear - tip) / (2 * pair.wheel.normal_module)
        if change >= -_ROUNDING:
            return pair
        self._note("wheel.tip_alteration", given.value + change, CLEAR)
        return replace(pair, wheel=replace(pair.wheel, tip_alteration=given.value + change))


_BESIDE = ("material", "load", "check", "mesh", "dynamics", "rating", "drawing", "verify")
_GEARS = ("pinion", "rack")


@dataclass(frozen=True, kw_only=True)
class RackPairDesign(ToothedDesign):
    """A pinion and a rack, with the inputs that later stages need."""

    kind: ClassVar[DesignKind] = DesignKind.RACK_PAIR
    elsewhere: ClassVar[str] = (
        "a pinion and a rack are for `gearcad data`, build, draw, mesh, check, rate, stiffness, dynamics and verify"
    )

    pair: RackPair
    material: Materials | None = None
    load: Load | None = None
    check: CheckOptions | None = None
    mesh: MeshOptions | None = None
    dynamics: DynamicsOptions | None = None
    rating: RatingOptions | None = None

    @classmethod
    def read(cls, tables: Mapping[str, Any], where: Where, default_name: str) -> Self:
        """Return the design that [pair], [pinion] and [rack] describe. Raises SpecError."""
        spec = cls.spec(tables, where)
        beside = beside_teeth(spec, tables, _GEARS)
        name = spec.name("pair", default_name)
        pair = spec.pair(name)
        with spec.blame("pair"):
            return cls(name=name, pair=pair, **beside)

    @classmethod
    def spec(cls, tables: Mapping[str, Any], where: Where) -> _RackPairSpec:
        """Return the values of a spec that has all tables of a pinion and a rack. Raises SpecError."""
        require_tables_of_racks(tables, where, DesignKind.RACK_PAIR, _BESIDE)
        for table in MAIN_TABLES[DesignKind.RACK_PAIR]:
            if table not in tables:
                raise SpecError(f"{where('')}: [{table}] is missing: a pinion and a rack need [pair], [pinion] and [rack]")
        spec = _RackPairSpec.of(tables, where)
        for key in OF_GEAR_PAIRS:
            if f"pair.{key}" in spec.values:
                wanted, full = "; did you mean mounting_distance?" if key == "centre_distance" else "", f"pair.{key}"
                raise SpecError(f"{where(full)}: {full}: applies to two gears, not to a pinion and a rack{wanted}", full)
        return spec

    @property
    def materials(self) -> PerGear[Material]:
        """Materials of pinion and rack; steel if none is given."""
        return of_both(self.material or Material())

    @property
    def made_of(self) -> tuple[str, ...]:
        return _GEARS

    @property
    def gears(self) -> dict[str, Gear]:
        """The pinion."""
        return {"pinion": self.pair.pinion}

    @property
    def assembly(self) -> RackPair:
        """The pair in mesh."""
        return self.pair

    @property
    def described(self) -> Mapping[str, Described]:
        """Pinion and rack, and the pair that they make."""
        return {"pinion": self.pair.pinion, "rack": self.pair.rack, "pair": self.pair}

    def to_dict(self) -> JsonObject:
        """Return the document of `data.json`; what a load comes to on the rack is "drive" there."""
        document = super().to_dict()
        if self.load is None:
            return document
        drive = {"rack_force": self.pair.rack_force(self.load.torque)}
        if self.load.speed:
            drive["rack_speed"] = self.pair.rack_speed(self.load.speed)
        return document | {"drive": drive}

    def loaded(self, why: str) -> Load:
        """Return the load. Raises ParameterError if there is none; the message ends with `why` it is needed."""
        if self.load is None:
            raise ParameterError("load.torque", None, f"must be given, in N·m on the pinion: {why}")
        return self.load

    def check_task(self, why: str, options: CheckOptions | None = None) -> CheckTask:
        """Return the task of a check of the pair, as that of a `PairDesign`, but without mounting and shafts."""
        from gearcad.check.task import check_task

        material, load = self.material or Material(), self.loaded(why)
        return check_task(self.pair, material, load, options or self.check, rating=self.rating)


class _RackPairSpec(Spec):
    """The values of the spec of a pinion and a rack, and the methods that make both from them."""

    def pair(self, name: str) -> RackPair:
        """Return the pair of `[pair]`, `[pinion]` and `[rack]`, with every "auto" resolved."""
        self._share_values()
        with self.blame("rack"):
            rack = Rack(**{"name": "rack"} | self.rack_inputs("rack"))
        with self.blame("pinion"):
            inputs = {"name": "pinion"} | self.gear_inputs("pinion")
        distance = self.fields_of("pair").get("mounting_distance", NOT_GIVEN)
        with self.blame("pair"):
            with naming(Role.PINION):
                pinion = Gear(**inputs | self._automatic(inputs, distance))
            return RackPair(pinion=pinion, rack=rack, name=name, mounting_distance=distance)

    def _share_values(self) -> None:
        """Give both what stands in [pair], unless they have their own; one without a helix angle takes the mate's, opposed."""
        for owner in ("pinion", "rack"):
            renamed = f"{owner}.rack" in self.values
            giving_way = self.giving_way(owner)
            for field in SHARED:
                given = self.values.get(f"pair.{field}")
                if given is None or field not in FIELDS[owner] or (field == "helix_angle" and owner == "rack"):
                    continue
                if field in giving_way:
                    continue
                if not (renamed and field.startswith("rack")):
                    self.values.setdefault(f"{owner}.{field}", given)
        for owner, mate in (("rack", "pinion"), ("pinion", "rack")):
            own, given = f"{owner}.helix_angle", self.values.get(f"{mate}.helix_angle")
            if given is not None and own not in self.values:
                self.values[own] = given._replace(value=0.0 - given.value if isinstance(given.value, float) else given.value)

    def _automatic(self, inputs: dict[str, Any], distance: Any) -> dict[str, float]:
        """Return the value of each pinion field that stands as "auto": profile shift and tip alteration (in modules).

        Both follow from the mounting distance (mm). Raises GeometryError for an automatic shift without one.
        """
        defaults = {"profile_shift": 0.0, "tip_alteration": AUTO}
        asked = [field for field, default in defaults.items() if inputs.get(field, default) == AUTO]
        with suppress(GeometryError):  # single numbers out of range first; what depends on the shift is judged later
            Gear(**inputs | dict.fromkeys(asked, 0.0))
        if not (isinstance(distance, float) and is_given(distance)):
            if "profile_shift" in asked:
                raise GeometryError("profile_shift", AUTO, "needs mounting_distance in [pair]")
            return dict.fromkeys(asked, 0.0)
        m, helix = module_of(inputs), math.radians(inputs.get("helix_angle", 0.0))
        beyond = distance / m - inputs["teeth"] / math.cos(helix) / 2
        shift = beyond if "profile_shift" in asked else inputs.get("profile_shift", 0.0)
        kept = 0.0 if "tip_diameter" in inputs else min(beyond - shift, 0.0)
        notes = {"profile_shift": f"{AUTO}: mounting distance {distance:g} mm asks for it", "tip_alteration": AUTO}
        found = {field: value for field, value in (("profile_shift", shift), ("tip_alteration", kept)) if field in asked}
        for field, value in found.items():
            key = f"pinion.{field}"
            self.values[key] = Given(value, self.values.get(key, Given(AUTO, key)).key, notes[field])
        return found
