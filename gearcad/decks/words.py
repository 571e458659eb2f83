"""What stands at the head of a deck: what it is, and what to look at in its results."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

__all__ = ["pair_words", "tooth_words"]

_PAIR = """\
A pair of gears in mesh at the roll angle {roll_angle:.6g} deg, the pinion pressed against the wheel by {torque:.6g} N m.
CalculiX runs this deck as it is:  ccx NAME  for NAME.inp

The pinion turns about the z axis; the wheel's axis is at x = {distance:.10g} mm. All of each bore, or of an internal gear's
rim, is held, and the cuts of bodies of fewer teeth: the wheel's stand, the pinion's turn with the node "reference", whose
first degree of freedom is the angle in rad. The flanks of pairs of teeth that may touch are surfaces; pressure is a stiffness
times overlap.

The pinion stands turned by {approach_in_mesh:.6g} um along the line of action already, so that there is contact in the first
iteration. The transmission error is that and the angle times the base radius, {base_radius:.10g} mm.

gearcad's own check of the same gears: transmission error {transmission_error:.5g} um, angle {reference_turn:.6e} rad,
greatest tension along the fillets, pinion {root_pinion:.5g} MPa, wheel {root_wheel:.5g} MPa."""

_TOOTH = """\
The {gear} under the loads that gearcad's own check has found on its flanks at the roll angle {roll_angle:.6g} deg,
with {torque:.6g} N m on the pinion. CalculiX runs this deck as it is:  ccx NAME  for NAME.inp

Tooth 0 is on the x axis; all of the bore, or of an internal gear's rim, is held, and the cuts of a body of fewer teeth. {laid}

Greatest tension along the fillets by gearcad's own check: {root_stress:.6g} MPa."""


_LAID_ON_EDGES = """\
The force on each tooth
is laid on the edges of its flank as uniform pressures, which add up to it."""

_LAID_ON_NODES = """\
The loads along the
lines of contact are forces on nodes of the flanks, shared as the shape functions of their faces do."""


def pair_words(expected: Mapping[str, Any], *, distance: float, base_radius: float) -> list[str]:
    """Those of a pair; centre distance and base radius in mm."""
    roots = {f"root_{gear}": stress for gear, stress in expected["root_stress"].items()}
    return _PAIR.format(**expected, **roots, distance=distance, base_radius=base_radius).splitlines()


def tooth_words(expected: Mapping[str, Any], *, solid: bool) -> list[str]:
    """Those of one gear."""
    return _TOOTH.format(**expected, laid=_LAID_ON_NODES if solid else _LAID_ON_EDGES).splitlines()
