"""Random pinions and rings, near the limits of what can run together, fit or not."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from hypothesis import strategies as st

from gearcad import BasicRack, Body, Gear
from gearcad.core.records import PerGear
from gearcad.geometry import ShaperCutter, zero_backlash_centre_distance
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.mating import tip_on_form_circle
from gearcad.geometry.pair_data import PairData, shift_sum_limit


def _often(value: Any, rest: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    return st.one_of(st.just(value), rest)


@st.composite
def ring_pair_inputs(draw: st.DrawFn, most_more: int = 240) -> dict[str, Any]:
    """Inputs of a pair with a ring that has at most `most_more` teeth more; lengths in normal modules."""
    pinion = draw(st.integers(9, 60))
    more = st.one_of(st.integers(2, 14), st.integers(6, min(60, most_more)), st.integers(6, most_more))
    ring = max(pinion + draw(more), 24)
    helix, angle = draw(_often(0.0, st.floats(0.01, 35))), draw(_often(20.0, st.sampled_from([14.5, 17.5, 25.0, 30.0])))
    most = shift_sum_limit(teeth=PerGear(pinion, -ring), helix_angle=helix, pressure_angle=angle)
    first, total = draw(st.floats(-0.3, 0.8)), min(draw(st.floats(-1.2, 0.4)), 0.9 * most)
    return {
        "teeth": (pinion, -ring),
        "normal_module": draw(st.sampled_from([0.5, 1.0, 2.0, 5.0])),
        "helix_angle": draw(st.sampled_from([1, -1])) * helix,
        "pressure_angle": angle,
        "profile_shift": (first, total - first),
        "addendum": (draw(_often(1.0, st.floats(0.6, 1.15))), draw(_often(1.0, st.floats(0.5, 1.1)))),
        "root_radius": draw(st.floats(0, 1)),
        "thinning": (draw(_often(0.0, st.floats(0.005, 0.05))), draw(_often(0.0, st.floats(0.005, 0.05)))),
        "tip_chamfer": (draw(_often(0.0, st.floats(0.02, 0.15))), draw(_often(0.0, st.floats(0.02, 0.15)))),
        "cutter_teeth": draw(_often(None, st.integers(12, 60))),
        "corner": draw(st.floats(0.01, 0.15)),
        "closer": draw(_often(0.0, st.floats(0, 0.1))),
        "clear": draw(st.booleans()),
    }


def build_ring_pair(inputs: dict[str, Any]) -> PairData:
    """Both gears at their centre distance, not asked whether they fit; raises GearcadError where there are none.

    "clear" ends the ring's flank on the pinion's root form circle.
    """
    m = inputs["normal_module"]

    def given(index: int) -> dict[str, Any]:
        dedendum = max(inputs["addendum"][index], 1.0) + 0.25
        rack = BasicRack(pressure_angle=inputs["pressure_angle"], addendum=inputs["addendum"][index], dedendum=dedendum)
        rack = replace(rack, root_radius=inputs["root_radius"] * max(rack.full_root_radius(), 0.0))
        return {
            "teeth": inputs["teeth"][index],
            "normal_module": m,
            "face_width": 8 * m,
            "helix_angle": inputs["helix_angle"],
            "profile_shift": inputs["profile_shift"][index],
            "tooth_thinning": inputs["thinning"][index] * m,
            "rack": rack,
            "body": Body(tip_chamfer=inputs["tip_chamfer"][index] * m),
        }

    distance = zero_backlash_centre_distance(
        normal_module=m,
        teeth=PerGear(*inputs["teeth"]),
        helix_angle=inputs["helix_angle"],
        pressure_angle=inputs["pressure_angle"],
        shift_sum=sum(inputs["profile_shift"]),
    )
    distance += inputs["closer"] * m
    pinion, of_ring = Gear(**given(0)), given(1)
    if inputs["clear"]:
        plain = GearData(**of_ring)
        tip = tip_on_form_circle(plain, pinion, distance)
        if tip is not None and tip < plain.standard_tip_diameter:
            of_ring["tip_diameter"] = tip
    few = inputs["cutter_teeth"] is not None and inputs["cutter_teeth"] < -inputs["teeth"][1] - 4
    cutter = ShaperCutter(teeth=inputs["cutter_teeth"] if few else None, tip_radius=inputs["corner"])
    return PairData(pinion=pinion, wheel=Gear(**of_ring, cutter=cutter), centre_distance=distance)
