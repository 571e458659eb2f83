"""What to know before trusting a vibration, wherever it was found."""

from __future__ import annotations

from enum import Enum

import numpy as np

from gearcad.arrays import Bools, Floats
from gearcad.notice import Notice

__all__ = ["Unstable", "frequency_ranges", "instability", "parting", "runs"]


def runs(speeds: Floats, marked: Bools) -> list[Floats]:
    """Neighbouring speeds (s,) that are marked, run by run."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], marked, [False]]).astype(int)))
    return [speeds[start:end] for start, end in edges.reshape(-1, 2)]


def frequency_ranges(frequencies: Floats, marked: Bools) -> str:
    """From where to where rising frequencies (s,) are marked, in words."""
    return ", ".join(f"{part[0]:g} to {part[-1]:g}" for part in runs(frequencies, marked))


class Unstable(Enum):
    """What a motion that does not last was found by; the values are what to say of it."""

    LINEAR = "parametric instability: vibrations grow without bound {where}; the periodic motion that is given does not last"
    PARTING = (
        "the periodic motion does not last {where}: what comes instead is not computed, and can be greater than what is given"
    )
    IN_TIME = (
        "the motion in time does not repeat {where}: what is given there is the greatest load of a long stretch, "
        "and a longer one can show a greater load"
    )


def instability(frequencies: Floats, stable: Bools, unstable: Unstable = Unstable.LINEAR) -> tuple[Notice, ...]:
    """Return a notice that motions do not last at some of the tooth frequencies (s,) in 1/s."""
    if stable.all():
        return ()
    ranges = [f"{part[0]:g}" if len(part) == 1 else f"{part[0]:g} to {part[-1]:g}" for part in runs(frequencies, ~stable)]
    return (Notice("unstable", unstable.value.format(where=f"at tooth frequencies (1/s) {', '.join(ranges)}")),)


def parting(frequencies: Floats, apart: Bools) -> Notice:
    """That flanks pull at some of the tooth frequencies (s,) in 1/s, in a motion that lets them."""
    text = (
        f"flanks would part at tooth frequencies (1/s) {frequency_ranges(frequencies, apart)}: "
        "a sweep with backlash shows what happens there"
    )
    return Notice("flanks-would-part", text)
