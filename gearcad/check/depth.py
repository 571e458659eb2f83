"""Material exposure below the flanks: amplitude of the largest shear stress of all contacts over what the hardness bears.

While a contact passes a point, its largest shear stress goes from that of the residual stress alone to its greatest and back;
the amplitude is half of the difference.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from gearcad.check.task import CheckTask
from gearcad.contact.plane.cycle import PlaneCycle, PlanePairContact, strip_stresses
from gearcad.contact.shared.loaded import Cycle
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.core.records import Floats, JsonObject, Notice, Role, freeze
from gearcad.hardness_depth import HardnessProfile, depth_profile_of
from gearcad.rating.subsurface import PlaneStresses, below_line_contact, largest_shear

_DEPTHS, _PLACES, _ACROSS = 90, 60, 31
"""Depths below a flank, places along it in the map, and places across a contact where the shear stress is looked for."""

_SPREAD, _FIRST = 1.5, 0.01
"""Half widths on both sides of a contact, and the first depth over the last."""

_HALF_WIDTHS = 6.0
"""Half widths of the widest contact down to which stresses are looked at, at the least."""

C_1 = 0.04
"""Summand of the exposure by ISO/TS 6336-4 for case-hardened steel, as remembered: unconfirmed."""


@dataclass(frozen=True, kw_only=True)
class MaterialExposure:
    """Exposure of one gear's flank: `exposure` (n, m) at roll lengths `places` (n,) and depths `depths` (m,), in mm.

    It is the greatest of all positions (and of all places over the face width), the amplitude of the largest shear stress over
    tau_per = K_tau HV; NaN where no contact away from edges passes. `worst` is the greatest; at its place and depth in mm, at
    `worst_height` z (mm) of the gear, None in the plane. `shear` and `permissible` (m,) in MPa are the course of amplitudes
    over the depth there. `line_contact` is the exposure of a line contact with the greatest pressure, plus C_1, from the half
    width down, at `line_depth` (mm): as ISO/TS 6336-4 has it but for residual stress.
    """

    role: Role
    profile: HardnessProfile
    places: Floats
    depths: Floats
    exposure: Floats
    worst: float
    worst_place: float
    worst_depth: float
    worst_height: float | None
    shear: Floats
    permissible: Floats
    line_contact: float
    line_depth: float

    def __post_init__(self) -> None:
        freeze(self)

    def to_dict(self) -> JsonObject:
        """Return the exposure of a gear in "depth" of check.json; places without a contact are null."""
        height = {} if self.worst_height is None else {"height": self.worst_height}
        rows = [[None if math.isnan(value) else value for value in row] for row in self.exposure.tolist()]
        return {
            "exposure": self.worst,
            "depth": self.worst_depth,
            "roll_length": self.worst_place,
            **height,
            "K_tau": self.profile.ratio,
            "hardness": self.profile.law,
            "course": {
                "depth": self.depths.tolist(),
                "tau": self.shear.tolist(),
                "tau_per": self.permissible.tolist(),
                "HV": self.profile.hardness(self.depths).tolist(),
            },
            "map": {"roll_length": self.places.tolist(), "depth": self.depths.tolist(), "exposure": rows},
            "line_contact": {"A_FF": self.line_contact, "depth": self.line_depth},
            "unconfirmed": [*self.profile.unconfirmed, "A_FF"],
        }


@dataclass(frozen=True)
class _Contact:
    """Contact at a roll length (mm): greatest pressure (MPa), half width (mm), height z (mm) or None, and its cells."""

    place: float
    pressure: float
    half_width: float
    height: float | None
    cells: PlanePairContact | None = None

    def stresses(self, depths: Floats) -> PlaneStresses:
        """Return the stresses (places across, depths) in MPa below the contact."""
        across = _SPREAD * np.linspace(-1.0, 1.0, _ACROSS)[:, None]
        if self.cells is None:
            found = below_line_contact(across, depths / self.half_width)
            return PlaneStresses(*(self.pressure * each for each in found))
        cells, pressures = self.cells.pair.cells, self.cells.pressures
        middle = float(cells.place @ pressures / pressures.sum())
        x, z = np.broadcast_arrays(middle + self.half_width * across, depths)
        return PlaneStresses(*strip_stresses(x, z, cells.place, cells.width, pressures))


def material_exposure(task: CheckTask, cycle: Cycle) -> dict[Role, MaterialExposure]:
    """Return the exposure of each gear whose material has hardness over depth. Raises ParameterError for half a profile."""
    found = {}
    for role, material in task.materials.items():
        profile = depth_profile_of(material)
        contacts = list(_contacts(cycle, role)) if profile is not None else []
        if profile is not None and contacts:
            found[role] = exposure_of(role, profile, contacts, material.poisson_ratio)
    return found


def _contacts(cycle: Cycle, role: Role) -> Iterator[_Contact]:
    """Yield the contacts of a gear's flank away from edges, of solid gears cell by cell."""
    if isinstance(cycle, PlaneCycle):
        for _, plane in cycle.interior_contacts:
            width = plane.hertz_half_width
            yield _Contact(plane.centre(role), plane.peak_pressure, width, None, plane)
    elif isinstance(cycle, SolidCycle):
        for _, contact in cycle.interior_contacts:
            lengths, heights = contact.line.places.pick(role)
            every = zip(lengths, contact.pressures, contact.half_widths, heights, contact.interior, strict=True)
            for length, pressure, width, height, inside in every:
                if inside:
                    yield _Contact(float(length), float(pressure), float(width), float(height))


