"""What a report shows of tooth errors that were drawn: the greatest K_v of each mesh, and that at the speed asked for."""

from __future__ import annotations

import numpy as np

from gearcad.dynamics.tooth_errors.result import BAND, ErrorStudy
from gearcad.dynamics.train_result import TrainStudy
from gearcad.plots.paper import short
from gearcad.report.dynamics.tables import WordTable, factor_text

__all__ = ["error_table"]


def error_table(study: TrainStudy) -> WordTable | None:
    """Rows of each mesh: over all speeds, and at the one asked for if it is among them; None where nothing was drawn."""
    if study.errors is None:
        return None
    of = study.errors
    upper = f"{100 * BAND[1]:g} % quantile"
    heads = ("mesh", "", "without errors", "at rpm", "median", "at rpm", upper, "at rpm", "greatest", "at rpm")
    rows = []
    for mesh, name in enumerate(of.mesh_names):
        curves = (of.nominal, of.median, of.band[1], of.most)
        places = [int(curve[:, mesh].argmax()) for curve in curves]
        cells = [
            (factor_text(float(curve[row, mesh])), short(float(of.speeds[row])))
            for curve, row in zip(curves, places, strict=True)
        ]
        rows.append((name, "highest over speed", *(cell for pair in cells for cell in pair)))
        if (row := _asked(study, of)) is not None:
            speed = short(float(of.speeds[row]))
            found = [cell for curve in curves for cell in (factor_text(float(curve[row, mesh])), speed)]
            rows.append((name, "at the speed asked for", *found))
    return WordTable(heads, rows, 2)


def _asked(study: TrainStudy, of: ErrorStudy) -> int | None:
    """Where the train's speed is."""
    found = np.flatnonzero(np.isclose(of.speeds, abs(study.train.speed), rtol=1e-9))
    return int(found[0]) if len(found) and study.train.speed else None
