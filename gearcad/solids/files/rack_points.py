"""CSV of the computed points of a rack: the outline of half a tooth."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from gearcad.errors import require_number
from gearcad.geometry.curves import parameters_within
from gearcad.geometry.rack import Rack

__all__ = ["write_rack_points"]

_HEADER = ("curve", "index", "direction_deg", "x_mm", "y_mm")


def write_rack_points(rack: Rack, path: Path | str, *, chord_error: float = 0.0005) -> None:
    """Write the left half of a tooth from the middle of the space to that of the tooth, in the transverse section, as CSV.

    Curve, index, direction of travel (degrees from +x), x and y; the tooth is centred on x = 0, y counts from the reference
    line. Chords stay within `chord_error` (mm). Raises ParameterError for one that is not positive.
    """
    require_number("chord_error", chord_error, "mm", above=0)
    with Path(path).open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(_HEADER)
        for curve in rack.profile.curves:
            s = parameters_within(curve, chord_error)
            rows = np.column_stack([np.degrees(curve.direction(s)), curve.points(s)])
            for index, row in enumerate(rows.tolist()):
                writer.writerow([curve.kind.value, index, *(f"{value:.12g}" for value in row)])