def exposure_of(role: Role, profile: HardnessProfile, contacts: list[_Contact], poisson_ratio: float) -> MaterialExposure:
    """Return the exposure of a flank by the contacts that pass it."""
    widest = max(contact.half_width for contact in contacts)
    depths = max(_HALF_WIDTHS * widest, 1.2 * profile.deepest) * np.linspace(_FIRST**0.5, 1.0, _DEPTHS) ** 2
    permissible, residual = profile.permissible_shear(depths), profile.residual_stress(depths)
    places = np.array([contact.place for contact in contacts])
    ends = np.linspace(places.min(), places.max(), _PLACES + 1) if np.ptp(places) else places[0] + np.array([-1e-6, 1e-6])
    bins = np.clip(np.searchsorted(ends, places, side="right") - 1, 0, len(ends) - 2)
    exposure = np.full((len(ends) - 1, _DEPTHS), np.nan)
    best, course, worst = -math.inf, np.zeros(_DEPTHS), contacts[0]
    for contact, into in zip(contacts, bins.tolist(), strict=True):
        across, down, shear = contact.stresses(depths)
        along = poisson_ratio * (across + down) + residual
        greatest = largest_shear(PlaneStresses(across + residual, down, shear), along).max(axis=0)
        sheared = np.maximum(greatest - np.abs(residual) / 2, 0.0) / 2
        own = sheared / permissible
        exposure[into] = np.fmax(exposure[into], own)
        if (most := float(own.max())) > best:
            best, course, worst = most, sheared, contact
    deepest = float(depths[int((course / permissible).argmax())])
    line, line_depth = _line_contact(profile, max(contacts, key=lambda each: each.pressure), poisson_ratio)
    return MaterialExposure(
        role=role,
        profile=profile,
        places=(ends[1:] + ends[:-1]) / 2,
        depths=depths,
        exposure=exposure,
        worst=best,
        worst_place=worst.place,
        worst_depth=deepest,
        worst_height=worst.height,
        shear=course,
        permissible=permissible,
        line_contact=line,
        line_depth=line_depth,
    )


def _line_contact(profile: HardnessProfile, contact: _Contact, poisson_ratio: float) -> tuple[float, float]:
    """Return the greatest exposure below a line contact, from its half width down, plus C_1, and its depth (mm)."""
    z = np.linspace(1.0, max(10.0, 1.2 * profile.deepest / contact.half_width), 2000)
    stresses = below_line_contact(np.zeros_like(z), z)
    shear = contact.pressure * largest_shear(stresses, poisson_ratio * (stresses.across + stresses.down)) / 2
    exposure = shear / profile.permissible_shear(z * contact.half_width) + C_1
    at = int(exposure.argmax())
    return float(exposure[at]), float(z[at] * contact.half_width)


def depth_notices(found: dict[Role, MaterialExposure]) -> Iterator[Notice]:
    """Yield what of the exposure is unconfirmed."""
    unconfirmed = dict.fromkeys(name for each in found.values() for name in each.profile.unconfirmed)
    if unconfirmed:
        text = f"material exposure below the flanks is for information: {' and '.join(unconfirmed)} as remembered, unconfirmed"
        yield Notice("exposure-unconfirmed", text)
