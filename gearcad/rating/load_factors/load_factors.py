"""LoadFactors: all load factors of a pair under a load, by ISO 6336-1 or DIN 3990-1."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Material, of_both
from gearcad.notice import Notice
from gearcad.per_gear import PerGear
from gearcad.rating.load_factors.across_face import face_load_factors
from gearcad.rating.load_factors.between_pairs import transverse_load_factors
from gearcad.rating.load_factors.dynamic import dynamic_factor
from gearcad.rating.load_factors.finding import ASSUMED, GIVEN
from gearcad.rating.load_factors.loaded_mesh import LoadedMesh
from gearcad.rating.options import RatingOptions
from gearcad.rating.rate import require_ratable
from gearcad.schema import is_assumed

__all__ = ["BodyLoad", "LoadFactors"]


_OF_BODIES = "ISO 6336-1:2006, Method A: load along the face of solid bodies (finite elements)"


class BodyLoad(NamedTuple):
    """K_Hbeta that solid bodies find, whose flanks stand off by F_beta_y (µm): the mounting's if `mounted`, else C's."""

    factor: float
    misalignment: float
    mounted: bool

    @property
    def said(self) -> str:
        """What was put in, and why it is more than Method C makes of the same."""
        source = "[mounting]" if self.mounted else "Method C, as [mounting] has none"
        return (
            f"K_Hbeta: the solid bodies stand off by F_beta_y = {self.misalignment:.3g} µm of {source}; "
            "their bores are held all along, so that they give way to a tilt less than c_gamma_beta of Method C says"
        )


@dataclass(frozen=True, kw_only=True)
class LoadFactors:
    """K_A, K_gamma, K_v, K_Hbeta, K_Fbeta, K_Halpha and K_Falpha; each is of the load times all before it.

    `details` are the figures behind them under their symbols (µm, N/mm, N/(mm·µm), rpm, kg/mm; a mapping is of both gears),
    `sources` the clause of each factor. `unknown` are symbols of factors in whose place 1 stands, `assumed` what was taken for
    granted, `verify` factors that rest on a text that was not at hand.
    """

    application: float = 1.0
    mesh_load: float = 1.0
    dynamic: float = 1.0
    face_flank: float = 1.0
    face_root: float = 1.0
    transverse_flank: float = 1.0
    transverse_root: float = 1.0
    details: Mapping[str, float | Mapping[str, float]] = field(default_factory=dict)
    sources: Mapping[str, str] = field(default_factory=dict)
    unknown: tuple[str, ...] = ()
    notices: tuple[Notice, ...] = ()
    assumed: tuple[str, ...] = ()
    verify: tuple[str, ...] = ()

    @classmethod
    def of(
        cls,
        pair: GearPair,
        materials: Material | PerGear[Material],
        load: Load,
        options: RatingOptions | None = None,
    ) -> LoadFactors:
        """Of a pair of one material or two, under a load; numbers in the options stand as they are given.

        Raises ParameterError without a torque, for what a method needs and was not given, and beyond the tables of tolerances;
        GeometryError for a pair whose contact the standard does not describe, double helical ones among them.
        """
        require_ratable(pair, load)
        mesh = LoadedMesh(pair=pair, materials=of_both(materials), load=load, options=options or RatingOptions())
        speed = dynamic_factor(mesh)
        mean_load = mesh.specific_load * speed.factors["K_v"]
        face = face_load_factors(mesh, mean_load)
        across = transverse_load_factors(mesh, mean_load * face.factors["K_Hbeta"])
        found = (speed, face, across)
        return cls(
            application=load.application_factor,
            mesh_load=mesh.options.mesh_load_factor,
            dynamic=speed.factors["K_v"],
            face_flank=face.factors["K_Hbeta"],
            face_root=face.factors["K_Fbeta"],
            transverse_flank=across.factors["K_Halpha"],
            transverse_root=across.factors["K_Falpha"],
            details={symbol: value for each in found for symbol, value in each.details.items()},
            sources={
                "K_A": ASSUMED if is_assumed(load.application_factor) else GIVEN,
                "K_gamma": ASSUMED if is_assumed(mesh.options.mesh_load_factor) else GIVEN,
                **{symbol: clause for each in found for symbol, clause in each.sources.items()},
            },
            unknown=tuple(symbol for each in found for symbol in each.unknown),
            notices=tuple(notice for each in found for notice in each.notices),
            assumed=tuple(text for each in found for text in each.assumed),
            verify=tuple(symbol for each in found for symbol in each.verify),
        )

    def with_bodies(self, found: BodyLoad) -> LoadFactors:
        """Of options in which K_Hbeta of a load distribution stands as a number: cited as what it is."""
        return replace(self, sources={**self.sources, "K_Hbeta": _OF_BODIES}, assumed=(*self.assumed, found.said))

    def to_dict(self) -> dict[str, float | None]:
        """Values under their symbols; None of those that are not known."""
        values = {
            "K_A": self.application,
            "K_gamma": self.mesh_load,
            "K_v": self.dynamic,
            "K_Hbeta": self.face_flank,
            "K_Fbeta": self.face_root,
            "K_Halpha": self.transverse_flank,
            "K_Falpha": self.transverse_root,
        }
        return {symbol: None if symbol in self.unknown else value for symbol, value in values.items()}
