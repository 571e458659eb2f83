"""The spec of a gear that was measured, with what was read and what the gear has, for the next who asks."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from gearcad.designs.pair_text import toml_text
from gearcad.identify.candidate import Candidate
from gearcad.identify.identification import Identification

__all__ = ["write_identified"]


def write_identified(found: Identification, candidate: Candidate, name: str, path: Path) -> None:
    """Write the spec of a candidate, under a name."""
    path.write_text(toml_text({"gear": _keys(candidate, name)}, list(_comments(found, candidate))), encoding="utf-8")


def _keys(candidate: Candidate, name: str) -> dict[str, Any]:
    gear = candidate.gear
    pitch = candidate.diametral_pitch
    keys: dict[str, Any] = {
        "name": name,
        "teeth": gear.teeth,
        **({"normal_module": float(gear.normal_module)} if pitch is None else {"normal_diametral_pitch": pitch}),
        "face_width": gear.face_width,
        "helix_angle": gear.helix_angle,
        "profile_shift": gear.profile_shift,
        "tooth_thinning": gear.tooth_thinning,
        "rack.pressure_angle": gear.rack.pressure_angle,
        "rack.addendum": gear.rack.addendum,
        "rack.dedendum": gear.rack.dedendum,
        "rack.root_radius": gear.rack.root_radius,
    }
    return keys | ({"tip_alteration": gear.tip_alteration} if gear.tip_alteration else {})


def _comments(found: Identification, candidate: Candidate) -> Iterator[str]:
    number = found.candidates.index(candidate) + 1
    share = f"{100 * candidate.probability:.3g} %"
    yield f"Candidate {number} of what was measured, probability {share}; rack: {candidate.rack.name}"
    yield "certain" if number == 1 and found.certain else "not certain: see what else there is before this is made"
    yield ""
    yield f"{'':26}{'read':>12}{'uncertainty':>13}{'this gear':>12}"
    for reading, value in zip(found.measured.readings, candidate.predicted, strict=True):
        yield (
            f"{found.measured.label(reading):26}{abs(reading.value):12.4f}{reading.uncertainty:13.4g}{value:12.4f}"
            f" {reading.gauge.unit}"
        )
    yield ""
    yield f"profile shift to ±{candidate.shift_uncertainty:.2g}, thinning to ±{candidate.thinning_uncertainty:.2g} mm" + (
        f", helix angle to ±{candidate.helix_uncertainty:.2g} deg" if candidate.gear.helix_angle else ""
    )
    yield "Face width, root radius and bore were not measured: change them. The hand of a helix is right unless said otherwise."
