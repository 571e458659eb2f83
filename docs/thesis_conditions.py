"""Conditions under which gearcad meets figures of two theses on the manual's page `papers.md`.

`python docs/thesis_conditions.py` prints as JSON: `table_4`, the finite element rows of Alm's table 4 (N/mm: mean over the
path of contact, greatest, smallest) under the conditions of `tests/reference/test_stiffness_table4.py`; `impact`, the
stiffness of his table 2 from his tables 4 and 5; `simulation`, his (69) beside his simulation; `contact`, appendix 4 of the
Volvo thesis by its own numbers; `teeth`, its tooth stiffness (5.11) by teeth alone, without contact and body. With the
folder of a check of that pair, `fillets`, the mean stress of its fillets.
"""

import json
import math
import sys
from dataclasses import dataclass, replace
from functools import cache, cached_property
from pathlib import Path

import numpy as np

from gearcad import BasicRack, Body, Gear, GearPair, Load, Material
from gearcad.contact.plane.flank import PlaneCompliance
from gearcad.contact.plane.pair import PlanePair, flank_body
from gearcad.contact.plane.sector import Plane, PlaneElasticity
from gearcad.contact.shared.bodies import BodyModel, Cuts
from gearcad.contact.shared.line_of_action import line_of_action
from gearcad.core.records import PerGear
from gearcad.mesh_cycle import MeshCycle
from gearcad.rating.contact_stress import LineContact, reduced_modulus, reduced_radius
from gearcad.stiffness import PlaneStrainContact, PlaneStressContact, PotentialEnergy, StrainEnergy
from gearcad.stiffness.finite_elements import WeightedBody
from gearcad.stiffness.method import SinglePair


def _gear(teeth: int, shift: float, width: float, bore: float) -> Gear:
    """Return a gear of the pre-stage, its tip shortened by 0.0104 m_n."""
    rack, body, tips = BasicRack(root_radius=0.38), Body(bore=bore), (135 - 134.25) / 1.5 - 0.5104
    return Gear(
        teeth=teeth, normal_module=1.5, face_width=width, profile_shift=shift, tip_alteration=tips, rack=rack, body=body
    )


PAIR = GearPair(pinion=_gear(18, 0.3422, 15.0, 12.0), wheel=_gear(161, 0.1682, 10.0, 120.0), centre_distance=135.0)
LOAD = Load(torque=12.7)
STEEL = Material(youngs_modulus=206000.0, poisson_ratio=0.3)
POSITIONS = 20
"""A degree apart."""


def three_teeth(pinion_depth: float = 4.0, wheel_depth: float = 4.0) -> BodyModel:
    """Held so many m_n below the root circles."""
    pinion, wheel = (
        gear.root_diameter - 2 * depth * gear.normal_module
        for gear, depth in ((PAIR.pinion, pinion_depth), (PAIR.wheel, wheel_depth))
    )
    return BodyModel(teeth=3, cuts=Cuts.FIXED, inner_diameters=PerGear(pinion, wheel))


THREE, WHOLE = three_teeth(), BodyModel()
AS_WIDE, COMMON, WIDEST = (15.0, 10.0), (10.0, 10.0), (15.0, 15.0)


@cache
def bodies(plane: Plane, body: BodyModel, widths: tuple[float, float]) -> PerGear[PlaneCompliance]:
    """Plane bodies of pinion and wheel, `widths` (mm) thick: on 10 mm in contact, that is a modulus so much greater."""
    pinion, wheel = (
        flank_body(gear, radius, PlaneElasticity(replace(STEEL, youngs_modulus=20600.0 * width), plane), body, 1)
        for gear, radius, width in zip((PAIR.pinion, PAIR.wheel), body.inner_radii(PAIR), widths, strict=True)
    )
    return PerGear(pinion, wheel)


@dataclass(frozen=True, kw_only=True)
class OfWidths(StrainEnergy):
    """Strain energy of bodies of the `widths` (mm)."""

    widths: tuple[float, float] = COMMON

    @cached_property
    def bodies(self) -> PerGear[list[WeightedBody]]:
        pinion, wheel = bodies(self.plane, self.body, self.widths)
        return PerGear([(1.0, pinion)], [(1.0, wheel)])


