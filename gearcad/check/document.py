"""The document of check.json: stiffness in N/(mm·µm) of common face width, transmission error in µm, stresses in MPa."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any

from gearcad.check.result import CheckResult
from gearcad.contact.shared.extremes import Extreme
from gearcad.material import materials_document
from gearcad.schema import with_assumed

__all__ = ["check_document", "reported_document"]


def check_document(result: CheckResult) -> dict[str, Any]:
    """Everything of a check under the names of check.json."""
    document = {
        "kind": "check",
        "model": result.model.value,
        "load": asdict(result.load),
        "mounting": asdict(result.mounting),
        **materials_document(result.material),
        "options": asdict(result.options),
        "body": result.bodies,
        "mesh": {role.value: body.mesh_document for role, body in result.cycle.model.bodies.items()},
        **result.own_document,
        "positions": len(result.cycle.positions),
        "mesh_cycle": _cycle(result),
        "summary": result.summary.to_dict(),
        "not_evaluated": result.summary.missing,
        "extremes": {name: _extreme(of) for name, of in result.summary.extremes.items()},
        "torque_sweep": [point.to_dict() for point in result.sweep],
        "torque_trends": result.trends.to_dict(),
        "rating": result.rating.to_dict(),
        "strength_rating": {key: value for key, value in result.safeties.rating.to_dict().items() if key != "nominal"},
        "safeties": result.safeties.to_dict(),
        "convergence": [each.to_dict() for each in result.convergence],
        "relief_starts": [start.to_dict() for start in result.relief_starts],
        "comparisons": [comparison.to_dict() for comparison in result.comparisons],
        "explanations": result.explanations.to_dict(),
        "warnings": list(result.warnings),
        "notices": [notice.to_dict() for notice in result.notices],
        "numerics": result.numerics.value,
        "strength": result.strength.value,
        "passed": result.passed,
        "verdict": result.verdict,
    }
    return with_assumed(document)


def reported_document(result: CheckResult) -> dict[str, Any]:
    """The same with all that a report shows: also the mesh stiffness by other methods, which takes part of the check's time."""
    return check_document(result) | {"stiffness_methods": result.stiffness_methods.to_dict()}


def _extreme(of: Extreme | None) -> dict[str, float | None] | None:
    """Value, roll angle, and what the positions may miss of it (relative; null where nothing is known of that)."""
    if of is None:
        return None
    return {"value": of.value, "roll_angle": of.roll_angle, "error": of.error if math.isfinite(of.error) else None}


def _cycle(result: CheckResult) -> dict[str, Any]:
    """Lists over the positions; those of load share and pressure hold one value for each of `pairs`, 0 out of contact.

    The pressure of a contact of edges alone is null: it depends on the mesh.
    """
    positions = result.cycle.positions
    by_tooth = [{contact.tooth: contact for contact in position.contacts} for position in positions]
    pairs = sorted(set().union(*by_tooth))
    return {
        "roll_angle": [position.roll_angle for position in positions],
        "mesh_stiffness": [position.stiffness for position in positions],
        "transmission_error": [position.transmission_error for position in positions],
        "pairs": pairs,
        "load_share": [[of[pair].share if pair in of else 0.0 for pair in pairs] for of in by_tooth],
        "contact_pressure": [[of[pair].interior_pressure if pair in of else 0.0 for pair in pairs] for of in by_tooth],
        "root_stress_pinion": [position.tension.pinion.stress for position in positions],
        "root_stress_wheel": [position.tension.wheel.stress for position in positions],
        "root_compression_pinion": [position.compression.pinion.stress for position in positions],
        "root_compression_wheel": [position.compression.wheel.stress for position in positions],
    }
