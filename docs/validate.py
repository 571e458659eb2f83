"""Runs the tests that know published values, and writes what the validation page shows: `python docs/validate.py [-k WORD]`.

With a word only the rows of tests that it picks are written anew, of all their parameters. Rows of tests that are skipped,
as a solver is missing, stay.
"""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1] / "tests"
PROPERTY = "published"
FILE = Path(__file__).with_name("validation.json")


class Collector:
    """Picks those tests, and collects their rows."""

    def __init__(self) -> None:
        self.rows: list[list[object]] = []
        self.skipped: set[str] = set()

    def pytest_collection_modifyitems(self, config: pytest.Config, items: list[pytest.Item]) -> None:
        others = [item for item in items if PROPERTY not in getattr(item, "fixturenames", ())]
        items[:] = [item for item in items if PROPERTY in getattr(item, "fixturenames", ())]
        config.hook.pytest_deselected(items=others)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.when == "call" and report.passed:
            self.rows += [value for name, value in report.user_properties if name == PROPERTY]
        elif report.skipped:
            self.skipped.add(report.location[2].partition("[")[0])


def main() -> int:
    collector = Collector()
    os.environ["GEARCAD_VALIDATION"] = "write"
    status = pytest.main(["-q", "-m", "not benchmark_suite", *sys.argv[1:], str(TESTS)], plugins=[collector])
    if status != pytest.ExitCode.OK:
        return int(status)
    before = json.loads(FILE.read_text(encoding="utf-8")) if FILE.exists() else []
    judged = {row[-1] for row in collector.rows}
    picked = bool(sys.argv[1:])
    kept = [row for row in before if row[-1] not in judged and (picked or row[-1].partition("::")[2] in collector.skipped)]
    rows = sorted([*kept, *collector.rows], key=lambda row: str(row[-1]))  # those of a test in their order
    lines = ",\n".join(json.dumps(row, ensure_ascii=False) for row in rows)
    FILE.write_text(f"[\n{lines}\n]\n", encoding="utf-8")
    print(f"{len(rows)} values in {FILE.name}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
