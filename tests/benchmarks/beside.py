"""Two checkouts beside each other, in turn: CPU time and memory of whole commands, and how they grow. A script:

    python tests/benchmarks/beside.py OLD NEW [-n 5] [--limit 300] [CASE ...]

Runs what is in `beside_cases.py`, or what of it has one of the words CASE in its name, `-n` times each checkout after a run
that is not counted, and prints tables in Markdown: medians of CPU seconds (user and system, children too), the peak of memory
of the largest process (MB), new over old, and the exponent of growth, fitted to all values. Starters are those of OLD.
Machines are shared and noisy: compare ratios of one run. What takes longer than `--limit` seconds of a clock is stopped.
"""

import argparse
import json
import math
import os
import shlex
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from beside_cases import CASES, INPUTS, SERIES, Series

_MEASURED = """
import json, resource
def _used():
    both = resource.getrusage(resource.RUSAGE_SELF), resource.getrusage(resource.RUSAGE_CHILDREN)
    return sum(each.ru_utime + each.ru_stime for each in both)
x = {x}
{prepare}
count, _begun = 0, _used()
while not count or _used() - _begun < 0.2:
    {work}
    count += 1
print(json.dumps((_used() - _begun) / count))
"""

_PAUSE = 0.02
"""Seconds between two looks at a process."""


class Run(NamedTuple):
    """CPU time (s) and peak memory (MB) of one run."""

    seconds: float
    memory: float


class Over(NamedTuple):
    """What did not end in time, or not as it should."""

    words: str


Measured = Run | Over


def run(command: list[str], checkout: Path, inputs: Path, limit: float, of_output: bool) -> Measured:
    """Run a command in a folder of its own; its time is what it prints, or that of the whole process and its children."""
    with tempfile.TemporaryDirectory() as name, tempfile.TemporaryFile() as said, tempfile.TemporaryFile() as told:
        folder = shutil.copytree(inputs, name, dirs_exist_ok=True)
        environment = os.environ | {"PYTHONPATH": str(checkout.resolve())}
        environment.pop("PYTHONDONTWRITEBYTECODE", None)  # as installed packages are: compiled once
        process = subprocess.Popen(
            command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=said, stderr=told, start_new_session=True
        )
        end = time.monotonic() + limit
        while not (waited := os.wait4(process.pid, os.WNOHANG))[0]:
            if time.monotonic() > end:
                os.killpg(process.pid, signal.SIGKILL)
                os.wait4(process.pid, 0)
                return Over(f"over {limit:g} s")
            time.sleep(_PAUSE)
        process.returncode = os.waitstatus_to_exitcode(waited[1])
        told.seek(0)
        lines = told.read().decode(errors="replace").splitlines()
        # Status 1 is also that of a check that fell short.
        if process.returncode not in (0, 1) or any(line.startswith(("Error", "Traceback")) for line in lines):
            print(f"{checkout}: {shlex.join(command)[:200]}\n  {lines[-1] if lines else process.returncode}", file=sys.stderr)
            return Over("failed")
        said.seek(0)
        usage = waited[2]
        seconds = json.loads(said.read()) if of_output else usage.ru_utime + usage.ru_stime
        return Run(seconds, usage.ru_maxrss / (1e6 if sys.platform == "darwin" else 1e3))


def beside(measure: Callable[[Path], Measured], checkouts: tuple[Path, Path], count: int) -> tuple[Measured, Measured]:
    """Medians of both checkouts, run in turn; the first round is not counted unless it is the only one."""
    runs: dict[Path, list[Run]] = {checkout: [] for checkout in checkouts}
    over: dict[Path, Over] = {}
    for _ in range(count + (count > 1)):
        for checkout in checkouts:
            if checkout in over:
                continue
            found = measure(checkout)
            if isinstance(found, Over):
                over[checkout] = found
            else:
                runs[checkout].append(found)

    def median(checkout: Path) -> Measured:
        counted = runs[checkout][-count:]
        return over.get(checkout) or Run(*map(statistics.median, zip(*counted, strict=True)))

    old, new = checkouts
    return median(old), median(new)


