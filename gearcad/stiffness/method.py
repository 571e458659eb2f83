"""Methods of mesh stiffness: what all of them share, and slices of helical pairs side by side.

Slices are springs between the two gears that know nothing of each other. A slice at height y of a helical pair touches at
s + y tan beta_b on the line of action, so over the width of a line the single stiffness k(s) is integrated, exactly.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gearcad.contact.shared.bodies import BodyModel
from gearcad.contact.shared.loaded import width_in_mesh
from gearcad.core.errors import GeometryError, ParameterError, require_whole
from gearcad.core.records import Floats, Notice, PerGear, Role
from gearcad.core.runtime import Expected, Share, unheard
from gearcad.geometry import GearPair, RackPair
from gearcad.geometry.gear import refuse_halves
from gearcad.load import Load
from gearcad.material import Material, Materials, of_both
from gearcad.mesh_cycle import MeshCycle
from gearcad.mounting import Mounting

_NODES = 129
"""Places on the path of contact between which the single pair's compliances are cubic splines: right to 1e-8."""


@dataclass(frozen=True)
class SinglePair:
    """Compliances of one pair of teeth per face width, in mm·µm/N, at places (n,) from T1 on the line of action (mm).

    `parts` sum up to the secant compliance; the tangent compliance is `tangent_less` smaller.
    """

    lengths: Floats
    parts: Mapping[str, Floats]
    tangent_less: float = 0.0

    @property
    def stiffness(self) -> Floats:
        """k (n,) in N/(mm·µm)."""
        result: Floats = 1 / np.sum(list(self.parts.values()), axis=0)
        return result

    @property
    def tangent_stiffness(self) -> Floats:
        """dF/ddelta (n,) in N/(mm·µm)."""
        result: Floats = 1 / (1 / self.stiffness - self.tangent_less)
        return result


class MeshCurves(NamedTuple):
    """Curves of all pairs together, for the fields of a MeshCycle of the same names."""

    roll_angle: Floats
    mesh_stiffness: Floats
    tangent_stiffness: Floats
    pairs: tuple[int, ...]
    load_share: Floats
    compliance_parts: dict[str, Floats]
    single_stiffness: float


@dataclass(frozen=True)
class Slices:
    """The zone of contact of a pair: usable path times common width."""

    pair: GearPair

    @cached_property
    def path(self) -> tuple[float, float]:
        """First and last contact (mm from T1) on involutes of both gears."""
        return self.pair.usable_path

    @property
    def pitch(self) -> float:
        """Transverse base pitch (mm)."""
        return self.pair.pinion.transverse_base_pitch

    @property
    def width(self) -> float:
        """Common face width (mm)."""
        return self.pair.common_width.width

    @property
    def reach(self) -> float:
        """Length (mm) on the line of action over which a line of contact leans across the common width."""
        return self.width * math.tan(math.radians(abs(self.pair.pinion.base_helix_angle)))

    @cached_property
    def lengths(self) -> Floats:
        """Places (n,) on the path where a single pair is wanted (mm from T1)."""
        return np.linspace(*self.path, _NODES)

    def curves(self, single: SinglePair, count: int) -> MeshCurves:
        """Return the curves of the mesh over one base pitch, in about `count` positions."""
        places, active = self._positions(count)
        first, last = self.path[0] - self.reach / 2, self.path[1] + self.reach / 2
        pairs = range(math.ceil((first - places[-1]) / self.pitch), math.floor((last - places[0]) / self.pitch) + 1)
        # Which pairs touch is that of the middle of each piece: at its ends a spur pair would be in doubt.
        at = np.stack(
            [np.where(self._inside(active + pair * self.pitch), places + pair * self.pitch, np.nan) for pair in pairs]
        )
        stiffness = self._over_width(single.stiffness, at)
        total = stiffness.sum(0)
        squared = single.stiffness**2
        parts = {name: self._over_width(squared * part, at).sum(0) / total**2 for name, part in single.parts.items()}
        used = stiffness.max(1) > 0
        roll = np.degrees((places - self.pair.path_of_contact.C) / (self.pair.pinion.base_diameter / 2))
        alone = self._over_width(single.stiffness, np.linspace(first, last, 4 * _NODES)[None])
        return MeshCurves(
            roll_angle=roll,
            mesh_stiffness=total,
            tangent_stiffness=self._over_width(single.tangent_stiffness, at).sum(0),
            pairs=tuple(pair for pair, touches in zip(pairs, used, strict=True) if touches),
            load_share=(stiffness / total)[used].T,
            compliance_parts=parts,
            single_stiffness=float(alone.max()),
        )

    def _inside(self, places: Floats) -> NDArray[np.bool_]:
        first, last = self.path
        found: NDArray[np.bool_] = (places > first - self.reach / 2) & (places < last + self.reach / 2)
        return found

    def _positions(self, count: int) -> tuple[Floats, Floats]:
        """Return the places (n,) of the middle pair over a base pitch, each piece between jumps or bends with both its ends;
        middles.
        """
        centre, pitch = self.pair.path_of_contact.C, self.pitch
        start = centre - pitch / 2
        corners = [end + lean * self.reach / 2 for end in self.path for lean in (-1, 1)]
        inner = {round(float(np.mod(corner - start, pitch)), 12) for corner in corners}
        edges = np.array(sorted({0.0, pitch} | {place for place in inner if 1e-9 * pitch < place < (1 - 1e-9) * pitch}))
        places, middles = [], []
        for low, high in pairwise(edges.tolist()):
            # Odd numbers, for Simpson's rule.
            number = 2 * max(2, round(count * (high - low) / pitch / 2)) + 1
            places.append(start + np.linspace(low, high, number))
            middles.append(np.full(number, start + (low + high) / 2))
        return np.concatenate(places), np.concatenate(middles)

    def _over_width(self, values: Floats, at: Floats) -> Floats:
        """Return the integral over the width of a quantity with `values` at `lengths`, for lines with their middle `at` (nan:
        none).
        """
        from scipy.interpolate import CubicSpline

        spline = CubicSpline(self.lengths, values)
        first, last = self.path
        touching = np.isfinite(at)
        place = np.where(touching, at, first)
        if self.reach == 0:
            found = spline(np.clip(place, first, last)) * self.width
        else:
            ends = (np.clip(place + side * self.reach / 2, first, last) for side in (1, -1))
            upper, lower = map(spline.antiderivative(), ends)
            found = (upper - lower) * self.width / self.reach
        result: Floats = np.where(touching, found, 0.0)
        return result


