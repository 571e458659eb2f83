"""What to know before trusting a vibration, wherever it was found."""

from __future__ import annotations

import numpy as np

from gearcad.arrays import Bools, Floats
from gearcad.notice import Notice

__all__ = ["frequency_ranges", "instability", "parting", "runs"]


def runs(speeds: Floats, marked: Bools) -> list[Floats]:
    """Neighbouring speeds (s,) that are marked, run by run."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], marked, [False]]).astype(int)))
    return [speeds[start:end] for start, end in edges.reshape(-1, 2)]


def frequency_ranges(frequencies: Floats, marked: Bools) -> str:
    """From where to where rising frequencies (s,) are marked, in words."""
    return ", ".join(f"{part[0]:g} to {part[-1]:g}" for part in runs(frequencies, marked))


def instability(frequencies: Floats, stable: Bools, *, parting: bool = False) -> tuple[Notice, ...]:
    """That motions do not last at some of the tooth frequencies (s,) in 1/s: without bound, unless flanks are `parting`."""
    if stable.all():
        return ()
    ranges = [f"{part[0]:g}" if len(part) == 1 else f"{part[0]:g} to {part[-1]:g}" for part in runs(frequencies, ~stable)]
    where = f"at tooth frequencies (1/s) {', '.join(ranges)}"
    text = (
        f"the periodic motion does not last {where}: what comes instead is not computed, and can be greater than what is given"
        if parting
        else f"parametric instability: vibrations grow without bound {where}; "
        "what is given there is a periodic motion that does not last"
    )
    return (Notice("unstable", text),)


def parting(frequencies: Floats, apart: Bools) -> Notice:
    """That flanks pull at some of the tooth frequencies (s,) in 1/s, in a motion that lets them."""
    text = (
        f"flanks would part at tooth frequencies (1/s) {frequency_ranges(frequencies, apart)}: "
        "a sweep with backlash shows what happens there"
    )
    return Notice("flanks-would-part", text)
