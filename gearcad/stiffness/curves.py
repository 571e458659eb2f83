"""The curves of a comparison as a table."""

from __future__ import annotations

import csv
import io

from gearcad.stiffness.comparison import StiffnessComparison

__all__ = ["curves_csv"]

_COLUMNS = ("method", "roll_angle", "path_position", "mesh_stiffness", "tangent_stiffness", "transmission_error")


def curves_csv(comparison: StiffnessComparison) -> str:
    """The curves of all methods, one row for each roll angle of each: degrees, mm from T1, N/µm, µm, µm/N.

    Load shares stand under `load_share.PAIR`, compliances under `compliance.PART`; blank where a method has none.
    """
    cycles = comparison.cycles
    pairs = sorted({pair for cycle in cycles for pair in cycle.pairs})
    parts = list(dict.fromkeys(part for cycle in cycles for part in cycle.compliance_parts))
    headings = [*_COLUMNS, *(f"load_share.{pair}" for pair in pairs), *(f"compliance.{part}" for part in parts)]
    text = io.StringIO()
    writer = csv.DictWriter(text, headings, lineterminator="\n", restval="")
    writer.writeheader()
    for cycle in cycles:
        places = comparison.path_position(cycle.roll_angle)
        for row, (angle, place) in enumerate(zip(cycle.roll_angle.tolist(), places.tolist(), strict=True)):
            writer.writerow(
                {
                    "method": cycle.method,
                    "roll_angle": angle,
                    "path_position": place,
                    "mesh_stiffness": cycle.mesh_stiffness[row],
                    "tangent_stiffness": cycle.tangent_stiffness[row],
                    "transmission_error": cycle.transmission_error[row],
                    **{f"load_share.{pair}": cycle.load_share[row, at] for at, pair in enumerate(cycle.pairs)},
                    **{f"compliance.{name}": part[row] for name, part in cycle.compliance_parts.items()},
                }
            )
    return text.getvalue()