FEWEST_POSITIONS, MOST_POSITIONS = 12, 5000


@dataclass(frozen=True, kw_only=True)
class StiffnessMethod(ABC):
    """A method for the mesh stiffness of a pair of gears of one material or two: called with a load, it gives the MeshCycle.

    `body` says where the bodies are held, `mounting` how the gears stand; `positions` over one base pitch, 0 for the
    method's own number. Raises ParameterError and GeometryError for what the method cannot treat.
    """

    pair: GearPair | RackPair
    material: Materials = field(default_factory=Material)
    body: BodyModel = field(default_factory=BodyModel)
    mounting: Mounting = field(default_factory=Mounting)
    positions: int = 0
    tell: Share = field(default=unheard, compare=False, repr=False)
    """Hears how much of a long method is done."""

    name: ClassVar[str]
    title: ClassVar[str]
    holds: ClassVar[tuple[str, ...]]
    default_positions: ClassVar[int] = 200
    load_dependent: ClassVar[bool] = True
    no_internal_form: ClassVar[str] = ""
    """Reason why the method has no form for rings, which it refuses."""
    rack_form: ClassVar[bool] = False
    """Whether the method has a form for a pinion and a rack."""
    mean_only: ClassVar[bool] = False
    """True of a method that knows no course over the mesh."""
    load_positions: ClassVar[int] = 48
    """Positions, 0 for as many as ever, at which other loads than that of the pair are tried."""
    seconds: ClassVar[float] = 0.2
    """Expected cost of the method."""

    def __post_init__(self) -> None:
        if not (isinstance(self.positions, int) and self.positions == 0):
            require_whole("positions", self.positions, at_least=FEWEST_POSITIONS, at_most=MOST_POSITIONS)
        refuse_halves(self.pair.pinion, self.name)
        if isinstance(self.pair, RackPair):
            if not self.rack_form:
                raise ParameterError(
                    "pair", "pinion and rack", f"must be two gears for {self.name}, which has no form for racks"
                )
        elif self.pair.internal and self.no_internal_form:
            permitted = f"must be above 0 for {self.name}: {self.no_internal_form}"
            raise GeometryError("wheel.teeth", self.pair.wheel.teeth, permitted)
        ratio = self.engaged.usable_contact_ratio
        if ratio < 1:
            whole = self.engaged.transverse_contact_ratio
            reason = (
                "between two pairs of teeth no tooth would be in contact"
                if whole < 1
                else f"fillets take away what the tips' {whole:.4f} promise"
            )
            raise GeometryError("pair.usable_contact_ratio", ratio, f"must be at least 1 for a mesh stiffness: {reason}")

    def __call__(self, load: Load, positions: int = 0) -> MeshCycle:
        """Return the mesh cycle under a load, at so many `positions` for once if any are given.

        Raises ParameterError without a torque, and what the method's solver raises.
        """
        if not load.torque:
            raise ParameterError("load.torque", load.torque, "must not be 0: stiffness depends on the load", "N·m")
        return self._cycle(load, positions or self.positions or self.default_positions)

    @property
    def expected(self) -> Expected:
        """Seconds and memory that a comparison is expected to take with this method: its cycle under several loads."""
        return Expected(self.seconds, 0.0)

    @abstractmethod
    def _cycle(self, load: Load, count: int) -> MeshCycle: ...

    @property
    def materials(self) -> PerGear[Material]:
        """Materials of both gears."""
        return of_both(self.material)

    @cached_property
    def engaged(self) -> GearPair | RackPair:
        """The pair at the centre distance of its mounting; a pinion and a rack stand at their own mounting distance."""
        return self.pair if isinstance(self.pair, RackPair) else self.mounting.mounted(self.pair)

    @property
    def mounted(self) -> GearPair:
        """The pair of gears at the centre distance of its mounting. Raises TypeError for a pinion and a rack."""
        if isinstance(self.engaged, RackPair):
            raise TypeError("a pinion and a rack are no pair of gears")
        return self.engaged

    @property
    def width(self) -> float:
        """Common face width (mm), on which all of the load is."""
        return width_in_mesh(self.engaged)

    def torque(self, load: Load) -> float:
        """Return the torque that the pinion carries, application factor included (N·m, positive)."""
        return abs(load.torque) * load.application_factor

    def force(self, load: Load) -> float:
        """Return F_bt: the force that all flanks carry together along the line of action (N)."""
        return 2000 * self.torque(load) / self.engaged.pinion.base_diameter

    def inputs(self, load: Load) -> dict[str, Any]:
        """Return the fields of a MeshCycle on its method, the load and the pair, under the names there."""
        return {
            "method": self.name,
            "holds": self.holds,
            "torque": self.torque(load),
            "force": self.force(load),
            "width": self.width,
            "mean_only": self.mean_only,
            "notices": tuple(self.notices(load)),
        }

    def notices(self, load: Load) -> Iterator[Notice]:
        """Yield notices to read before trusting the method with this pair under a load: here what nominal teeth leave out."""
        pair = self.engaged
        gears = [(Role.PINION, pair.pinion)] if isinstance(pair, RackPair) else list(pair.gears.items())
        found = [f"the {role.value}'s flank modifications" for role, gear in gears if gear.modification.present]
        found += ["misalignment and pitch errors"] if self.mounting.tilted or self.mounting.pitch_error else []
        yield from left_out(found)


