"""Contacts of a mesh found by cutting the exact flanks of both gears with the line of action: no formula of phases in it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from gearcad.core.records import Floats, Role
from gearcad.geometry import Gear
from gearcad.planetary import SetMesh


@dataclass(frozen=True)
class Contacts:
    """`ahead` (n,): how far each contact is past the pitch point as it moves (mm); `radii` (n,): where on the pair's pinion."""

    ahead: Floats
    radii: Floats


@dataclass(frozen=True)
class _Placed:
    """A gear with its axis at `centre`, tooth 0 at `angle`, of which flanks on `side` (1: counter-clockwise one) carry."""

    gear: Gear
    centre: complex
    angle: float
    side: int

    def _ends(self) -> tuple[float, float]:
        ends = sorted((abs(self.gear.form_diameter) / 2, self.gear.profile.tip_form_diameter / 2))
        return ends[0], ends[1]

    def point(self, tooth: int, radius: float) -> complex:
        turn = self.angle + 2 * math.pi * tooth / self.gear.tooth_count
        half = math.radians(float(self.gear.profile.half_angle(radius)))
        return complex(self.centre + radius * np.exp(1j * (turn + self.side * half)))

    def normal(self, radius: float) -> complex:
        """That of the flank of tooth 0 when its point at a radius has come round to angle 0."""
        step = 1e-4
        low, high = (self.point(0, radius + each) for each in (-step, step))
        along = (high - low) / (self.point(0, radius) - self.centre)
        return 1j * along / abs(along)

    def cuts(self, origin: complex, direction: complex) -> dict[int, complex]:
        """Where the flank of each tooth cuts a line, if it does."""
        low, high = self._ends()

        def off(radius: float, tooth: int) -> float:
            return ((self.point(tooth, radius) - origin) / direction).imag

        found = {}
        for tooth in range(self.gear.tooth_count):
            near = abs(self.point(tooth, low) - origin) < 6 * self.gear.transverse_pitch
            if near and off(low, tooth) * off(high, tooth) <= 0:
                found[tooth] = self.point(tooth, brentq(off, low, high, args=(tooth,), xtol=1e-12))
        return found


def contacts(mesh: SetMesh, *, angle: float, psi: float, driver: Role, turning: int) -> Contacts:
    """Contacts where the central's tooth 0 is at `angle`, the planet at `psi` (rad), the central turning ccw (1) or cw (-1).

    The rim is turned until a flank of it passes through a cut of the central's with the line of action.
    """
    pair, central, rim = mesh.pair, mesh.central.gear, mesh.rim.gear
    rim_turning = -turning if mesh.external else turning
    carries = turning if driver is mesh.central_role else -turning
    rim_carries = rim_turning if driver is mesh.rim_role else -rim_turning
    working = abs(pair.working_pitch_diameters.pick(mesh.central_role)) / 2
    origin = working * np.exp(1j * psi)
    placed = _Placed(central, 0j, angle, carries)
    # The common normal at the pitch point is that of the flank there.
    direction = placed.normal(working) * np.exp(1j * psi)
    cut = placed.cuts(origin, direction)
    later = _Placed(central, 0j, angle + turning * 1e-4, carries).cuts(origin, direction)
    tooth = next(each for each in cut if each in later)
    forward = direction * math.copysign(1.0, ((later[tooth] - cut[tooth]) / direction).real)
    centre = abs(pair.centre_distance) * np.exp(1j * psi)
    touched = cut[min(cut, key=lambda each: abs(cut[each] - origin))]
    radius, at = abs(touched - centre), np.angle(touched - centre)
    loose = _Placed(rim, centre, 0.0, rim_carries)
    turned = _Placed(rim, centre, float(at - np.angle(loose.point(0, radius) - centre)), rim_carries)
    mates = np.array(list(turned.cuts(origin, direction).values()))
    # Both touch where both flanks reach the line: in the same points, or they would not roll.
    both = [each for each in cut.values() if abs(mates - each).min() < 1e-6]
    pinion = 0j if mesh.central_role is Role.PINION else centre
    return Contacts(np.array([((each - origin) / forward).real for each in both]), np.abs(np.array(both) - pinion))
