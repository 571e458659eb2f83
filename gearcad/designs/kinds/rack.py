"""A rack by itself: `[rack]`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Self

from gearcad.designs.design import Described, DesignKind
from gearcad.designs.files import Where
from gearcad.designs.keys import MAIN_TABLES
from gearcad.designs.kinds.toothed import ToothedDesign, beside_teeth, require_known_tables
from gearcad.designs.spec import Spec
from gearcad.errors import SpecError
from gearcad.geometry import Rack
from gearcad.material import Material

__all__ = ["RackDesign", "require_tables_of_racks"]


@dataclass(frozen=True, kw_only=True)
class RackDesign(ToothedDesign):
    """A rack, and its material."""

    kind: ClassVar[DesignKind] = DesignKind.RACK
    elsewhere: ClassVar[str] = "a rack by itself is for `gearcad data`, `gearcad build` and `gearcad draw`"

    rack: Rack
    material: Material | None = None

    @classmethod
    def read(cls, tables: Mapping[str, Any], where: Where, default_name: str) -> Self:
        """That of [rack]. Raises SpecError."""
        spec = cls.spec(tables, where)
        beside = beside_teeth(spec, tables)
        if own := spec.given_of("rack.material"):
            key = next(iter(own.values())).key
            raise SpecError(f"{where(key)}: {key}: is of a rack that has a pinion: write it in [material]", key)
        name = spec.name("rack", default_name)
        with spec.blame("rack"):
            return cls(name=name, rack=Rack(**spec.rack_inputs("rack") | {"name": name}), **beside)

    @classmethod
    def spec(cls, tables: Mapping[str, Any], where: Where) -> Spec:
        """The values of a spec of [rack], [material] and [drawing]. Raises SpecError."""
        require_tables_of_racks(tables, where, DesignKind.RACK, ("material", "drawing"))
        return Spec.of(tables, where)

    @property
    def described(self) -> Mapping[str, Described]:
        """The one rack."""
        return {"rack": self.rack}


def require_tables_of_racks(tables: Mapping[str, Any], where: Where, kind: DesignKind, beside: tuple[str, ...]) -> None:
    """Raise SpecError unless all tables are those of the kind, or of these beside it."""
    require_known_tables(tables, where)
    for table in tables:
        if table not in (*MAIN_TABLES[kind], *beside):
            others = ", ".join(f"[{name}]" for name in beside)
            with_whom = "[rack]" if kind is DesignKind.RACK else "a pinion and a [rack]"
            raise SpecError(f"{where(table)}: [{table}] cannot stand beside {with_whom}: permitted are {others}")
