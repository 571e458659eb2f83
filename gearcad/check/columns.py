"""One line of a table of results for a check: verdicts, deviations, errors and safeties, beside its summary and rating."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from gearcad.core.records import JsonObject, Verdict
from gearcad.rating.strength import RatedPart

_DEVIATIONS = {
    "peak contact pressure": "hertz_pressure_deviation",
    "half width of contact": "hertz_half_width_deviation",
    "torque reaction of the pinion": "torque_deviation_pinion",
    "torque reaction of the wheel": "torque_deviation_wheel",
    "contact pressure, pinion": "contact_pressure_deviation_pinion",
    "contact pressure, wheel": "contact_pressure_deviation_wheel",
    "contact pressure at the pitch point": "contact_pressure_pitch_point_deviation",
    "mean length of the lines of contact": "contact_length_deviation",
    "greatest line load": "line_load_deviation",
    "face load factor K_Hbeta": "face_load_factor_deviation",
    "face load factor K_Fbeta, pinion": "root_face_load_factor_deviation_pinion",
    "face load factor K_Fbeta, wheel": "root_face_load_factor_deviation_wheel",
    "root stress, pinion": "root_stress_deviation_pinion",
    "root stress, wheel": "root_stress_deviation_wheel",
    "mean mesh stiffness": "mesh_stiffness_deviation",
    "single stiffness": "single_stiffness_deviation",
}
"""Columns of comparisons whose deviation from the reference (%) is told, by quantity."""

_ERRORS = {
    "discretisation error, mean mesh stiffness": "discretisation_error_mesh_stiffness",
    "discretisation error, root tension, pinion": "discretisation_error_root_tension_pinion",
    "discretisation error, root tension, wheel": "discretisation_error_root_tension_wheel",
    "sampling error of the root stresses": "sampling_error_root_tension",
    "sampling error of the contact pressure": "sampling_error_contact_pressure",
}
"""Columns of comparisons that are errors (%) beside what is permitted, by quantity."""


_OF_RACKS = {
    "force along the rack, from its back": "torque reaction of the wheel",
    "root stress, rack": "root stress, wheel",
    "discretisation error, root tension, rack": "discretisation error, root tension, wheel",
}
"""Comparisons of a rack, which counts as the wheel."""


def check_columns(document: Mapping[str, Any]) -> JsonObject:
    """Return the figures of a check.json for one line of a table.

    They are the verdicts and the gates that failed, deviations from Hertz, equilibrium and standard, the errors of mesh and
    positions (all in %), the summary, safeties by the rating and by finite elements, and the rating.
    """
    failed = [each["quantity"] for each in document["comparisons"] if each["role"] == "gate" and not each["passed"]]
    return {
        **{name: document[name] for name in ("passed", "numerics", "strength")},
        "strength_fe": _strength_by_elements(document),
        "gates_failed": "; ".join(failed) or None,
        **dict(_compared(document)),
        **document["summary"],
        **dict(_safeties(document)),
        "rating": document["rating"],
        "warnings": document["warnings"],
    }


def _compared(document: Mapping[str, Any]) -> Iterator[tuple[str, float | None]]:
    """Yield deviations and errors in %; None where one could not be evaluated.

    Stresses against limits of a material have the names of stresses against the standard's, and are left out.
    """
    for each in document["comparisons"]:
        if each["subject"] == "strength":
            continue
        quantity = _OF_RACKS.get(each["quantity"], each["quantity"])
        if (column := _DEVIATIONS.get(quantity)) is not None:
            yield column, None if each["deviation"] is None else 100 * each["deviation"]
        elif (column := _ERRORS.get(quantity)) is not None:
            yield column, each["computed"]


def _safeties(document: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Yield the safeties of flanks and roots of both gears, by the rating and by finite elements, and those required."""
    for part in RatedPart:
        gears = document["safeties"][part.value]
        symbol = f"S_{part.index}"
        yield symbol, {gear: each["rated_safety"] for gear, each in gears.items()}
        yield f"{symbol}_fe", {gear: each["fe_safety"] for gear, each in gears.items()}
        yield f"{symbol}_required", next(iter(gears.values()))["required"]


def _strength_by_elements(document: Mapping[str, Any]) -> str:
    """Return the verdict of the safeties by finite elements, which is for information: no exit status rests on it."""
    if document["strength"] == Verdict.NOT_ASKED.value:
        return Verdict.NOT_ASKED.value
    if document["safeties"]["below_required"]:
        return Verdict.FAILED.value
    safeties = [each["fe_safety"] for part in RatedPart for each in document["safeties"][part.value].values()]
    return Verdict.NOT_JUDGED.value if None in safeties else Verdict.PASSED.value
