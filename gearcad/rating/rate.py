"""rate: Hertz, flank stress, root stress and mesh stiffness of a pair under a load."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, ClassVar

from gearcad.errors import GeometryError, ParameterError
from gearcad.geometry import Gear, GearPair, RackPair
from gearcad.geometry.halves import refuse_halves
from gearcad.load import Load
from gearcad.material import Materials, of_both
from gearcad.notice import Notice, texts
from gearcad.per_gear import PerGear
from gearcad.rating.edition_2019 import RECALLED, edition_notices, relieved
from gearcad.rating.editions import Edition
from gearcad.rating.hertz import LineContact
from gearcad.rating.iso6336_1 import MeshStiffness, mesh_stiffness, stiffness_notices
from gearcad.rating.iso6336_2 import FlankRating, elasticity_notices, flank_notices, flank_rating
from gearcad.rating.iso6336_3 import RootMesh, RootRating, loaded_width, root_notices, root_rating
from gearcad.rating.mesh_contact import base_normal_force, pitch_point_contact
from gearcad.rating.options import RatingOptions, RootShift

__all__ = ["Rating", "fillet_notices", "rate", "require_ratable", "scope_notices"]


@dataclass(frozen=True, kw_only=True)
class Rating:
    """All of ISO 6336, Method B, that geometry, material and torque decide. Forces in N, stresses in MPa, widths in mm.

    sigma_H0, sigma_F0 and the Hertz contact at the pitch point are nominal: of the torque itself, without load factors.
    sigma_H and sigma_F include the application factor K_A, and take K_v, K_Hbeta, K_Halpha, K_Fbeta and K_Falpha as 1.
    """

    edition: Edition
    tangential_force: float
    normal_force: float
    application_factor: float
    specific_load: float
    stiffness: MeshStiffness
    flank: FlankRating
    roots: PerGear[RootRating]
    pitch_point: LineContact
    notices: tuple[Notice, ...]
    verify: tuple[str, ...] = ()
    """Symbols of what rests on a text of the standard that was not at hand."""
    names: ClassVar[PerGear[str]] = PerGear("pinion", "wheel")
    """What both are called in documents."""

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    @property
    def contact_stresses(self) -> PerGear[float]:
        """sigma_H (MPa): Z_B or Z_D times sigma_H0 sqrt(K_A) (ISO 6336-2, clause 5)."""
        stress = self.flank.nominal_stress * math.sqrt(self.application_factor)
        return self.flank.contact_factors.map(lambda factor: factor * stress)

    @property
    def root_stresses(self) -> PerGear[float]:
        """sigma_F (MPa): sigma_F0 K_A (ISO 6336-3, clause 5)."""
        return self.roots.map(lambda root: root.nominal_stress * self.application_factor)

    def to_dict(self) -> dict[str, Any]:
        """Values under their symbols, those of one gear under "pinion" and "wheel"; `gearcad.symbols.RATING` has the words."""
        contact, flanks, bending = self.pitch_point, self.contact_stresses, self.root_stresses
        gears = {
            self.names.pick(role): {**root.to_dict(), "sigma_H": flanks.pick(role), "sigma_F": bending.pick(role)}
            for role, root in self.roots.items()
        }
        return {
            "edition": self.edition.value,
            "F_t": self.tangential_force,
            "F_bn": self.normal_force,
            "K_A": self.application_factor,
            "w_t": self.specific_load,
            **self.stiffness.to_dict(),
            **self.flank.to_dict(),
            "rho_C": contact.radius,
            "p_0": contact.peak_pressure,
            "b_H": contact.half_width,
            **gears,
            **({"verify": list(self.verify)} if self.verify else {}),
            "warnings": list(self.warnings),
            "notices": [notice.to_dict() for notice in self.notices],
        }


def rate(
    pair: GearPair,
    material: Materials,
    load: Load,
    options: RatingOptions | None = None,
) -> Rating:
    """Rate a pair of gears, both of one material or each of its own, by Method B.

    F_t is that of the torque at the reference circles. Contact stress and stiffness hold for the common face width. The
    accuracy grade matters for deep teeth only, see `deep_tooth_factor`. Raises ParameterError without a torque, GeometryError
    for a pair whose contact the standard does not describe.
    """
    options = options or RatingOptions()
    edition, materials = options.standard, of_both(material)
    require_ratable(pair, load)
    force = 2000 * abs(load.torque) / pair.pinion.reference_diameter
    specific = force * load.application_factor / pair.common_width.width
    mesh = RootMesh.of(pair, force, edition, max(map(options.grade_of, pair.gears)))
    roots = PerGear.each(lambda role: root_rating(_as_cut(pair.gears.pick(role), options), mesh, loaded_width(pair, role)))
    return Rating(
        edition=edition,
        tangential_force=force,
        normal_force=base_normal_force(pair, load.torque),
        application_factor=load.application_factor,
        specific_load=specific,
        stiffness=mesh_stiffness(pair, materials, specific),
        flank=flank_rating(pair, materials, force, edition),
        roots=roots,
        pitch_point=pitch_point_contact(pair, materials, load.torque),
        verify=_recalled(pair, edition, roots.wheel),
        notices=(
            *scope_notices(pair),
            *_ring_notices(pair),
            *edition_notices(edition, modified=relieved(pair.pinion.modification, pair.wheel.modification)),
            *fillet_notices(pair),
            *stiffness_notices(pair, specific),
            *flank_notices(pair),
            *elasticity_notices(materials),
            *(notice for role, gear in pair.gears.items() for notice in root_notices(gear, role, roots.pick(role), mesh)),
        ),
    )


def _recalled(pair: GearPair, edition: Edition, wheel: RootRating) -> tuple[str, ...]:
    """What of the rating of a ring, or by the edition of 2019, is to be verified."""
    formula = () if wheel.formula is None else ("wheel.formula",)
    ring = ("q_prime", "Z_D", "wheel.Y_B", *formula) if pair.internal else ()
    return (*ring, *(symbol for symbol in RECALLED if edition is Edition.ISO_2019 and symbol not in ring))


def _as_cut(gear: Gear, options: RatingOptions) -> Gear:
    """The gear whose root is rated: as it is thinned, or with the nominal thickness of its teeth."""
    if options.root_shift is RootShift.GENERATING:
        return gear
    return replace(gear, tooth_thinning=0.0, tooth_allowance=None)


def require_ratable(pair: GearPair | RackPair, load: Load) -> None:
    """Raise ParameterError without a torque, GeometryError for a pair whose contact the standard does not describe."""
    refuse_halves(pair.pinion, "a rating")
    if load.torque == 0:
        raise ParameterError("torque", load.torque, "must not be 0 N·m: a rating needs a load", "N·m")
    ratio = pair.transverse_contact_ratio
    if not 1 <= ratio < 3:
        meaning = "nothing touches for part of every pitch" if ratio < 1 else "Method B knows no deeper teeth"
        raise GeometryError("transverse_contact_ratio", ratio, f"must be at least 1 and below 3 for a rating: {meaning}")


def scope_notices(pair: GearPair | RackPair) -> Iterator[Notice]:
    """Where the pair leaves the scope of the whole standard (ISO 6336-1, clause 1)."""
    if not 15 <= (angle := pair.pinion.rack.pressure_angle) <= 25:
        text = f"ISO 6336 is confirmed for pressure angles from 15 to 25 deg, here {angle:g} deg"
        yield Notice("scope-pressure-angle", text)
    if (helix := abs(pair.pinion.helix_angle)) > 30:
        yield Notice("scope-helix-angle", f"ISO 6336 is confirmed for helix angles up to 30 deg, here {helix:g} deg")


def _ring_notices(pair: GearPair) -> Iterator[Notice]:
    """What of the rating of a ring is to be verified."""
    if pair.internal:
        text = (
            "Z_D = 1, Y_B and the root formulas of rings are as remembered of ISO 6336:2006, whose text was not at hand:"
            " verify them before they decide"
        )
        yield Notice("ring-to-verify", text)


def fillet_notices(pair: GearPair | RackPair, felt: float = 1e-9) -> Iterator[Notice]:
    """Whether the fillets do not let the pair have its contact ratio, by more than is `felt`."""
    usable, whole = pair.usable_contact_ratio, pair.transverse_contact_ratio
    if usable < whole - felt:
        text = f"the tips reach {whole:.4f}, which the rating uses, but the fillets leave {usable:.4f} of involute"
        yield Notice("fillets-limit-contact", f"contact ratio: {text}")
