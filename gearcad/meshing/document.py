"""What mesh.json holds."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from gearcad.meshing.result import MeshResult
from gearcad.notice import texts
from gearcad.version import __version__

__all__ = ["mesh_document"]


def mesh_document(result: MeshResult, files: Iterable[str]) -> dict[str, Any]:
    """Lengths in mm, areas in mm², volumes in mm³, deviations in µm, angles in degrees, memory in bytes.

    "summary" is of all meshes: sums of counts, the worst of all else. "meshes" are by gear, also where a file has both.
    """
    plan = result.plan
    of_pair = {"roll_angle": plan.options.roll} if plan.pair is not None else {}
    return {
        "kind": "mesh",
        "name": result.name,
        "gearcad": __version__,
        "what": plan.extent.what.value,
        "model": "3d" if plan.solid else "2d",
        "element": plan.element.value,
        **of_pair,
        "passed": result.passed,
        "summary": _summary(result),
        "meshes": {name: judged.to_dict() for name, judged in result.judged.items()},
        **({"decks": {name: deck.expected for name, deck in result.decks.items()}} if result.decks else {}),
        "files": list(files),
        "notices": [notice.to_dict() for notice in result.notices],
        "warnings": list(texts(result.notices)),
    }


def _summary(result: MeshResult) -> dict[str, Any]:
    every = result.judged.values()
    measured = [judged.quality for judged in every]
    return {
        "nodes": sum(judged.nodes for judged in every),
        "elements": sum(judged.elements for judged in every),
        "bytes": sum(judged.bytes for judged in every),
        "least_scaled_jacobian": min(each.least_jacobian for each in measured),
        "largest_aspect": max(each.largest_aspect for each in measured),
        "least_angle": min(each.least_angle for each in measured),
        "node_deviation": max(judged.deviations.nodes for judged in every),
        "face_deviation": max(judged.deviations.between for judged in every),
        "mean_offset": max(judged.mean_offset for judged in every),
    }