class EvenPressure(OfWidths):
    """With a pressure that is even over Hertz's width."""

    def single(self, lengths: np.ndarray, load: Load) -> SinglePair:
        ellipse = super().single(lengths, load)
        # The mean of ln|x - y| is ln(2 a) - 3/2 over an even pressure, ln(a/2) - 1/4 over an ellipse.
        softer = 2 / math.pi * (math.log(4) - 1.25) * sum(1 / body.elasticity.modulus for ((_, body),) in self.bodies)
        return replace(ellipse, parts={**ellipse.parts, "even pressure": np.full(len(lengths), -1000 * softer)})


class EvenPressureInPlaneStress(EvenPressure):
    plane = Plane.STRESS


@cache
def cycle(method: str, body: BodyModel = THREE, widths: tuple[float, float] = AS_WIDE) -> MeshCycle:
    if method == "strain-energy":
        energy = EvenPressure(pair=PAIR, material=STEEL, body=body, widths=widths)
        return energy(LOAD)
    kind = PlaneStressContact if method == "plane-stress" else PlaneStrainContact
    model = PlanePair(PAIR, line_of_action(PAIR, 0.0), bodies(kind.plane, body, widths))
    contact = kind(pair=PAIR, material=STEEL, body=body, bodies=model, positions=POSITIONS)
    return contact(LOAD)


def path_mean(of: MeshCycle) -> float:
    """Mean over the path of contact (N/µm), as the thesis plots its curves."""
    path, base_radius = PAIR.path_of_contact, PAIR.pinion.base_diameter / 2
    places = np.linspace(path.A, path.E, 2001)
    return float(np.mean(of.stiffness_at(np.degrees((places - path.C) / base_radius))))


def row(of: MeshCycle) -> tuple[float, float, float]:
    """As in the table (N/µm)."""
    return path_mean(of), of.maximum, of.minimum


# ------------------------------------------------------------------ the other figures


_ON_PLANET = 1600 / 3 * 21 / 72
MESHES = {
    "1-2": (12.7, 18, 1.5, 181.640),
    "3-4": (_ON_PLANET, 22, 2.8, 314.547),
    "3p-5": (_ON_PLANET, 21, 2.6, 300.683),
}
"""Torque on the pinion (N·m), its teeth and normal module (mm), and the mean stiffness (N/µm) of Alm's tables 4 and 5."""


def impact() -> dict[str, float]:
    """Return K (N/mm^1.5) of MSC ADAMS's contact function: (68) with the approach F/K_m, so K_m^1.5/sqrt(F).

    `deflection` (mm) is the greatest of a mesh with it.
    """
    cosine = math.cos(math.radians(20.0))
    forces = {name: 2000 * torque / (teeth * module * cosine) for name, (torque, teeth, module, _) in MESHES.items()}
    found = {name: (1000 * MESHES[name][-1]) ** 1.5 / math.sqrt(force) for name, force in forces.items()}
    return found | {"deflection": (forces["3p-5"] / found["3p-5"]) ** (1 / 1.5)}


def simulation() -> dict[str, float]:
    """Return Alm's (69), the speed that it gives (rad/s), and how far his simulation's mean is from it (%)."""
    ratio = 1 / (18 / 161 * (21 * -70 / (-72 * 22) - 1))
    return {
        "ratio": ratio,
        "speed": 100 / ratio,
        "ratio_of_printed_speed": -100 / 0.8062,
        "percent": 100 * (1 - 124.043 / -ratio),
    }


def contact() -> dict[str, float]:
    """Return appendix 4 of the Volvo thesis: Hertz's line contact by its own numbers, and what lies below it."""
    modulus = reduced_modulus((205000.0,) * 2, (0.3,) * 2)
    printed = LineContact(load_per_width=9659.7 / 16.83, radius=reduced_radius((7.34, 24.84)), modulus=modulus)
    depth, shear = printed.greatest_shear
    von_mises_depth, von_mises = printed.greatest_von_mises
    below = printed.stresses(np.linspace(0.0, 6 * printed.half_width, 6001))
    # The thesis's axes: x along the line of contact, y across it, z into the tooth.
    pairs = {"xy": (below.sigma_y, below.sigma_x), "xz": (below.sigma_y, below.sigma_z), "yz": (below.sigma_x, below.sigma_z)}
    return {
        "half_width": printed.half_width,
        "half_width_1.52": 1.52 * math.sqrt(9659.7 / 16.83 / 205000 * printed.radius),
        "force_of_long_line": 16.83 / 25.12 * 14417.83,
        "peak_pressure": printed.peak_pressure,
        "depth_of_greatest_shear": depth / printed.half_width,
        "greatest_shear": shear,
        "shear_at_a": float(printed.stresses(printed.half_width).largest_shear) / shear,
        **{f"greatest_shear_{name}": float(np.abs(one - other).max()) / 2 for name, (one, other) in pairs.items()},
        "greatest_von_mises": von_mises,
        "depth_of_greatest_von_mises": von_mises_depth / printed.half_width,
    }


