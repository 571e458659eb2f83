"""A single gear: `[gear]`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Self

from gearcad.designs.auto import AUTO
from gearcad.designs.design import DesignKind
from gearcad.designs.files import Where
from gearcad.designs.khk import khk_reminder
from gearcad.designs.kinds.geared import GearedDesign
from gearcad.designs.kinds.toothed import beside_teeth
from gearcad.errors import GeometryError
from gearcad.geometry import Gear
from gearcad.material import Material

__all__ = ["GearDesign"]


@dataclass(frozen=True, kw_only=True)
class GearDesign(GearedDesign):
    """A single gear, and what later stages need."""

    kind: ClassVar[DesignKind] = DesignKind.GEAR

    gear: Gear
    material: Material | None = None

    @classmethod
    def read(cls, tables: Mapping[str, Any], where: Where, default_name: str) -> Self:
        """That of [gear]. Raises SpecError."""
        spec = cls.spec(tables, where)
        beside = beside_teeth(spec, tables)
        name = spec.name("gear", default_name)
        with spec.blame("gear"):
            inputs = spec.gear_inputs("gear")
            for key in ("profile_shift", "tip_alteration"):
                if inputs.get(key) == AUTO:
                    raise GeometryError(key, AUTO, "must be a number: only the gears of a pair know what to derive it from")
            with khk_reminder("", inputs, lambda other: Gear(**other)):
                gear = Gear(**inputs | {"name": name})
            return cls(name=name, gear=gear, **beside)

    @property
    def gears(self) -> dict[str, Gear]:
        """The one gear."""
        return {"gear": self.gear}
