"""Judge of the check by somebody else's solver: CalculiX runs the deck of a loaded pair, in a time limit."""

from __future__ import annotations

import math
import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from gearcad.core.child_process import limit_cpu_time
from gearcad.core.errors import GearcadError
from gearcad.core.records import Role
from gearcad.decks.pair import PairDecks
from gearcad.verification.claims import Claim, Judge

_PROGRAM = "ccx"

_JOB = "pair"

TIME_LIMIT = 900.0
"""Seconds of CPU time that one deck may take: other work on the machine does not count."""

_PATIENCE = 20
"""Seconds that may pass for each second of CPU time."""

_OUT_OF_TIME = -signal.SIGXCPU if sys.platform == "linux" else None
"""Exit status of a program that has used its CPU time."""

_WHAT = "transmission error, load share, root stress, pressure"


@dataclass(frozen=True)
class Permitted:
    """Deviations in % that are permitted: of transmission error and root stress, and of contact pressure unless None.

    `load_share` is in % of the load, None where it is not judged.
    """

    transmission_error: float
    root_stress: float
    load_share: float | None = None
    contact_pressure: float | None = None


PLANE_PERMITTED = Permitted(transmission_error=0.2, load_share=0.2, root_stress=0.5, contact_pressure=2.0)
"""Of sections: CalculiX has the geometry of the turned and bent gears, the check is linear, which is worth 0.2 % of root
stress."""

SOLID_PERMITTED = Permitted(transmission_error=2.0, root_stress=5.0)
"""Of bodies of few elements: 1.1 and 4.0 % were measured."""


def missing() -> str:
    """Return the reason why CalculiX cannot judge: "" where it is installed."""
    return "" if shutil.which(_PROGRAM) else "CalculiX (ccx) is not installed"


def calculix_version() -> str:
    """Return the version of CalculiX that is installed, "" without one."""
    if missing():
        return ""
    run = subprocess.run([_PROGRAM, "-v"], capture_output=True, encoding="utf-8", errors="replace", timeout=60, check=False)
    found = re.search(r"\d+\.\d+", run.stdout)
    return found[0] if found else ""


def judge_calculix(
    decks: PairDecks, roll_angle: float, judge: Judge, permitted: Permitted, time_limit: float = TIME_LIMIT
) -> Iterator[Claim]:
    """Let CalculiX run the deck of a pair at a roll angle (deg), and judge our figures by its own."""
    at = f"at {roll_angle:.4g}°"
    try:
        made = decks.at(roll_angle)
    except GearcadError as error:
        yield judge.not_judged(f"{_WHAT}, {at}", f"no deck can be made: {error}")
        return
    with TemporaryDirectory(prefix="gearcad-ccx-") as folder:
        job = Path(folder) / _JOB
        made.write(job.with_suffix(".inp"))
        if reason := _run(job, time_limit):
            yield judge.not_judged(f"{_WHAT}, {at}", reason)
            return
        try:
            theirs = made.found(job)
        except (GearcadError, OSError) as error:
            yield judge.holds(f"CalculiX finds the loaded pair, {at}", False, place=str(error))
            return
    yield from compare(made.expected, theirs, judge, permitted, at)


def _run(job: Path, time_limit: float) -> str:
    """Run CalculiX on a deck by one thread, and return the reason why it has no result, or ""."""
    threads = {**os.environ, "OMP_NUM_THREADS": "1"}
    late = f"CalculiX did not come to an end in {time_limit:g} s of CPU time"
    try:
        with subprocess.Popen(
            [_PROGRAM, job.name],
            cwd=job.parent,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            encoding="utf-8",
            errors="replace",
            env=threads,
        ) as run:
            limit_cpu_time(run, math.ceil(time_limit))
            try:
                printed, _ = run.communicate(timeout=_PATIENCE * time_limit)
            except subprocess.TimeoutExpired:
                return late
            finally:
                run.kill()
    except OSError as error:
        return f"CalculiX cannot be run: {error}"
    if run.returncode == _OUT_OF_TIME:
        return late
    if run.returncode or "ERROR" in printed:
        said = next((line.strip() for line in printed.splitlines() if "ERROR" in line), f"exit status {run.returncode}")
        return f"CalculiX has no result: {said}"
    return ""


def compare(ours: Mapping[str, Any], theirs: Mapping[str, Any], judge: Judge, permitted: Permitted, at: str) -> Iterator[Claim]:
    """Judge the figures of the check by those of CalculiX, as decks have both."""

    def near(quantity: str, computed: float, reference: float, percent: float) -> Claim:
        return judge.near(f"{quantity}, {at}", computed, reference, percent / 100, relative=True)

    yield near(
        "transmission error (µm)", ours["transmission_error"], theirs["transmission_error"], permitted.transmission_error
    )
    for role in Role:
        computed, reference = (each["root_stress"][role.value] for each in (ours, theirs))
        yield near(f"root stress of the {role.value} (MPa)", computed, reference, permitted.root_stress)
    own, other = ({pair["pinion"]: pair for pair in each["pairs"]} for each in (ours, theirs))
    if permitted.load_share is not None:
        shares = {name: tuple(_figure(each, name, "load_share") for each in (own, other)) for name in own | other}
        computed, reference = max(shares.values(), key=lambda share: abs(share[0] - share[1]))
        yield judge.near(f"load share, {at}", 100 * computed, 100 * reference, permitted.load_share, "%")
    if permitted.contact_pressure is not None:
        inside = {name: pair["contact_pressure"] for name, pair in own.items() if pair["contact_pressure"]}
        if not inside:
            yield judge.not_judged(f"contact pressure, {at}", "teeth touch at edges of flanks only")
            return
        pressures = [(value, _figure(other, name, "contact_pressure")) for name, value in inside.items()]
        computed, reference = max(pressures, key=lambda pressure: abs(pressure[1] / pressure[0] - 1))
        yield near("contact pressure (MPa)", computed, reference, permitted.contact_pressure)


def _figure(pairs: Mapping[str, Any], name: str, figure: str) -> float:
    return float(pairs[name][figure]) if name in pairs else 0.0
