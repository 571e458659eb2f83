"""What a line of a table of results has of a rating."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from gearcad.rating.strength import INFINITE

__all__ = ["rate_columns"]

_FACTORS = ("K_v", "K_Hbeta", "K_Fbeta", "K_Halpha", "K_Falpha")
_STRESSES = ("sigma_H", "sigma_HG", "sigma_F", "sigma_FG")
_VERDICT = ("passed", "strength")


def rate_columns(document: Mapping[str, Any]) -> dict[str, Any]:
    """Of rate.json: verdict, safeties of each gear and the least, torque, life, scuffing, load factors, stresses.

    Of a planetary train verdict, least safeties and life of all its meshes. A life without end is no number: it has a column.
    """
    verdict, warnings = {name: document[name] for name in _VERDICT}, {"warnings": document["warnings"]}
    if "meshes" in document:
        return {**verdict, **_of_meshes([_least_of(each) for each in document["meshes"].values()]), **warnings}
    safety = document["safety"]
    return {
        **verdict,
        "S_H": safety["flank"],
        "S_F": safety["root"],
        **_least_of(document),
        "S_int": safety["scuffing"]["integral"],
        "S_B": safety["scuffing"]["flash"],
        **{symbol: document["factors"].get(symbol) for symbol in _FACTORS},
        **{symbol: document["stresses"][symbol] for symbol in _STRESSES},
        **warnings,
    }


def _of_meshes(every: list[dict[str, Any]]) -> dict[str, Any]:
    """The least of all meshes, whose torques are on different gears."""
    finite = [each["life"] for each in every if each["life_infinite"] is False]
    known = bool(every) and all(each["life_infinite"] is not None for each in every)
    return {
        **{key: _least(each[key] for each in every) for key in ("S_H_min", "S_F_min") if every},
        "life": min(finite) if known and finite else None,
        "life_infinite": not finite if known else None,
    }


def _least_of(document: Mapping[str, Any]) -> dict[str, Any]:
    """The least of both gears, and of flanks and roots."""
    life = document["life"]["least"]
    return {
        "S_H_min": _least(document["safety"]["flank"].values()),
        "S_F_min": _least(document["safety"]["root"].values()),
        "permissible_torque": document["permissible_torque"]["least"],
        "life": None if life == INFINITE else life,
        "life_infinite": None if life is None else life == INFINITE,
    }


def _least(values: Any) -> float | None:
    """None where one is not known."""
    found = list(values)
    return None if None in found else min(found)
