"""Options and result of a transient run: the [dynamics.transient] table, courses, greatest forces of every tooth period."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.quantities import DURATION, SAMPLING, SPEED, Choice, Range, Words, require_fields
from gearcad.core.records import Floats, JsonObject, Notice, concise, freeze
from gearcad.dynamics.time_domain.order_tracks import OrderTracks
from gearcad.dynamics.trains.torque_excitation import ORDER

_FACTOR = Range("", -1e3, 1e3)
_SWITCH = {"on": True, "off": False}
_TIME = DURATION._replace(least=0.0)


@dataclass(frozen=True, kw_only=True)
class TransientOptions:
    """Speed and torque over a `duration` (s). Raises ParameterError and GeometryError.

    The speed of the first pinion runs in a straight line from `speed_from` to `speed_to` (rpm; None: what the other is, or the
    speed of the course at one speed), negative where it turns back. All torques and preloads are those of the train times a
    factor: `torque_from`, and from `torque_at` (s; None: half of the duration) on `torque_to` (None: no change), over
    `torque_over` seconds, 0 for a step. Before time 0 the train has settled at what it begins with. `sampling` (Hz; None: 16
    samples a tooth at the greatest speed) is that of the courses: the greatest forces are those of all steps between. With
    `order_tracks` "on" a run whose speed changes has its spectrogram, and the amplitudes of orders along the speed: of the
    teeth, of torques on inertias, and of those in `orders` (of the first pinion's speed).
    """

    speed_from: Annotated[float | None, SPEED, Words("speed at the beginning", "n_1")] = None
    speed_to: Annotated[float | None, SPEED, Words("speed at the end", "n_1")] = None
    duration: Annotated[float, DURATION, Words("how long it takes")] = 1.0
    torque_from: Annotated[float, _FACTOR, Words("factor of the torques at the beginning")] = 1.0
    torque_to: Annotated[float | None, _FACTOR, Words("factor of the torques at the end")] = None
    torque_at: Annotated[float | None, _TIME, Words("when the torques begin to change")] = None
    torque_over: Annotated[float, _TIME, Words("how long the torques change")] = 0.0
    sampling: Annotated[float | None, SAMPLING, Words("samples per second")] = None
    order_tracks: Annotated[str, Choice(tuple(_SWITCH)), Words("whether orders are tracked along the speed")] = "off"
    orders: Annotated[tuple[float, ...], ORDER, Words("more orders that are tracked")] = ()

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        object.__setattr__(self, "orders", tuple(map(float, self.orders)))
        if self.orders and not self.tracked:
            raise ParameterError("orders", list(self.orders), 'must be left out unless order_tracks is "on"')
        if self.torque_to is None and (self.torque_at is not None or self.torque_over):
            key = "torque_over" if self.torque_at is None else "torque_at"
            raise GeometryError(key, getattr(self, key), "needs torque_to, the factor of the torques at the end", "s")
        if self.torque_to is not None and self.changes_at + self.torque_over > self.duration:
            key = "torque_over" if self.torque_over else "torque_at"
            most = self.duration - (self.changes_at if self.torque_over else 0.0)
            permitted = f"must be at most {most:g} s: the torques change within the duration of {self.duration:g} s"
            raise GeometryError(key, getattr(self, key), permitted, "s")

    @property
    def tracked(self) -> bool:
        """Whether orders are tracked along the speed."""
        return _SWITCH[self.order_tracks]

    @property
    def changes_at(self) -> float:
        """Time at which the torques begin to change (s)."""
        return self.duration / 2 if self.torque_at is None else self.torque_at

    @property
    def final_torque(self) -> float:
        """Factor of the torques at the end."""
        return self.torque_from if self.torque_to is None else self.torque_to

    def speeds(self, otherwise: float) -> tuple[float, float]:
        """Return the speeds at the beginning and at the end (rpm); `otherwise` where neither is given."""
        given = [each for each in (self.speed_from, self.speed_to) if each is not None] or [otherwise]
        return given[0], given[-1]


class GreatestLoad(NamedTuple):
    """The greatest load of a mesh or shaft `name` over that at rest under the whole load, when (s), and at what speed (rpm)."""

    name: str
    factor: float
    time: float
    speed: float


class Parting(NamedTuple):
    """A stretch of time (s) in which flanks of `mesh` part at some moment in every tooth period, with the speeds (rpm) there.

    `share` is the part of that time without contact.
    """

    mesh: str
    begin: float
    end: float
    speed_from: float
    speed_to: float
    share: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Transient:
    """Courses of (k,) samples at `time` (s): `speed` of the first pinion (rpm), `torque` as a factor of the load.

    `approach` (k, m) of the flanks in µm, `force` (k, m) between them in N with that of the dampers, `turn` (k, i) of the
    inertias beside their even turning in degrees, `shaft_torque` (k, s) in N·m.

    Of `windows` (w + 1,), times (s) between which a tooth of the first mesh passes or, where it takes longer, a hundredth of
    the duration: `factor` (w, m), the greatest force of the springs of a mesh, on either flanks, over the `static_forces` (m,)
    in N under the whole load, `parted` (w, m) the share of time in which no flanks press, `shaft_factor` (w, s), the greatest
    torque in either sense over the `shaft_references` (s,) in N·m, nan where there are none. All steps of `step` s are looked
    at.

    `names` are those of meshes, inertias and shafts; `parting` says whether flanks may part. `tracks` are the amplitudes of
    orders along the speed, where they were asked for.
    """

    options: TransientOptions
    names: tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]
    static_forces: Floats
    shaft_references: Floats
    time: Floats
    speed: Floats
    torque: Floats
    approach: Floats
    force: Floats
    turn: Floats
    shaft_torque: Floats
    windows: Floats
    window_speed: Floats
    factor: Floats
    parted: Floats
    shaft_factor: Floats
    step: float
    parting: bool
    notices: tuple[Notice, ...]
    tracks: OrderTracks | None = None

    def __post_init__(self) -> None:
        freeze(self)

    @property
    def middles(self) -> Floats:
        """Times (w,) in the middle of the windows (s)."""
        return np.asarray((self.windows[1:] + self.windows[:-1]) / 2, float)

    @property
    def speeds(self) -> tuple[float, float]:
        """Speeds at the beginning and at the end (rpm)."""
        return float(self.speed[0]), float(self.window_speed[-1]) if len(self.speed) < 2 else float(self.speed[-1])

    @property
    def window_torque(self) -> Floats:
        """Factors of the torques (w,) in the middle of the windows."""
        return np.asarray(np.interp(self.middles, self.time, self.torque), float)

    @property
    def whole_load(self) -> NDArray[np.bool_]:
        """Marks (w,) of the windows in which the torques are those of the train."""
        return np.asarray(np.abs(self.window_torque - 1) < 1e-9)

    @property
    def speed_changes(self) -> bool:
        """Whether there is anything to be drawn over speed."""
        return bool(np.ptp(self.window_speed) > 0)

    @property
    def referred_shafts(self) -> list[int]:
        """Indices of the shafts that carry a torque at rest."""
        return [shaft for shaft, column in enumerate(self.shaft_factor.T) if np.isfinite(column).all()]

    @property
    def greatest(self) -> tuple[GreatestLoad, ...]:
        """Greatest load of every mesh."""
        return tuple(self._greatest(self.names[0], self.factor, range(len(self.names[0]))))

    @property
    def greatest_of_shafts(self) -> tuple[GreatestLoad, ...]:
        """Greatest load of every shaft that carries something at rest."""
        return tuple(self._greatest(self.names[2], self.shaft_factor, self.referred_shafts))

    def _greatest(self, names: tuple[str, ...], factors: Floats, which: range | list[int]) -> Iterator[GreatestLoad]:
        for number in which:
            row = int(factors[:, number].argmax())
            time, speed = float(self.middles[row]), float(self.window_speed[row])
            yield GreatestLoad(names[number], float(factors[row, number]), time, speed)

    @property
    def partings(self) -> tuple[Parting, ...]:
        """Stretches of time in which flanks part, mesh by mesh; none for meshes that cannot part."""
        found = []
        for mesh, name in enumerate(self.names[0]):
            apart = np.concatenate([[False], self.parted[:, mesh] > 0, [False]])
            lengths = np.diff(self.windows)
            for begin, end in np.flatnonzero(np.diff(apart.astype(int))).reshape(-1, 2).tolist():
                share = float(np.average(self.parted[begin:end, mesh], weights=lengths[begin:end]))
                times = float(self.windows[begin]), float(self.windows[end])
                speeds = float(self.window_speed[begin]), float(self.window_speed[end - 1])
                found.append(Parting(name, *times, *speeds, share))
        return tuple(found)

    def to_dict(self) -> JsonObject:
        """Return the entry of the run in `dynamics.json`; the courses are arrays."""
        return {
            "speed_from": self.speeds[0],
            "speed_to": self.speeds[1],
            "duration": self.options.duration,
            "torque_from": self.options.torque_from,
            "torque_to": self.options.final_torque,
            "step": self.step,
            "greatest": [each._asdict() for each in self.greatest],
            "greatest_of_shafts": [each._asdict() for each in self.greatest_of_shafts],
            "parted": [each._asdict() for each in self.partings],
            **({} if self.tracks is None else {"order_tracks": self.tracks.to_dict()}),
        }

    def arrays(self) -> dict[str, Floats]:
        """Return the arrays of the .npz file by name."""
        names = "time speed torque approach force turn shaft_torque windows window_speed factor parted shaft_factor".split()
        found = {f"transient_{name}": getattr(self, name) for name in names}
        return found | ({} if self.tracks is None else self.tracks.arrays())
