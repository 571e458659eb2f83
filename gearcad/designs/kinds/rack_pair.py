"""A pinion and a rack: `[pair]`, `[pinion]` and `[rack]`.

What both share may stand in `[pair]`; one's own value wins, and the rack takes the opposite hand.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, ClassVar, Self

from gearcad.designs.auto import AUTO, module_of
from gearcad.designs.design import Described, DesignKind
from gearcad.designs.files import Where
from gearcad.designs.keys import FIELDS, MAIN_TABLES, OF_GEAR_PAIRS, SHARED
from gearcad.designs.kinds.rack import require_tables_of_racks
from gearcad.designs.kinds.toothed import ToothedDesign, beside_teeth
from gearcad.designs.spec import Given, Spec
from gearcad.errors import GeometryError, ParameterError, SpecError
from gearcad.geometry import Gear, Rack, RackPair
from gearcad.geometry.derived import NOT_GIVEN, is_given
from gearcad.load import Load
from gearcad.material import Material, Materials, of_both
from gearcad.per_gear import PerGear, Role, naming
from gearcad.rating.options import RatingOptions

__all__ = ["RackPairDesign"]

_BESIDE = ("material", "load", "rating", "drawing")
_GEARS = ("pinion", "rack")


@dataclass(frozen=True, kw_only=True)
class RackPairDesign(ToothedDesign):
    """A pinion and a rack, and what later stages need."""

    kind: ClassVar[DesignKind] = DesignKind.RACK_PAIR
    elsewhere: ClassVar[str] = (
        "finite elements, stiffness and dynamics know gears only; a pinion and a rack have `gearcad data`, `gearcad build`,"
        " `gearcad draw` and `gearcad rate`"
    )

    pair: RackPair
    material: Materials | None = None
    load: Load | None = None
    rating: RatingOptions | None = None

    @classmethod
    def read(cls, tables: Mapping[str, Any], where: Where, default_name: str) -> Self:
        """That of [pair], [pinion] and [rack]. Raises SpecError."""
        spec = cls.spec(tables, where)
        beside = beside_teeth(spec, tables, _GEARS)
        name = spec.name("pair", default_name)
        pair = spec.pair(name)
        with spec.blame("pair"):
            return cls(name=name, pair=pair, **beside)

    @classmethod
    def spec(cls, tables: Mapping[str, Any], where: Where) -> _RackPairSpec:
        """The values of a spec that has all tables of a pinion and a rack. Raises SpecError."""
        require_tables_of_racks(tables, where, DesignKind.RACK_PAIR, _BESIDE)
        for table in MAIN_TABLES[DesignKind.RACK_PAIR]:
            if table not in tables:
                raise SpecError(f"{where('')}: [{table}] is missing: a pinion and a rack need [pair], [pinion] and [rack]")
        spec = _RackPairSpec.of(tables, where)
        for key in OF_GEAR_PAIRS:
            if f"pair.{key}" in spec.values:
                wanted, full = "; did you mean mounting_distance?" if key == "centre_distance" else "", f"pair.{key}"
                raise SpecError(f"{where(full)}: {full}: is of two gears, not of a pinion and a rack{wanted}", full)
        return spec

    @property
    def materials(self) -> PerGear[Material]:
        """Those of pinion and rack; steel where nothing is said."""
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
        """The pair."""
        return self.pair

    @property
    def described(self) -> Mapping[str, Described]:
        """Pinion and rack, and the pair that they make."""
        return {"pinion": self.pair.pinion, "rack": self.pair.rack, "pair": self.pair}

    def to_dict(self) -> dict[str, Any]:
        """The document of `data.json`; what a load comes to on the rack is "drive" there."""
        document = super().to_dict()
        if self.load is None:
            return document
        drive = {"rack_force": self.pair.rack_force(self.load.torque)}
        if self.load.speed:
            drive["rack_speed"] = self.pair.rack_speed(self.load.speed)
        return document | {"drive": drive}

    def loaded(self, why: str) -> Load:
        """Its load. Raises ParameterError where there is none, that ends with why it is needed."""
        if self.load is None:
            raise ParameterError("load.torque", None, f"must be given, in N·m on the pinion: {why}")
        return self.load


class _RackPairSpec(Spec):
    """The values of the spec of a pinion and a rack, and how these come to theirs."""

    def pair(self, name: str) -> RackPair:
        """The pair of `[pair]`, `[pinion]` and `[rack]`, with every "auto" resolved."""
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
        """What each "auto" of the pinion comes to: profile shift and tip alteration that the mounting distance asks for."""
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
