"""The document of check.json: stiffness in N/(mm µm) of common face width, transmission error in µm, stresses in MPa."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from gearcad.check.run import CheckResult
from gearcad.fea.flank import FlankCompliance
from gearcad.meshing.quality import mesh_quality

__all__ = ["check_document"]


def check_document(result: CheckResult) -> dict[str, Any]:
    """Everything of a check under the names of check.json."""
    return {
        "kind": "check",
        "model": "2d",
        "load": asdict(result.load),
        "mounting": asdict(result.mounting),
        "material": asdict(result.material),
        "options": asdict(result.options),
        "body": result.bodies,
        "mesh": {"pinion": _mesh(result.cycle.model.pinion), "wheel": _mesh(result.cycle.model.wheel)},
        "positions": len(result.cycle.positions),
        "mesh_cycle": _cycle(result),
        "summary": result.summary.to_dict(),
        "torque_sweep": [point.to_dict() for point in result.sweep],
        "rating": result.rating.to_dict(),
        "convergence": [each.to_dict() for each in result.convergence],
        "comparisons": [comparison.to_dict() for comparison in result.comparisons],
        "warnings": list(result.warnings),
        "passed": result.passed,
    }


def _mesh(body: FlankCompliance) -> dict[str, Any]:
    """Size and quality of the mesh of one tooth sector."""
    mesh = body.ring.sector.mesh
    return {"nodes": len(mesh.points), **asdict(mesh_quality(mesh.points, mesh.triangles))}


def _cycle(result: CheckResult) -> dict[str, Any]:
    """Lists over the positions; those of load share and pressure hold one value for each of `pairs`, 0 out of contact.

    The pressure of a corner contact is null: it depends on the mesh.
    """
    positions = result.cycle.positions
    pairs = sorted({contact.pair.tooth for position in positions for contact in position.contacts})
    shares, pressures = [], []
    for position in positions:
        contacts = {contact.pair.tooth: contact for contact in position.contacts}
        shares.append([contacts[pair].share if pair in contacts else 0.0 for pair in pairs])
        pressures.append(
            [
                0.0 if pair not in contacts else contacts[pair].peak_pressure if contacts[pair].interior else None
                for pair in pairs
            ]
        )
    return {
        "roll_angle": [position.roll_angle for position in positions],
        "mesh_stiffness": [position.stiffness for position in positions],
        "transmission_error": [position.transmission_error for position in positions],
        "pairs": pairs,
        "load_share": shares,
        "contact_pressure": pressures,
        "root_stress_pinion": [position.tension[0].stress for position in positions],
        "root_stress_wheel": [position.tension[1].stress for position in positions],
        "root_compression_pinion": [position.compression[0].stress for position in positions],
        "root_compression_wheel": [position.compression[1].stress for position in positions],
    }
