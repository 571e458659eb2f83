"""Harmonic torques on the inertias of a train, beside its teeth: an order of a speed, or a torque over an angle."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import Annotated, Any, NamedTuple

import numpy as np

from gearcad.core.errors import GeometryError, ParameterError, is_finite_number, require_name
from gearcad.core.quantities import ELSEWHERE, TORQUE, InPlaceOf, NamedPart, Range, Words
from gearcad.core.records import JsonObject, concise

ORDER = Range("", 1e-3, 1e4)
"""Permitted orders of a speed: 0.5 for every second turn, 48 for a motor with 48 slots."""

_FINEST = 1000
"""Greatest denominator of an order: 0.3333 becomes 1/3, so that a common period exists."""

_EVEN = 0.02
"""Relative difference of the steps between angles below which they are even: tables have few digits."""

_WHOLE = 1e-3
"""Part of a turn by which the angles of a curve may miss a whole number of turns."""

_LEAST, _MOST = 1e-3, 64
"""Part of the greatest harmonic of a curve that another one must have to be kept, and greatest number of harmonics."""


class TorqueHarmonic(NamedTuple):
    """The torque Re(`amplitude` e^(i `order` angle)) in N·m, over the angle (rad) that its inertia has turned."""

    order: Fraction
    amplitude: complex


@dataclass(frozen=True, kw_only=True)
class TorqueCurve:
    """A torque (N·m) at even steps of `angle` (deg) over one or more whole turns of an inertia, as a table holds it.

    The last angle may be that of the first one period later; the torque is then the mean of both. Raises ParameterError and
    GeometryError.
    """

    angle: tuple[float, ...]
    torque: tuple[float, ...]

    __repr__ = concise

    def __post_init__(self) -> None:
        for name in ("angle", "torque"):
            values = getattr(self, name)
            if not isinstance(values, list | tuple | np.ndarray) or not all(map(is_finite_number, map(float, values))):
                raise ParameterError(name, values, "must be finite numbers")
            object.__setattr__(self, name, tuple(map(float, values)))
        if len(self.angle) != len(self.torque) or len(self.angle) < 4:
            raise ParameterError("angle", f"{len(self.angle)} values", "must be four at least, with one torque each")
        steps = np.diff(self.angle)
        step = float(steps.mean())
        if step <= 0 or np.abs(steps - step).max() > _EVEN * step:
            raise ParameterError("angle", float(steps.min()), "is the least step of the angles: they must rise evenly", "deg")
        if not self.turns:
            permitted = "must be a whole number of turns, such as 360 or 720 deg: the torque comes again with it"
            raise GeometryError("angle", self.angle[-1] - self.angle[0], permitted, "deg")

    @property
    def closed(self) -> bool:
        """Whether the last angle is the first one again, a period later."""
        return _whole_turns((self.angle[-1] - self.angle[0]) / 360) > 0

    @property
    def turns(self) -> int:
        """Turns after which the torque comes again; 0 if they are not whole."""
        span, count = self.angle[-1] - self.angle[0], len(self.angle)
        return _whole_turns(span / 360) or _whole_turns(span * count / (count - 1) / 360)

    @property
    def mean(self) -> float:
        """Mean torque (N·m)."""
        return float(np.mean(self._samples))

    @property
    def _samples(self) -> list[float]:
        """Torques of one period, each once."""
        if not self.closed:
            return list(self.torque)
        return [(self.torque[0] + self.torque[-1]) / 2, *self.torque[1:-1]]

    @property
    def harmonics(self) -> tuple[TorqueHarmonic, ...]:
        """Harmonics by FFT, without the mean: those of a thousandth of the greatest at least, and at most 64."""
        spectrum = 2 * np.fft.rfft(self._samples, norm="forward")
        kept = np.arange(1, (len(self._samples) - 1) // 2 + 1)
        sizes = np.abs(spectrum[kept])
        kept = kept[sizes >= max(_LEAST * float(sizes.max(initial=0.0)), 1e-300)]
        kept = np.sort(kept[np.argsort(-np.abs(spectrum[kept]), kind="stable")][:_MOST])
        begin = math.radians(self.angle[0])
        orders = [Fraction(int(number), self.turns) for number in kept]
        return tuple(
            TorqueHarmonic(order, complex(spectrum[number]) * cmath.exp(-1j * float(order) * begin))
            for number, order in zip(kept, orders, strict=True)
        )


def _whole_turns(turns: float) -> int:
    """Return the whole number that turns are, or 0."""
    return round(turns) if abs(turns - round(turns)) <= _WHOLE else 0


@dataclass(frozen=True, kw_only=True)
class TorqueExcitation(NamedPart):
    """A torque on an inertia of a train, named `inertia`, that comes again with its turns, beside the torques at rest.

    Either `amplitude` (N·m) cos(`order` angle + `phase`) with the angle that the inertia has turned, in its own sense, from
    phase 0 of the meshes on, and `phase` in degrees; or a `file`: a TorqueCurve, of which the mean is left out. Torques are
    counter-clockwise positive. Raises ParameterError and GeometryError.
    """

    name: str
    inertia: Annotated[str, Words("inertia on which it acts")]
    order: Annotated[float | None, ORDER, Words("order of the inertia's speed"), InPlaceOf("file")] = None
    amplitude: Annotated[float | None, TORQUE, Words("amplitude of the torque"), InPlaceOf("file")] = None
    phase: Annotated[float, Range("deg", -360.0, 360.0), Words("phase at angle 0")] = 0.0
    file: Annotated[TorqueCurve | None, Words("file of the torque over the angle"), ELSEWHERE] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        self._check_fields()
        require_name(f"{self.name}.inertia", self.inertia)
        if self.file is None:
            return
        if not isinstance(self.file, TorqueCurve):
            raise ParameterError(f"{self.name}.file", self.file, "must be a TorqueCurve: a torque over the angle")
        for key, unit in (("order", ""), ("amplitude", "N·m"), ("phase", "deg")):
            if (value := getattr(self, key)) != getattr(TorqueExcitation, key):
                raise GeometryError(f"{self.name}.{key}", value, "must be left out beside file, which has it", unit)

    @property
    def harmonics(self) -> tuple[TorqueHarmonic, ...]:
        """Harmonics of the torque, by rising order."""
        if self.file is not None:
            return self.file.harmonics
        assert self.order is not None and self.amplitude is not None  # one of the two is given
        order = Fraction(self.order).limit_denominator(_FINEST)
        return (TorqueHarmonic(order, self.amplitude * cmath.exp(1j * math.radians(self.phase))),)

    def document(self) -> JsonObject:
        """Return the entry of documents: orders, amplitudes (N·m) and phases (deg) of the harmonics."""
        return {
            "inertia": self.inertia,
            "order": [float(each.order) for each in self.harmonics],
            "amplitude": [abs(each.amplitude) for each in self.harmonics],
            "phase": [math.degrees(cmath.phase(each.amplitude)) for each in self.harmonics],
            **({} if self.file is None else {"mean_left_out": self.file.mean}),
        }


def require_excitations(excitations: Iterable[Any], inertias: Iterable[str]) -> None:
    """Raise ParameterError for an excitation of an unknown inertia, or for a name that stands twice."""
    known, taken = list(inertias), set[str]()
    for each in excitations:
        if each.inertia not in known:
            permitted = f"must be one of the inertias {', '.join(known)}"
            raise ParameterError(f"{each.name}.inertia", each.inertia, permitted)
        if each.name in taken:
            raise ParameterError("excitations.name", each.name, "names must differ")
        taken.add(each.name)
