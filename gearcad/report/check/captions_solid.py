"""What the figures of a check of solid bodies show, in sentences made of its numbers."""

from __future__ import annotations

import numpy as np

from gearcad.check.convergence import SOLID_ORDER
from gearcad.check.solid.result import SolidCheck
from gearcad.check.solid.summary import middle_contacts
from gearcad.per_gear import Role
from gearcad.plots.paper import short
from gearcad.report.check.captions import number

__all__ = [
    "contact_pattern",
    "convergence",
    "harmonics",
    "line_loads",
    "lines_share",
    "load_along_face",
    "root_along_face",
    "tooth_view",
]


def line_loads(result: SolidCheck) -> str:
    """Caption of the load over the plane of action."""
    summary = result.summary
    worst = result.cycle.worst_contact
    position, _ = worst or result.cycle.heaviest_contact
    where = "the pressure away from the edges is greatest" if worst else "a pair of teeth carries most, all of it beside edges"
    corners, count = summary.corner_positions, len(result.cycle.positions)
    touch = f"The edge of a tip carries at {corners} of {count} positions" if corners else "No edge of a tip carries"
    return (
        "Load per length of the lines of contact, of all positions together, over the plane of action: each pair of teeth "
        "crosses it once, from left to right. Dashed: the lines of contact at roll angle "
        f"{position.roll_angle:.2f}°, where {where}. Colours end at "
        f"{number(summary.line_load_max)} N/mm, the greatest away from the edges. {touch}: beyond A and E, where no flank "
        "meets a "
        "flank any more."
    )


def contact_pattern(result: SolidCheck, role: Role) -> str:
    """Caption of the pressure on a flank."""
    summary, name = result.summary, role.value
    return (
        f"Greatest pressure at each place of the {name}'s flank while it goes through the mesh: the contact pattern, as "
        "marking "
        f"compound would show it. The greatest away from the edges is {number(summary.contact_pressure)} MPa at radius "
        f"{number(summary.contact_pressure_radius.pick(role))} mm, {number(summary.contact_pressure_across)} mm from the "
        "middle of the "
        "common width; brighter places beside edges are Hertz's formula with the load of that place, which no edge fits. Edges "
        "of tips are left out."
    )


def lines_share(result: SolidCheck) -> str:
    """Caption of the load share."""
    places, shares, *_ = np.array(middle_contacts(result.cycle)).T
    path = result.pair.path_of_contact
    most, at = float(shares.max()), float(places[shares.argmax()])
    parts = ", ".join(f"{100 * np.interp(getattr(path, letter), places, shares):.0f} % at {letter}" for letter in "BCD")
    return (
        "The part of the load that one pair of teeth carries, over the place where its line of contact crosses the middle of "
        f"the common width. It carries {parts}; at most {100 * most:.0f} %, {short(at)} mm from T₁. The lines of helical teeth "
        "reach into the path before and after their middle does."
    )


def harmonics(result: SolidCheck) -> str:
    """Caption of the harmonics."""
    first = result.summary.transmission_error_harmonics[0]
    return (
        "Amplitudes of the transmission error at the frequency of tooth engagement and its multiples; they drive vibration and "
        f"noise. The first is {short(first)} µm of {short(result.summary.transmission_error_peak_to_peak)} µm from peak to "
        "peak."
    )


def load_along_face(result: SolidCheck) -> str:
    """Caption of the load over the face width."""
    across, load = result.cycle.load_along_face
    factor = result.summary.face_load_factor
    return (
        "Load per width, transverse, of all pairs of teeth and on the mean of all positions. Away from the ends its "
        "greatest is "
        f"{short(factor * float(load.mean()))} N/mm, K_Hβ = {factor:.3f} times the mean. The last cells belong to the ends "
        "of the "
        f"faces, where an edge presses whatever the alignment: {short(float(load[0]))} N/mm at {short(float(across[0]))} "
        "mm and "
        f"{short(float(load[-1]))} N/mm at {short(float(across[-1]))} mm."
    )


def root_along_face(result: SolidCheck) -> str:
    """Caption of the root tension over the face width."""
    summary = result.summary
    places = [
        f"z = {short(summary.root_tension_height[gear])} mm and radius {short(summary.root_tension_radius[gear])} mm on "
        f"the {name}"
        for gear, name in enumerate(("pinion", "wheel"))
    ]
    return (
        "Greatest tension of the fillet at each height, over all positions, and the nominal stress of "
        f"{result.rating.edition.part(3)} (dotted). The "
        f"maxima stand at {places[0]} and {places[1]}. K_Fβ is the greatest over the mean along the common width. Where a "
        "gear is "
        "wider than that, it helps to carry (pale)."
    )


def convergence(result: SolidCheck) -> str:
    """Caption of the convergence."""
    errors = ", ".join(f"{100 * each.error:.2g} % ({each.quantity})" for each in result.convergence)
    return (
        "The same figures on three meshes, each of twice the nodes of the one before; 1 is the mesh of this check. "
        f"Estimated error of the check: {errors}. Between meshes so close to each other roundings can feign or hide an order: "
        f"no more than {SOLID_ORDER:g} is credited, and where the values go back and forth their range is the error."
    )


def tooth_view(result: SolidCheck, role: Role) -> str:
    """Caption of a tooth in three dimensions."""
    position, name = result.cycle.worst_position(role), role.value
    return (
        f"Von Mises stress on the surface of the {name}'s most stressed tooth at roll angle {position.roll_angle:.2f}°, "
        "where its "
        f"root tension is greatest ({short(position.tension.pick(role).stress)} MPa). The colours end a tenth above the "
        "greatest of the fillets: the contact, which elements of this size do not resolve, lies above. The cut faces and "
        f"all of the field are in stress_{name}.vtu, for ParaView, whose colours end there too."
    )
