"""Compare: the mesh stiffness of a pair, or of what a spec describes, by every method."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from typing import Any, Unpack

from gearcad import __version__
from gearcad.check.options import CheckOptions
from gearcad.designs import Design, Inputs, PairDesign, as_design
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.progress import Expected, Progress
from gearcad.stiffness.comparison import StiffnessComparison, compare_methods, expected_methods
from gearcad.stiffness.methods import METHODS

__all__ = ["compare", "curves_csv", "expected_comparison", "stiffness_document"]

_COLUMNS = ("method", "roll_angle", "path_position", "mesh_stiffness", "tangent_stiffness", "transmission_error")


def compare(
    subject: Design | GearPair,
    load: Load | None = None,
    *,
    methods: Sequence[str] = tuple(METHODS),
    positions: int = 0,
    progress: Progress | None = None,
    **inputs: Unpack[Inputs],
) -> StiffnessComparison:
    """Mesh stiffness of a pair as mounted, under a load, by `methods`, its bodies held as `check` says.

    `material`, `mounting` and `check`, as the load, stand in place of those of a design; a pair has the defaults.

    >>> from gearcad import Gear, GearPair, Load
    >>> gears = [Gear(teeth=z, normal_module=2, face_width=20, tooth_thinning=0.03) for z in (20, 30)]
    >>> compare(GearPair(pinion=gears[0], wheel=gears[1]), Load(torque=60), methods=["iso6336", "potential-energy"])
    <StiffnessComparison of 'pair' at 60 N·m: iso6336 303.1, potential-energy 431.1 N/µm>

    Raises ParameterError for a design without pair or load, and what `compare_methods` raises.
    """
    design, given = _loaded(as_design(subject, load, **inputs))
    from threadpoolctl import threadpool_limits

    # The dense systems are small, and solid bodies are solved side by side: more threads cost more than they bring.
    with threadpool_limits(1):
        return compare_methods(
            design.pair,
            design.material or Material(),
            given,
            methods,
            body=(design.check or CheckOptions()).body,
            mounting=design.mounting,
            positions=positions,
            progress=progress,
        )


def expected_comparison(design: Design, methods: Sequence[str] = tuple(METHODS), positions: int = 0) -> Expected:
    """What `compare` is expected to take. Raises ParameterError for a design without pair or load."""
    of, _ = _loaded(design)
    body, material = (of.check or CheckOptions()).body, of.material or Material()
    return expected_methods(of.pair, material, methods, body=body, mounting=of.mounting, positions=positions)


def _loaded(design: Design) -> tuple[PairDesign, Load]:
    pair = design.accepted(PairDesign, why="a single gear has no mesh")
    return pair, pair.loaded("stiffness depends on it")


def stiffness_document(comparison: StiffnessComparison, name: str, harmonics: int = 0) -> dict[str, Any]:
    """Everything under the names of stiffness.json, with so many Fourier coefficients of each curve."""
    return {"kind": "stiffness", "name": name, "gearcad": __version__, **comparison.to_dict(harmonics)}


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
