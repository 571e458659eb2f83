"""SearchTask: the ratio wanted of a planetary set, and what its gears may be."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, NamedTuple

from gearcad.errors import ParameterError
from gearcad.planetary.mesh import SetType
from gearcad.ranges import Range, Whole
from gearcad.reprs import concise
from gearcad.schema import Words, require_fields

__all__ = ["MEMBERS", "MOST_SHIFT_SUM", "Roles", "SearchTask"]

MOST_SHIFT_SUM = 1.2
"""What profile shifts of a mesh add up to at the most, to make a set coaxial: 0 to this at a sun, 0 to minus this in a ring."""

MEMBERS = {
    SetType.A: ("sun", "ring", "carrier"),
    SetType.B: ("sun", "ring", "carrier"),
    SetType.C: ("sun", "sun_2", "carrier"),
    SetType.D: ("ring", "ring_2", "carrier"),
}
"""Names of the members of each type: central a, central b, carrier."""

_RATIO = Range("", -1e4, 1e4)
_LEAST_RATIO = 1e-4
_TOLERANCE = Range("%", 0.0, 1000.0)
_TEETH = Whole(5, 500)
_MODULE = Range("mm", 0.01, 200.0)
"""As of a Gear."""

_LENGTH = Range("mm", 0.0, None, ends="(]")


class Roles(NamedTuple):
    """Names of the members that are driven, that drive, and that are held."""

    input: str
    output: str
    fixed: str


_USUAL = {
    SetType.A: Roles(input="sun", output="carrier", fixed="ring"),
    SetType.B: Roles(input="sun", output="carrier", fixed="ring"),
    SetType.C: Roles(input="carrier", output="sun_2", fixed="sun"),
    SetType.D: Roles(input="carrier", output="ring_2", fixed="ring"),
}


@dataclass(frozen=True, kw_only=True)
class SearchTask:
    """What to look for. Lengths in mm, angles in degrees.

    `ratio` is speed of the input over speed of the output, negative where they turn against each other, met within
    `tolerance` (%). `planets`, `teeth` (of suns and planets) and `ring_teeth` are least and most. `module_2` is that of the
    second mesh of a stepped planet, None the same. `fixed`, `input` and `output` name sun, ring, carrier, sun_2 or ring_2;
    what is left out is as usual: the sun drives the carrier in a fixed ring, and of two suns or two rings the first is
    fixed and the carrier drives the second. `diameter` is the most over all teeth; `face_width` None is 10 modules, and
    `tip_distance` between neighbouring planets None is 1 module. Raises ParameterError.
    """

    ratio: Annotated[float, _RATIO, Words("ratio wanted", "i")]
    module: Annotated[float, _MODULE, Words("normal module of the first mesh", "m_n")]
    types: tuple[SetType, ...] = (SetType.A,)
    planets: tuple[int, int] = (3, 5)
    module_2: Annotated[float | None, _MODULE, Words("normal module of the second mesh")] = None
    fixed: str | None = None
    input: str | None = None
    output: str | None = None
    tolerance: Annotated[float, _TOLERANCE, Words("most deviation of the ratio")] = 1.0
    teeth: tuple[int, int] = (17, 100)
    ring_teeth: tuple[int, int] = (30, 200)
    diameter: Annotated[float | None, _LENGTH, Words("most diameter over all teeth")] = None
    helix_angle: Annotated[float, Range("deg", -75, 75), Words("helix angle of the first central", "β")] = 0.0
    face_width: Annotated[float | None, _LENGTH, Words("face width", "b")] = None
    tip_distance: Annotated[float | None, Range("mm", 0.0, None), Words("least distance between planets")] = None
    mesh_efficiency: Annotated[float, Range("", 0.0, 1.0, ends="(]"), Words("efficiency of a mesh", "η")] = 0.99

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        if abs(self.ratio) < _LEAST_RATIO:
            raise ParameterError("ratio", self.ratio, f"must be at least {_LEAST_RATIO:g} in size")
        if not self.types:
            raise ParameterError("types", self.types, "must have one of A, B, C, D")
        for name, kind in (("planets", Whole(1, 24)), ("teeth", _TEETH), ("ring_teeth", _TEETH)):
            self._check_ends(name, kind)
        if self.ring_teeth[1] <= self.teeth[0] and set(self.types) != {SetType.C}:
            raise ParameterError("ring_teeth", self.ring_teeth, f"must reach above {self.teeth[0]}, the least of the planets")
        if self.module_2 is not None and set(self.types) == {SetType.A}:
            raise ParameterError("module_2", self.module_2, "is of types B, C and D: planets of type A have one rim", "mm")
        for each in self.types:
            self.roles(each)

    def _check_ends(self, name: str, kind: Whole) -> None:
        """A least and a most."""
        given = getattr(self, name)
        if not isinstance(given, tuple) or len(given) != 2:
            raise ParameterError(name, given, "must be two whole numbers, the least and the most")
        for end in given:
            kind.require(name, end)
        if given[0] > given[1]:
            raise ParameterError(name, given, "must have the least first")

    @property
    def modules(self) -> tuple[float, float]:
        """Of the first and the second mesh (mm)."""
        return self.module, self.module if self.module_2 is None else self.module_2

    @property
    def width(self) -> float:
        """Face width (mm)."""
        return 10 * self.module if self.face_width is None else self.face_width

    @property
    def least_distance(self) -> float:
        """Between the tips of neighbouring planets (mm)."""
        return self.module if self.tip_distance is None else self.tip_distance

    def roles(self, kind: SetType) -> Roles:
        """Of a type: those given, then the usual ones as far as they are free, then what is left. Raises ParameterError."""
        members = MEMBERS[kind]
        given: dict[str, str] = {}
        for role in Roles._fields:
            name = getattr(self, role)
            if name is None:
                continue
            if name not in members:
                raise ParameterError(role, name, f"must be {', '.join(members)} in a set of type {kind.value}")
            if name in given.values():
                raise ParameterError(role, name, "must be another member than the other roles have")
            given[role] = name
        usual = {
            role: name for role, name in _USUAL[kind]._asdict().items() if role not in given and name not in given.values()
        }
        found = given | usual
        left = [name for name in members if name not in found.values()]
        return Roles(**found, **dict(zip([role for role in Roles._fields if role not in found], left, strict=True)))
