"""What a line of a table of results has of dynamics.json."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from gearcad.dynamics.options import PairModel

__all__ = ["dynamics_columns"]

_OF_PAIRS = (
    "model stiffness_method mesh_stiffness_mean mesh_stiffness_tangent_mean pinion_inertia wheel_inertia tooth_stiffness"
    " tooth_damping natural_frequency damping_ratio static_approach contact_ratio resonance_speed_iso6336"
).split()
"""What a line has of the document as it is."""

_MOST_FREQUENCIES = 6
"""Natural frequencies above 0 that a line has of a train."""


def dynamics_columns(document: Mapping[str, Any]) -> dict[str, Any]:
    """Of a pair: inertias and stiffness, its natural frequency, K_v at the speed and the highest. Of a train: its first
    natural frequencies, K_v of each mesh at the speed and the highest, and the highest overload of each shaft.
    """
    if document["model"] not in (model.value for model in PairModel):
        return _of_train(document)
    found = {name: document[name] for name in _OF_PAIRS if name in document}
    if document["model"] != PairModel.MESH.value:
        return {**found, "warnings": document["campbell"]["warnings"]}
    modes, course = document["modes"], document["course"]
    (kv,) = course["kv"]
    (over_speed,) = document["chart"]["kv"].values()
    highest = max(range(len(over_speed)), key=over_speed.__getitem__)
    found |= {
        "natural_frequency": modes["frequency"][modes["rigid"]],
        "course_speed": course["speed"],
        "kv": kv,
        "kv_highest": over_speed[highest],
        "kv_highest_speed": document["speed"][highest],
        **dict(_with_errors(document, named=False)),
    }
    return {**found, "warnings": document["warnings"]}


def _of_train(document: Mapping[str, Any]) -> dict[str, Any]:
    modes = document["modes"]
    elastic = modes["frequency"][modes["rigid"] :][:_MOST_FREQUENCIES]
    found = {f"frequency_{number}": each for number, each in enumerate(elastic, 1)}
    if "chart" in document:
        greatest, course = document["greatest"], document["course"]
        found |= {
            "kv_highest": greatest["factor"],
            "kv_highest_speed": greatest["speed"],
            "kv_highest_mesh": greatest["mesh"],
            "course_speed": course["speed"],
            **{f"kv.{name}": kv for name, kv in zip(document["chart"]["kv"], course["kv"], strict=True)},
            **dict(_highest(document, "kv", "kv_highest")),
            **dict(_highest(document, "shaft_overload", "shaft_overload")),
            **dict(_with_errors(document, named=True)),
        }
    return {**found, "warnings": document["warnings"]}


def _highest(document: Mapping[str, Any], of: str, column: str) -> Iterator[tuple[str, float]]:
    """The highest of each mesh or shaft, running up or down, and its speed; nothing of shafts that carry nothing at rest."""
    charts = [chart for chart in (document["chart"], document["chart_down"]) if chart is not None]
    for name in charts[0][of]:
        over_speed = [
            max(factors) for factors in zip(*(chart[of][name] for chart in charts), strict=True) if None not in factors
        ]
        if over_speed:
            row = max(range(len(over_speed)), key=over_speed.__getitem__)
            yield f"{column}.{name}", over_speed[row]
            yield f"{column}_speed.{name}", document["speed"][row]


def _with_errors(document: Mapping[str, Any], *, named: bool) -> Iterator[tuple[str, float]]:
    """The highest median of K_v and its highest upper quantile, where errors of teeth were drawn; of which mesh, if `named`."""
    drawn = document.get("tooth_errors")
    for each in () if drawn is None else drawn["greatest"]:
        behind = f".{each['mesh']}" if named else ""
        for column, key in (("kv_errors_median", "median"), ("kv_errors_upper", "upper")):
            yield column + behind, each[key]
