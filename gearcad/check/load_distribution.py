"""K_Hbeta by Method A of ISO 6336-1: from the load along the face width of solid bodies."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

from gearcad.arrays import Floats, freeze
from gearcad.check.convergence import FEW_POSITIONS
from gearcad.check.options import CheckOptions, Model
from gearcad.check.solid.run import solid_model
from gearcad.check.task import check_task
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.contact.solid.pair import SolidPair
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Materials, of_both
from gearcad.mounting import Mounting
from gearcad.progress import Share, unheard
from gearcad.rating.load_factor_options import HelixModification
from gearcad.rating.load_factors import BodyLoad
from gearcad.rating.load_factors.across_face import Misalignment
from gearcad.rating.load_factors.dynamic import dynamic_factor
from gearcad.rating.load_factors.loaded_mesh import LoadedMesh
from gearcad.rating.options import RatingOptions
from gearcad.rating.rate import require_ratable

__all__ = ["LoadDistribution", "load_distribution"]

COARSE = 0.5
"""How much finer than in a check the elements are. K_Hbeta is then up to 3 % larger (spur and helical pairs, measured)."""


@dataclass(frozen=True, kw_only=True)
class LoadDistribution:
    """`face_load_factor` K_Hbeta of a pair under `torque` (N·m on the pinion, with K_A, K_gamma and K_v).

    `load` (n,) is the load per width (N/mm), mean of a mesh cycle, at places `across` (n,) in mm from the middle of the common
    face width. `misalignment` (µm) is F_beta_y in the plane of action, positive if the gap grows towards larger z, and that of
    the mounting if `mounted`.
    """

    face_load_factor: float
    misalignment: float
    mounted: bool
    torque: float
    across: Floats
    load: Floats

    def __post_init__(self) -> None:
        freeze(self)

    @property
    def body_load(self) -> BodyLoad:
        """What a rating takes of it."""
        return BodyLoad(factor=self.face_load_factor, misalignment=abs(self.misalignment), mounted=self.mounted)

    def to_dict(self) -> dict[str, Any]:
        """As documents have it."""
        return {
            "K_Hbeta": self.face_load_factor,
            "F_betay": self.misalignment,
            "torque": self.torque,
            "across": self.across.tolist(),
            "load": self.load.tolist(),
        }


def load_distribution(
    pair: GearPair,
    material: Materials,
    load: Load,
    rating: RatingOptions | None = None,
    *,
    mounting: Mounting | None = None,
    check: CheckOptions | None = None,
    tell: Share = unheard,
) -> LoadDistribution:
    """The worst distribution of the load along the face width, on coarse solid bodies with their flank modifications.

    The flanks stand off by the misalignment of the mounting or, where that is 0, by F_beta_x of Method C, to the worse side,
    with B_1 = B_2 = 1; y_beta runs in. The bodies are held all along their width, so that shafts and the pinion itself give
    way in f_sh alone. `check` says how the bodies are held. Raises ParameterError, GeometryError and SolverError.
    """
    options, mounting = rating or RatingOptions(), mounting or Mounting()
    plain = replace(options, helix_modification=HelixModification.NONE)  # the flanks have their own
    mesh = LoadedMesh(pair=mounting.mounted(pair), materials=of_both(material), load=load, options=plain)
    require_ratable(mesh.pair, load)
    speed_factor = dynamic_factor(mesh).factors["K_v"]
    off = _standing_off(mesh, mounting, speed_factor)
    torque = load.torque * load.application_factor * options.mesh_load_factor * speed_factor
    asked = replace(check or CheckOptions(), model=Model.SOLID.value, refinement=COARSE, convergence="off", torques=())
    model = solid_model(check_task(pair, material, Load(torque=torque), asked, mounting, options), tell=tell)
    sides = (off,) if mounting.misalignment or not off else (off, -off)
    found = [_distribution(model, torque, side, mounted=bool(mounting.misalignment)) for side in sides]
    return max(found, key=lambda each: each.face_load_factor)


def _standing_off(mesh: LoadedMesh, mounting: Mounting, speed_factor: float) -> float:
    """F_beta_y (µm): of the mounting, with its sign, or of what Method C takes shafts and manufacture for."""
    initial = mounting.misalignment or Misalignment.of(mesh, mesh.specific_load * speed_factor).initial
    return initial - math.copysign(float(mesh.wear.beta(abs(initial), mesh.speed)), initial)


def _distribution(model: SolidPair, torque: float, misalignment: float, *, mounted: bool) -> LoadDistribution:
    """By a few positions of a mesh cycle, with another misalignment (µm)."""
    mounting = replace(model.mounting, misalignment=misalignment)
    cycle = SolidCycle.run(model.remade(model.pair, mounting), abs(torque), FEW_POSITIONS)
    across, carried = cycle.load_along_face
    # Where flanks part the ends carry what there is: then they are no longer left out.
    factor = cycle.face_load_factor if (carried > 0).all() else float(carried.max() / carried.mean())
    return LoadDistribution(
        face_load_factor=max(factor, 1.0),
        misalignment=misalignment,
        mounted=mounted,
        torque=torque,
        across=across,
        load=carried,
    )
