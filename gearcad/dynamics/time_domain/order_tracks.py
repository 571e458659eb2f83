"""Order tracking of a run in time: the spectrogram, and the amplitudes of orders along the speed.

A signal is multiplied with e^(-i order angle), and its mean is taken over whole turns under Hann's window in the angle. Other
orders of the common period then have no part in it (the Fourier transform over the angle: R. Potter and M. Gribler, Computed
order tracking obsoletes older methods, SAE 891131).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from gearcad.core.records import Floats, JsonObject, freeze
from gearcad.dynamics.trains.speed_orders import SpeedOrder

_LEAST_TURNS = 4.0
"""Turns of a window, at least."""

_WINDOWS = 4
"""Windows that must fit in a run, one behind the other."""

_PLACES = 400
"""Places along the run at which amplitudes are given."""

_COLUMNS, _SEGMENTS, _LEAST_SEGMENT = 300, 60, 64
"""Columns of a spectrogram; segments of its transforms in a run, and samples of one at least."""

_ABOVE = 1.15
"""Highest frequency of a spectrogram over that of the highest order at the greatest speed."""


class TrackedPeak(NamedTuple):
    """The greatest amplitude of an order in a run: of a mesh (force, N) or shaft (torque, N·m), and the speed (rpm) there."""

    name: str
    quantity: str
    unit: str
    order: float
    source: str
    amplitude: float
    speed: float


@dataclass(frozen=True, kw_only=True, eq=False)
class OrderTracks:
    """Amplitudes of `orders` (k,) in a run, at `speeds` (w,) in rpm and `time` (w,) in s.

    Each is that of a window of so many `turns` of the first pinion.
    `forces` (w, k, m) are those between flanks in N, `torques` (w, k, n) those of shafts in N·m. The spectrograms `force_map`
    (c, f, m) and `torque_map` (c, f, n) hold amplitudes at `map_speeds` (c,) in rpm and `frequency` (f,) in Hz. `names` are
    those of meshes, inertias and shafts.
    """

    time: Floats
    speeds: Floats
    turns: float
    orders: tuple[SpeedOrder, ...]
    forces: Floats
    torques: Floats
    map_speeds: Floats
    frequency: Floats
    force_map: Floats
    torque_map: Floats
    names: tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]

    def __post_init__(self) -> None:
        freeze(self)

    @property
    def greatest(self) -> tuple[TrackedPeak, ...]:
        """The greatest amplitude of each order of every mesh and shaft."""
        return tuple(self._greatest())

    def _greatest(self) -> Iterator[TrackedPeak]:
        meshes, _, shafts = self.names
        for values, names, quantity, unit in ((self.forces, meshes, "force", "N"), (self.torques, shafts, "torque", "N·m")):
            for member, name in enumerate(names):
                for at, (order, source) in enumerate(self.orders):
                    row = int(values[:, at, member].argmax())
                    found = float(values[row, at, member])
                    yield TrackedPeak(name, quantity, unit, order, source, found, float(self.speeds[row]))

    def to_dict(self) -> JsonObject:
        """Return the entry of the tracks in `dynamics.json`; the amplitudes along the speed are arrays."""
        return {
            "turns": self.turns,
            "orders": [each._asdict() for each in self.orders],
            "greatest": [each._asdict() for each in self.greatest],
        }

    def arrays(self) -> dict[str, Floats]:
        """Return the arrays of the .npz file by name."""
        return {
            "track_time": self.time,
            "track_speed": self.speeds,
            "track_orders": np.array([each.order for each in self.orders]),
            "track_force": self.forces,
            "track_shaft_torque": self.torques,
            "map_speed": self.map_speeds,
            "map_frequency": self.frequency,
            "map_force": self.force_map,
            "map_shaft_torque": self.torque_map,
        }


def no_tracks(time: Floats, speed: Floats, period: float) -> str:
    """Return why a run has no order tracks, "" if it has; `period` is the common one in turns of the first pinion."""
    if speed[0] == speed[-1]:
        return "orders are tracked along the speed, which does not change in this run"
    if speed[0] * speed[-1] < 0:
        return "orders are tracked in runs that turn one way, and this one turns back"
    turns = abs(float(speed[0] + speed[-1])) / 120 * float(time[-1])
    if turns < _WINDOWS * _least_window(period):
        need = _WINDOWS * _least_window(period) / turns * float(time[-1])
        return f"the run is too short for order tracks: {turns:.3g} turns; a duration of {need:.3g} s is enough"
    return ""


def _least_window(period: float) -> float:
    """Return the turns of a window: two common periods at least, so that neighbouring orders are told apart."""
    return math.ceil(max(2 * period, _LEAST_TURNS) / period) * period


def order_tracks(
    time: Floats,
    speed: Floats,
    force: Floats,
    torque: Floats,
    *,
    names: tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]],
    orders: tuple[SpeedOrder, ...],
    period: float,
) -> OrderTracks:
    """Return the order tracks of even samples in `time` (k,) in s with a `speed` (k,) in rpm that runs in a straight line.

    `force` (k, m) and `torque` (k, n) are the courses; `period` is the common one of teeth and torques in turns of the first
    pinion.
    """
    from scipy.signal import spectrogram

    seconds = time - time[0]
    angle = np.abs(speed[0] * seconds + (speed[-1] - speed[0]) * seconds**2 / (2 * seconds[-1])) / 60
    window = _least_window(period)
    centres = np.linspace(window / 2, angle[-1] - window / 2, _PLACES)
    signals = np.hstack([force, torque])
    amplitudes = np.stack([_amplitudes(signals, angle, centres, window, each.order) for each in orders], axis=1)
    at = np.interp(centres, angle, seconds)
    sampling = (len(time) - 1) / float(seconds[-1])
    count = max(len(time) // _SEGMENTS, min(_LEAST_SEGMENT, len(time)))
    step = max(1, len(time) // _COLUMNS)
    overlap = max(0, count - step)
    frequency, middle, found = spectrogram(
        signals, sampling, window="hann", nperseg=count, noverlap=overlap, scaling="spectrum", mode="magnitude", axis=0
    )
    most = _ABOVE * max((each.order for each in orders), default=1.0) * float(np.abs(speed).max()) / 60
    kept = frequency <= max(most, float(frequency[1]))
    # The axis of the signals stands between those of frequency and time.
    maps = 2 * np.moveaxis(found, -1, 0)[:, kept]
    meshes = force.shape[1]
    return OrderTracks(
        time=time[0] + at,
        speeds=np.interp(at, seconds, np.abs(speed)),
        turns=window,
        orders=orders,
        forces=amplitudes[:, :, :meshes],
        torques=amplitudes[:, :, meshes:],
        map_speeds=np.interp(middle, seconds, np.abs(speed)),
        frequency=frequency[kept],
        force_map=maps[:, :, :meshes],
        torque_map=maps[:, :, meshes:],
        names=names,
    )


def _amplitudes(signals: Floats, angle: Floats, centres: Floats, window: float, order: float) -> Floats:
    """Return the amplitudes (w, c) of an order of signals (k, c) over their `angle` (k,), in turns, in windows about centres.

    Hann's window is a constant and two waves, so that sums up to each sample give every window at once.
    """
    weights = np.gradient(angle)[:, None]
    begin, end = (np.searchsorted(angle, centres + side * window / 2) for side in (-1, 1))
    turned = signals * weights * np.exp(-2j * np.pi * order * angle)[:, None]
    found = np.zeros((len(centres), signals.shape[1]), complex)
    for wave, part in ((0, 0.5), (1, 0.25), (-1, 0.25)):
        shape = np.exp(2j * np.pi * wave * angle / window)[:, None]
        sums = np.concatenate([np.zeros((1, signals.shape[1])), np.cumsum(turned * shape, axis=0)])
        found += part * np.exp(-2j * np.pi * wave * centres / window)[:, None] * (sums[end] - sums[begin])
    return np.asarray(2 * np.abs(found) / (window / 2), float)
