"""How far figures that another solver found are from those of our own check."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from gearcad.per_gear import PerGear, Role

__all__ = ["Deviations", "deviations"]


@dataclass(frozen=True)
class Deviations:
    """In % of our own figures; the load share in % of the load, of the pair of teeth where it is farthest off.

    That of the pressure is the greatest of all pairs of teeth away from edges, None if there are none.
    """

    transmission_error: float
    load_share: float
    root_stress: PerGear[float]
    contact_pressure: float | None


def deviations(expected: dict[str, Any], found: dict[str, Any]) -> Deviations:
    """What `found` differs by from `expected`, as a deck has them both."""
    theirs = {pair["pinion"]: pair for pair in found["pairs"]}
    ours = {pair["pinion"]: pair for pair in expected["pairs"]}
    shares = [_value(theirs, name, "load_share") - _value(ours, name, "load_share") for name in theirs | ours]
    pressures = [
        _relative(_value(theirs, name, "contact_pressure"), pair["contact_pressure"])
        for name, pair in ours.items()
        if pair["contact_pressure"]
    ]
    roots = PerGear.each(lambda role: _root(found, expected, role))
    error = _relative(found["transmission_error"], expected["transmission_error"])
    return Deviations(error, 100 * max(shares, key=abs), roots, max(pressures, key=abs, default=None))


def _value(pairs: dict[str, Any], name: str, figure: str) -> float:
    return float(pairs[name][figure]) if name in pairs else 0.0


def _root(found: dict[str, Any], expected: dict[str, Any], role: Role) -> float:
    return _relative(found["root_stress"][role.value], expected["root_stress"][role.value])


def _relative(value: float, reference: float) -> float:
    return 100 * (value / reference - 1)
