"""Holds: what stays as it is while teeth, module or helix angle change, and which inputs then follow.

A spec itself says what it holds. With a centre distance and a profile shift "auto" the shifts follow; with numbers for the
shifts and no centre distance that follows; with all of them given the backlash follows. Only a held ratio is no part of a spec.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from typing import Any, NamedTuple

from gearcad.core.quantities import Whole, schema_of
from gearcad.designs.design import Design
from gearcad.designs.keys import Cell, DesignKind
from gearcad.designs.ranking import is_given_key
from gearcad.designs.spec import AUTO
from gearcad.geometry import Gear

__all__ = ["HeldQuantity", "HeldRatio", "Mates", "held_ratio", "hold_of", "mates_of", "to_hold", "unwritten_followers"]


class HeldQuantity(Enum):
    """Quantity that stays while other inputs change: centre distance, profile shifts, or ratio of the numbers of teeth."""

    CENTRE_DISTANCE = "a"
    PROFILE_SHIFTS = "x"
    RATIO = "u"


class Mates(NamedTuple):
    """The gears whose teeth decide a ratio, those whose shifts decide a centre distance, and the key of that distance.

    `second` is "" where the mate has no profile shift, `ratio` is empty where no ratio follows from two numbers of teeth.
    The shift of the gear `closing` a set follows whatever is held, if it is "auto".
    """

    first: str
    second: str
    distance: str
    ratio: tuple[str, ...] = ()
    closing: str = ""

    @property
    def shifts(self) -> tuple[str, ...]:
        """Keys of the profile shifts; the last is the one that follows unless another one does."""
        return tuple(f"{table}.profile_shift" for table in (self.first, self.second) if table)


def mates_of(kind: DesignKind, tables: Mapping[str, Any]) -> Mates | None:
    """Return the gears whose inputs can be held; None for a kind of design that holds nothing.

    Of a planetary set, which has a sun, a planet and a ring, these are sun and planet; the ring closes the set.
    """
    if kind is DesignKind.PAIR:
        return Mates("pinion", "wheel", "pair.centre_distance", ("pinion", "wheel"))
    if kind is DesignKind.RACK_PAIR:
        return Mates("pinion", "", "pair.mounting_distance")
    if kind is DesignKind.PLANETARY and all(table in tables for table in ("sun", "planet", "ring")):
        return Mates("planet", "sun", "planetary.centre_distance", ("sun", "ring"), "ring")
    return None


def hold_of(mates: Mates, tables: Mapping[str, Any]) -> HeldQuantity | None:
    """Return what a spec holds, the centre distance or the profile shifts; None where it gives both, or neither."""
    automatic = bool(_automatic(mates, tables))
    given = is_given_key(tables, mates.distance)
    return None if given is not automatic else HeldQuantity.CENTRE_DISTANCE if given else HeldQuantity.PROFILE_SHIFTS


def _automatic(mates: Mates, tables: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the keys of the profile shifts that are to be derived."""
    return tuple(key for key in mates.shifts if _value(tables, key) == AUTO)


def _value(tables: Mapping[str, Any], key: str) -> Any:
    table, _, field = key.partition(".")
    return tables[table][field] if is_given_key(tables, key) else None


_DECIMALS = 9
"""Decimals with which a value that followed is written, in mm or modules: 1 pm, which nobody measures."""


def to_hold(hold: HeldQuantity, mates: Mates, design: Design, tables: Mapping[str, Any]) -> dict[str, Cell | None]:
    """Return the keys to write so that the spec of a design holds its centre distance, or its profile shifts.

    What is held has the value of the design, what follows is "auto", or left out (None). Without an entry nothing changes.
    """
    automatic, given = _automatic(mates, tables), is_given_key(tables, mates.distance)
    if hold is HeldQuantity.CENTRE_DISTANCE:
        distance: dict[str, Cell | None] = {} if given else {mates.distance: _distance(design)}
        return distance | ({} if automatic else {mates.shifts[-1]: AUTO})
    gears = {key: _gear(design, tables, key.partition(".")[0]) for key in automatic}
    shifts: dict[str, Cell | None] = {key: round(gear.profile_shift, _DECIMALS) + 0.0 for key, gear in gears.items()}
    return shifts | ({mates.distance: None} if given else {})


def _distance(design: Design) -> float:
    """Return the centre distance, or mounting distance, of a design (mm)."""
    found: Any = design.train if hasattr(design, "train") else getattr(design, "pair")  # noqa: B009  # of some kinds only
    distance = found.mounting_distance if hasattr(found, "mounting_distance") else found.centre_distance
    return round(float(distance), _DECIMALS)


def _gear(design: Design, tables: Mapping[str, Any], table: str) -> Gear:
    """Return the gear of a table, which users may have given another name."""
    return design.gears[table if table in design.gears else tables[table]["name"]]


def unwritten_followers(mates: Mates, tables: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the keys whose values follow from the others: the centre distance, or profile shifts."""
    hold = hold_of(mates, tables)
    closing = f"{mates.closing}.profile_shift"
    closes = (closing,) if mates.closing and _value(tables, closing) == AUTO else ()
    if hold is HeldQuantity.CENTRE_DISTANCE:
        return (*_automatic(mates, tables), *closes)
    return (mates.distance, *closes) if hold is HeldQuantity.PROFILE_SHIFTS else closes


class HeldRatio(NamedTuple):
    """A ratio of numbers of teeth, second over first, with the tables of both gears.

    `room` is the number of teeth that sun and two planets of a set are short of its ring; None where no planets are between.
    """

    ratio: float
    tables: tuple[str, ...]
    room: int | None = None

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys of the numbers of teeth, one of which follows."""
        return tuple(f"{table}.teeth" for table in self.tables)

    def followers(self, key: str, teeth: int) -> dict[str, int]:
        """Return the number of teeth of the mate, by its key, that is nearest to the ratio if a gear has so many `teeth`.

        The planets of a set change so that they fit between sun and ring as before. Empty for other keys, and where no gear has
        the numbers.
        """
        if key not in self.keys or not teeth or (teeth < 0) is not (key == self.keys[1] and self.ratio < 0):
            return {}
        first, second = self.keys
        found = {second: _nearest(teeth * self.ratio)} if key == first else {first: _nearest(teeth / self.ratio)}
        if self.room is not None:
            both = {key: teeth, **found}
            found["planet.teeth"] = _nearest((-both[second] - both[first] - self.room) / 2)
        return found if all(map(_is_permitted, found.values())) else {}


def held_ratio(mates: Mates, design: Design, tables: Mapping[str, Any]) -> HeldRatio | None:
    """Return the ratio of a design, to be held; None for mates without one."""
    if not mates.ratio:
        return None
    first, second = (_gear(design, tables, table).teeth for table in mates.ratio)
    planets = mates.ratio[1] == "ring"
    room = -second - first - 2 * _gear(design, tables, "planet").teeth if planets else None
    return HeldRatio(second / first, mates.ratio, room)


def _nearest(exact: float) -> int:
    """Return the nearest whole number; of two that are as near the one farther from 0."""
    return int(exact + (0.5 if exact > 0 else -0.5))


def _is_permitted(count: int) -> bool:
    permitted = schema_of(Gear)["teeth"].permitted
    return isinstance(permitted, Whole) and permitted.least <= abs(count) <= permitted.most
