"""The drawings of gears: [drawing] of all, and a table of a gear's own, such as [pinion.drawing]."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gearcad.designs.spec import Spec

if TYPE_CHECKING:
    from gearcad.drawing.options import DrawingOptions, PartDrawing

__all__ = ["drawing_documents", "drawings_of"]

_TABLE = ".drawing."


def drawings_of(spec: Spec) -> dict[str, PartDrawing]:
    """What gears have of their own, by their tables. Raises SpecError."""
    owners = dict.fromkeys(key.partition(_TABLE)[0] for key in spec.values if _TABLE in key)
    if not owners:
        return {}
    from gearcad.drawing.options import PartDrawing

    return {owner: spec.simple(f"{owner}.drawing", PartDrawing) for owner in owners}


def drawing_documents(drawing: DrawingOptions | None, drawings: Mapping[str, PartDrawing]) -> dict[str, Any]:
    """What documents say of drawings, nothing where nothing is given; of a template the name of its file alone."""
    found: dict[str, Any] = {}
    if drawing is not None:
        template = Path(drawing.template).name if drawing.template else None
        found["drawing"] = asdict(drawing) | {"template": template}
    if drawings:
        given = {name: asdict(part).items() for name, part in drawings.items()}
        found["drawings"] = {name: {key: value for key, value in own if value is not None} for name, own in given.items()}
    return found