def _case(line: str) -> list[str]:
    words = shlex.split(line)
    return [sys.executable, "-m", *words] if words[0] == "gearcad" else [sys.executable, "-c", line]


def _figure(found: Measured, field: str) -> str:
    return found.words if isinstance(found, Over) else f"{getattr(found, field):.3g}"


def _ratio(old: Measured, new: Measured, field: str) -> str:
    if isinstance(old, Over) or isinstance(new, Over):
        return ""
    return f"{getattr(new, field) / getattr(old, field):.2f}"


def _exponent(values: tuple[float, ...], found: list[Measured]) -> str:
    """The slope of log time over log value, where at least two are known."""
    known = [(value, each.seconds) for value, each in zip(values, found, strict=True) if isinstance(each, Run)]
    logs = [tuple(map(math.log, each)) for each in known]
    return f"{statistics.linear_regression(*zip(*logs, strict=True)).slope:.2f}" if len(logs) > 1 else ""


def _row(*cells: str) -> str:
    return f"| {' | '.join(cells)} |"


def _case_rows(names: list[str], measured: Callable[[str], tuple[Measured, Measured]]) -> Iterator[str]:
    yield _row("case", "CPU s old", "CPU s new", "new/old", "MB old", "MB new", "new/old")
    yield _row("---", *["---:"] * 6)
    for name in names:
        old, new = measured(name)
        cells = (text for field in Run._fields for text in (_figure(old, field), _figure(new, field), _ratio(old, new, field)))
        yield _row(name, *cells)


def _series_rows(series: dict[str, Series], measured: Callable[[Series, float], tuple[Measured, Measured]]) -> Iterator[str]:
    yield _row("series", "value", "CPU s old", "CPU s new", "new/old", "MB old", "MB new", "exponent old", "exponent new")
    yield _row("---", *["---:"] * 8)
    for name, each in series.items():
        found = [measured(each, value) for value in each.values]
        for value, (old, new) in zip(each.values, found, strict=True):
            times = (_figure(old, "seconds"), _figure(new, "seconds"), _ratio(old, new, "seconds"))
            yield _row(name, f"{value:g} {each.words}", *times, _figure(old, "memory"), _figure(new, "memory"), "", "")
        olds, news = ([pair[side] for pair in found] for side in (0, 1))
        yield _row(name, "all", "", "", "", "", "", _exponent(each.values, olds), _exponent(each.values, news))


def main() -> None:
    """Do what the command line says."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path)
    parser.add_argument("case", nargs="*", help="words of names of cases and series; none for all")
    parser.add_argument("-n", "--count", type=int, default=5, help="runs that are counted [5]")
    parser.add_argument("--limit", type=float, default=300.0, help="seconds that one run may take [300]")
    given = parser.parse_intermixed_args()
    checkouts = (given.old, given.new)

    def asked(name: str) -> bool:
        return not given.case or any(word in name for word in given.case)

    with tempfile.TemporaryDirectory() as folder:
        inputs = shutil.copytree(given.old / "templates", Path(folder) / "inputs")
        for name, text in INPUTS.items():
            (inputs / name).write_text(text, encoding="utf-8")

        def command(name: str) -> tuple[Measured, Measured]:
            line = _case(CASES[name])
            return beside(lambda checkout: run(line, checkout, inputs, given.limit, False), checkouts, given.count)

        def point(series: Series, value: float) -> tuple[Measured, Measured]:
            code = _MEASURED.format(x=value, prepare=series.prepare, work=series.work)
            line = [sys.executable, "-c", code]
            return beside(lambda checkout: run(line, checkout, inputs, given.limit, True), checkouts, given.count)

        names, series = list(filter(asked, CASES)), {name: each for name, each in SERIES.items() if asked(name)}
        tables = [_case_rows(names, command)] if names else []
        tables += [_series_rows(series, point)] if series else []
        for table in tables:
            for line in table:
                print(line, flush=True)
            print(flush=True)


if __name__ == "__main__":
    main()
