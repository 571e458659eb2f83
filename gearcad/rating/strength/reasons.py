"""Reasons why a flank or a root is not judged: what the standard does not cover, and what is not known."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain

from gearcad.errors import InputError
from gearcad.geometry import GearPair, RackPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.per_gear import PerGear, Role
from gearcad.rating.iso6336_3 import RootRating
from gearcad.rating.iso6336_5 import EnduranceLimits
from gearcad.rating.options import RatingOptions
from gearcad.rating.rim import rim_of
from gearcad.rating.strength.part import Part

__all__ = ["Reasons"]


@dataclass(frozen=True)
class Reasons:
    """Of a pair; `error` is what is in the way of its load factors."""

    pair: GearPair | RackPair
    materials: PerGear[Material]
    load: Load
    options: RatingOptions
    limits: PerGear[EnduranceLimits]
    roots: PerGear[RootRating]
    error: InputError | None

    def of(self, part: Part, role: Role) -> str:
        """The first one; "" for a part that can be judged."""
        own = self._of_flank(role) if part is Part.FLANK else self._of_root(role)
        return next(chain(self._of_material(part, role), own, self._of_load()), "")

    def _of_material(self, part: Part, role: Role) -> Iterator[str]:
        limits, material = self.limits.pick(role), self.materials.pick(role)
        limit, source = (limits.contact, limits.contact_source) if part is Part.FLANK else (limits.root, limits.root_source)
        if limit is None:
            yield f"{'sigma_Hlim' if part is Part.FLANK else 'sigma_Flim'} is {source}"
        elif material.group is None:
            yield "the material has no group, by which the life factor goes"

    def _of_flank(self, role: Role) -> Iterator[str]:
        if (ratio := self.pair.transverse_contact_ratio) > 2:
            yield f"Z_eps, Z_B and Z_D of ISO 6336-2 hold for a transverse contact ratio up to 2, here {ratio:.4g}"
        if self.limits.pick(role.mate).contact is None:
            yield f"sigma_Hlim of the {role.mate.value} is not known, and the oil film goes by the softer gear"

    def _of_root(self, role: Role) -> Iterator[str]:
        if isinstance(self.pair, RackPair) and role is Role.WHEEL:
            return
        gear = self.pair.pinion if role is Role.PINION or isinstance(self.pair, RackPair) else self.pair.wheel
        if thin := rim_of(gear).not_covered():
            yield thin
        if not self.roots.pick(role).section.on_fillet:
            yield "the tangent at 30 deg touches beyond the fillet, so Y_F and Y_S do not hold"

    def _of_load(self) -> Iterator[str]:
        options = self.options
        if not self.load.speed and (isinstance(options.dynamic_factor, str) or options.load_cycles is None):
            yield "the speed is 0 rpm: K_v, Z_v and load cycles are not known (give dynamic_factor and load_cycles)"
        elif options.bins and options.life is None and options.load_cycles is None:
            yield "a load spectrum needs life or load_cycles"
        if self.error is not None:
            yield str(self.error)
