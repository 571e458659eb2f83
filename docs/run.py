"""Runs pages of the manual: `python docs/run.py docs/start.md`; `--write` puts what came out in the place of what is shown."""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from manual.running import Fault, run_page


def write_outputs(page: Path, faults: list[Fault]) -> None:
    """Put what commands gave in the place of what a page shows of them, the last first: lines keep their numbers."""
    lines = page.read_text(encoding="utf-8").splitlines(keepends=True)
    for fault in sorted(faults, key=lambda each: -each.line):
        shown = fault.shown.splitlines()
        if shown and fault.came:
            first = fault.line
            while lines[first - 1].endswith("\\\n"):
                first += 1
            lines[first : first + len(shown)] = [f"{line.rstrip()}\n" for line in fault.came.splitlines()]
    page.write_text("".join(lines), encoding="utf-8")


def main() -> int:
    pages = [Path(name).absolute() for name in sys.argv[1:] if name != "--write"]
    wrong = 0
    for page in pages:
        with TemporaryDirectory() as folder:
            faults = list(run_page(page, Path(folder)))
        for fault in faults:
            print(f"{page}: {fault}")
        if "--write" in sys.argv:
            write_outputs(page, faults)
        wrong += len(faults)
    return min(wrong, 1)


if __name__ == "__main__":
    sys.exit(main())