def volvo_pair() -> GearPair:
    """Return the pair of the Volvo thesis, its table 2."""
    pinion, wheel = (
        Gear(
            teeth=teeth,
            normal_module=2.5,
            face_width=width,
            helix_angle=helix,
            profile_shift=shift,
            tooth_thinning=thinning,
            rack=BasicRack(root_radius=radius),
        )
        for teeth, width, helix, shift, thinning, radius in (
            (13, 18.3, 28.0, 0.107, 0.08, 0.48),
            (44, 15.1, -28.0, -0.378, 0.16, 0.32),
        )
    )
    return GearPair(pinion=pinion, wheel=wheel, centre_distance=80.0)


def fillets(folder: Path) -> dict[str, float]:
    """Return the mean von Mises stress over the fillets of the loaded teeth (MPa at 120 N·m), as the thesis takes it.

    `folder` is that of `gearcad check` at 220 N·m. The nodes are those of the surface between root and form circle.
    """
    import meshio

    found = {}
    for role, gear in volvo_pair().gears.items():
        mesh = meshio.read(folder / f"stress_{role.value}.vtu")
        cells, (x, y, z) = mesh.cells[0].data, mesh.points.T
        corners = [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
        faces, times = np.unique(np.sort(cells[:, corners].reshape(-1, 4), axis=1), axis=0, return_counts=True)
        outside = np.unique(faces[times == 1])
        radius, inside = np.hypot(x, y)[outside], (z[outside] > _EDGE) & (z[outside] < gear.face_width - _EDGE)
        on_fillet = inside & (radius > gear.root_diameter / 2 - _CHORD) & (radius < gear.form_diameter / 2)
        found[role.value] = float(mesh.point_data["von_mises_MPa"][outside[on_fillet]].mean()) * 120 / 220
    return found


_EDGE, _CHORD = 1e-6, 2e-3
"""Distance (mm) from the ends of a tooth of nodes that are inside, and below the root circle of nodes that are on it."""


def teeth() -> dict[str, float]:
    """Return the stiffness of the Volvo pair's teeth at the pitch point, alone and both in series, in N/(mm·µm)."""
    pair = volvo_pair()
    method, place = PotentialEnergy(pair=pair, material=Material(youngs_modulus=205000.0)), pair.path_of_contact.C
    parts = method.single(np.array([place]), Load(torque=220.0)).parts
    alone = [sum(float(parts[f"{gear} {part}"][0]) for part in ("bending", "shear", "axial")) for gear in ("pinion", "wheel")]
    radii = (radius[0] for radius in method.curvatures(np.array([place])))
    return {
        "pinion": 1 / alone[0],
        "wheel": 1 / alone[1],
        "both": 1 / sum(alone),
        "deflection_pinion": 7750 / 16.21 * alone[0],
        "deflection_wheel": 7750 / 16.21 * alone[1],
        "printed_in_series": 1 / (1 / 68.3 + 1 / 55.6),
        "radius_pinion": float(next(radii)),
        "radius_wheel": float(next(radii)),
        "whole_line": pair.common_width.width / math.cos(math.radians(pair.pinion.base_helix_angle)),
    }


def table_4() -> dict[str, dict[str, float]]:
    """Return the rows of table 4 by finite elements under the thesis's conditions (N/mm)."""
    names = ("strain-energy", "plane-stress", "plane-strain")
    return {name: dict(zip(("mean", "max", "min"), (1000 * each for each in row(cycle(name))), strict=True)) for name in names}


if __name__ == "__main__":
    found: dict[str, object] = {"table_4": table_4(), "impact": impact(), "simulation": simulation(), "contact": contact()}
    found["teeth"] = teeth()
    if sys.argv[1:]:
        found["fillets"] = fillets(Path(sys.argv[1]))
    print(json.dumps(found, indent=1))