def left_out(found: Sequence[str]) -> Iterator[Notice]:
    """Yield a notice that a method leaves out these features of a pair, in words, if there are any."""
    if found:
        yield Notice("left-out", f"leaves out {' and '.join(found)}")


@dataclass(frozen=True, kw_only=True)
class SliceMethod(StiffnessMethod):
    """A method that tells how far one pair of teeth gives way, at any place on the line of action."""

    @cached_property
    def slices(self) -> Slices:
        """The zone of contact."""
        return Slices(self.mounted)

    @abstractmethod
    def single(self, lengths: Floats, load: Load) -> SinglePair:
        """Return one pair of teeth that carries all of the load, at places (n,) from T1 on the line of action (mm)."""

    def curvatures(self, lengths: Floats) -> PerGear[Floats]:
        """Return the radii of curvature (n,) of both flanks in the section across the line of contact (mm)."""
        lean = math.cos(math.radians(self.mounted.pinion.base_helix_angle))
        return PerGear(lengths / lean, (self.mounted.base_tangent.length - lengths) / lean)

    @property
    def to_transverse(self) -> float:
        """1000/cos beta_b: from mm²/N of the section across the line of contact to mm·µm/N of the transverse one."""
        return 1000 / math.cos(math.radians(self.mounted.pinion.base_helix_angle))

    def _cycle(self, load: Load, count: int) -> MeshCycle:
        curves = self.slices.curves(self.single(self.slices.lengths, load), count)
        return MeshCycle(
            **self.inputs(load),
            transmission_error=self.force(load) / curves.mesh_stiffness,
            **curves._asdict(),
        )
