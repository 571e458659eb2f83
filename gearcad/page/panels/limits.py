"""Panel of the limits of profile shifts: a map in which the user moves the design, with sliders beside it."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from gearcad.core.records import Role
from gearcad.designs.design import Design
from gearcad.page.components.elements import LimitsView
from gearcad.page.fields import LimitMap, Variable, limit_map
from gearcad.page.panels import Panel
from gearcad.page.words import PageWords
from gearcad.page.workbench import Workbench
from gearcad.sizing.geometry import Free, Limit, LimitKind

__all__ = ["LimitsPanel"]

_LINES = {
    LimitKind.UNDERCUT: (0.0,),
    LimitKind.TIP: (0.0, 0.2, 0.4),
    LimitKind.CONTACT_RATIO: (1.0, 1.2, 1.4),
    LimitKind.INTERFERENCE: (0.0,),
    LimitKind.BACKLASH: (0.0,),
    LimitKind.CLEARANCE: (0.0,),
    LimitKind.THICKNESS: (0.0,),
}
"""Values at which the map has lines."""

_DIGITS = 4
_EXACT = 1e-9


class KnownMap(NamedTuple):
    """A map as the browser has it, without what moves in it, and what stands for it."""

    of: LimitMap | None
    fields: list[dict[str, Any]]
    key: str


class LimitsPanel(Panel[KnownMap]):
    """The shift diagram of the design; calls `change` with what is moved, as it would be typed."""

    def __init__(self, bench: Workbench, change: Callable[[Mapping[str, str]], None], words: PageWords) -> None:
        self._bench, self._change = bench, change
        self._names = {
            Free.TEETH: (words["number of teeth"], "z"),
            Free.HELIX: (words["helix angle"], "β"),
            Free.FIRST: (words.divided(words["profile shift coefficient"]), "x"),
            Free.SECOND: (words.divided(words["profile shift coefficient"]), "x₂"),
        }
        self._kinds = {
            LimitKind.UNDERCUT: words["undercut"],
            LimitKind.TIP: words["tip thickness s_an/m_n"],
            LimitKind.CONTACT_RATIO: words["transverse contact ratio"],
            LimitKind.INTERFERENCE: words["interference at the root"],
            LimitKind.BACKLASH: words["no backlash"],
            LimitKind.CLEARANCE: words["no tip clearance"],
            LimitKind.THICKNESS: words["no tooth left"],
        }
        self._roles = {Role.PINION: words["Pinion"], Role.WHEEL: words["Wheel"], None: ""}
        own = {
            "map": words["shift diagram: move the design with the arrow keys"],
            "none": words["This kind of design has no shift diagram."],
            "refused": words["makes no gears"],
            "warned": words["with a warning"],
        }
        self._view = LimitsView(self._moved, own)
        self._map: LimitMap | None = None
        self._shown = ""

    def find(self, design: Design) -> KnownMap:
        found = limit_map(design, self._bench.tables)
        if found is None:
            return KnownMap(None, [], "")
        fields = [self._field(limit) for limit in found.map.limits if _matters(limit)]
        axes = [(each.free, each.least, each.most) for each in found.variables]
        return KnownMap(found, fields, hashlib.sha256(repr((axes, fields)).encode()).hexdigest())

    def show(self, found: KnownMap) -> None:
        self._map = found.of
        state: dict[str, Any] = {"variables": [] if found.of is None else [*map(self._variable, found.of.variables)]}
        if found.key != self._shown:
            self._shown = found.key
            state["limits"] = found.fields
        self._view.show(state)

    def clear(self) -> None:
        self.show(KnownMap(None, [], ""))

    def _moved(self, values: Mapping[int, float]) -> None:
        """Apply new values of some of the variables."""
        if self._map is not None:
            variables = self._map.variables
            moved = [variables[at].typed(value) for at, value in values.items() if at < len(variables)]
            self._change({key: text for each in moved for key, text in each.items()})

    def _variable(self, variable: Variable) -> dict[str, Any]:
        words, symbol = self._names[variable.free]
        paired = self._map is not None and any(limit.role for limit in self._map.map.limits)
        return {
            "words": words,
            "unit": "°" if variable.free is Free.HELIX else "",
            "symbol": "x₁" if paired and variable.free is Free.FIRST else symbol,
            "value": variable.value,
            "least": variable.least,
            "most": variable.most,
            "step": variable.step,
        }

    def _field(self, limit: Limit) -> dict[str, Any]:
        return {
            "kind": limit.kind.value[0],
            "role": "both" if limit.role is None else limit.role.value,
            "unit": "" if limit.kind in (LimitKind.TIP, LimitKind.CONTACT_RATIO) else "m_n",
            "words": " · ".join(filter(None, (self._kinds[limit.kind], self._roles[limit.role]))),
            "lines": _LINES[limit.kind],
            "refused": limit.kind.refused if np.isfinite(limit.kind.refused) else None,
            "warned": limit.kind.warned,
            "values": [[None if value != value else value for value in row] for row in limit.values.round(_DIGITS).tolist()],
        }


def _matters(limit: Limit) -> bool:
    """Return whether a limit has a line in the map, or has no value somewhere. A limit of one value everywhere has no line."""
    values = limit.values
    if np.isnan(values).any():
        return not np.isnan(values).all()
    highest = max(_LINES[limit.kind])
    return bool(values.min() < highest - _EXACT) and bool(np.ptp(values) > _EXACT)
