"""SetSizeTask: what a planetary set has to do, and what it may be."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated

from gearcad.dynamics.planetary.published import PUBLISHED, PublishedFactor
from gearcad.errors import ParameterError
from gearcad.material import Material
from gearcad.notice import Notice
from gearcad.planetary.load import old_torque_notice, torque_key
from gearcad.planetary.search import SearchTask
from gearcad.ranges import Range, Whole
from gearcad.rating.iso6336_5 import EnduranceLimits, endurance_limits
from gearcad.rating.options import RatingOptions
from gearcad.reprs import concise
from gearcad.schema import AssumedNumber, Words, require_fields
from gearcad.sizing.task import ISO_54_I

__all__ = ["SetSizeTask"]

_TORQUE = Range("N·m", 1e-6, 1e9)


@dataclass(frozen=True, kw_only=True)
class SetSizeTask:
    """What a set has to do: `sets` has the ratio and what its teeth may be, in modules of 1 mm; the torque (N·m) is
    `input_torque` or `output_torque`, and `speed` (rpm) is that of the input. `torque` is the old name of `input_torque`.

    All gears are of one `material`, rings of `ring_material` if there is one. K_gamma is that of rules for the number of
    planets (ABS), unless `mesh_load_factor` is given. Face widths are at most `width_ratio` times the diameter of the smallest
    gear, `max_diameter` is the most over all teeth. Of the sets that the search finds the first `considered` are sized.
    Raises ParameterError.
    """

    sets: SearchTask
    input_torque: Annotated[float | None, _TORQUE, Words("torque on the input", "T")] = None
    output_torque: Annotated[float | None, _TORQUE, Words("torque on the output", "T")] = None
    torque: Annotated[float | None, _TORQUE, Words("torque on the input, old name", "T")] = None
    speed: Annotated[float, Range("rpm", 1e-3, 1e6), Words("speed of the input", "n")]
    material: Material
    ring_material: Material | None = None
    application_factor: Annotated[float, Range("", 0.1, 10.0), Words("application factor", "K_A", "ISO 6336-1")] = (
        AssumedNumber(1.0)
    )
    mesh_load_factor: Annotated[float | None, Range("", 1.0, 24.0), Words("mesh load factor", "K_γ", "ISO 6336-1")] = None
    rating: RatingOptions = field(default=RatingOptions())
    modules: tuple[float, ...] = (0.5, 0.6, 0.8, *ISO_54_I)
    max_diameter: Annotated[float | None, Range("mm", 1.0, 1e5), Words("most diameter over all teeth")] = None
    considered: Annotated[int, Whole(1, 10_000), Words("tooth numbers that are sized roughly")] = 120
    width_ratio: Annotated[float, Range("", 0.1, 3.0), Words("most face width over the smallest diameter", "b/d")] = 1.0

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        torque_key(self)
        if not self.modules or any(not 0.05 <= each <= 100 for each in self.modules):
            raise ParameterError("modules", list(self.modules), "must be numbers from 0.05 to 100 mm", "mm")
        object.__setattr__(self, "modules", tuple(sorted(set(self.modules))))
        for name, material in (("material", self.material), ("ring_material", self.ring_material or self.material)):
            limits = _limits(name, material)
            for limit, value in (("contact_endurance_limit", limits.contact), ("root_endurance_limit", limits.root)):
                if value is None:
                    permitted = 'must be given, in MPa, or a material of ISO 6336-5 such as "Eh MQ": nothing can be sized'
                    raise ParameterError(f"{name}.{limit}", None, permitted)

    @property
    def given_torque(self) -> tuple[str, float]:
        """The key of the load that a set has, and its torque (N·m)."""
        key = torque_key(self)
        value: float = getattr(self, key)
        return "input_torque" if key == "torque" else key, value

    @property
    def torque_words(self) -> str:
        """The torque and where it acts, in words."""
        key, value = self.given_torque
        return f"{value:g} N·m on the {key.removesuffix('_torque')}"

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What to know of it: that its torque has its old name."""
        return () if self.torque is None else (old_torque_notice("input_torque"),)

    def material_of(self, name: str) -> Material:
        """That of a gear."""
        return (self.ring_material or self.material) if name.startswith("ring") else self.material

    def factor(self, planets: int) -> float:
        """K_gamma of a number of planets."""
        if self.mesh_load_factor is not None:
            return min(self.mesh_load_factor, float(planets))
        found = PUBLISHED[0].of(planets)
        return min((found or PublishedFactor(source="", factor=1.0, recalled=False)).factor, float(planets))


def _limits(name: str, material: Material) -> EnduranceLimits:
    """Endurance limits; errors begin with the name of the field. Raises ParameterError."""
    try:
        return endurance_limits(material)
    except ParameterError as error:
        raise ParameterError(error.parameter.replace("material", name, 1), error.value, error.permitted, error.unit) from error
