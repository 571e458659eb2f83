"""The page docs/papers.md: its commands, and the numbers that it says they give."""

import csv
import json
import re
from pathlib import Path
from typing import Any, NamedTuple

PAGE = Path(__file__).parents[2] / "docs" / "papers.md"


class Claim(NamedTuple):
    """A line of a table: what it is of, what the page says that it is, and where that stands."""

    what: str
    ours: str
    where: str

    def holds(self, value: float | str | None) -> bool:
        """Whether a value is what the page shows: a word, or a number to half of its last digit."""
        if value is None or isinstance(value, str):
            return self.ours == ("none" if value is None else value)
        last = 10.0 ** -len(self.ours.partition(".")[2])
        return abs(value - float(self.ours)) <= 0.5000001 * last


class Section(NamedTuple):
    """A heading with its commands, one a line, and its claims."""

    title: str
    commands: tuple[str, ...]
    claims: tuple[Claim, ...]


def sections() -> list[Section]:
    """Those of the page that have commands."""
    found = []
    for part in re.split(r"^## ", PAGE.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
        blocks = re.findall(r"^```sh\n(.*?)^```$", part, re.DOTALL | re.MULTILINE)
        whole = "".join(blocks).replace("\\\n", "")  # a command that goes on in the next line
        commands = tuple(line for line in whole.splitlines() if line.strip())
        if commands:
            found.append(Section(part.partition("\n")[0], commands, tuple(_claims(part))))
    return found


def _claims(part: str) -> list[Claim]:
    """Lines of tables whose last cell names a place."""
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in part.splitlines() if line.startswith("| ")]
    rows = [row for row in cells if len(row) == 5 and row[4].startswith("`")]
    return [Claim(row[0], row[2], row[4].strip("`")) for row in rows]


def given(folder: Path, where: str) -> float | str | None:
    """What is at a place: `FILE: KEY/KEY/NUMBER` of JSON (#: how many), or of CSV a `FILE: COLUMN at OTHER = VALUE`,
    `FILE: COLUMN, greatest`."""
    name, _, place = where.partition(": ")
    path = folder / name
    return _of_table(path, place) if path.suffix == ".csv" else _of_document(path, place)


def _of_document(path: Path, place: str) -> float | str | None:
    value: Any = json.loads(path.read_text(encoding="utf-8"))
    for step in place.split("/"):
        value = len(value) if step == "#" else value[int(step)] if isinstance(value, list) else value[step]
    return value if value is None or isinstance(value, str) else float(value)


def _of_table(path: Path, place: str) -> float:
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    column, greatest, _ = place.partition(", greatest")
    if greatest:
        return max(float(row[column]) for row in rows)
    column, _, condition = place.partition(" at ")
    other, _, value = condition.partition(" = ")
    return float(min(rows, key=lambda row: abs(float(row[other]) - float(value)))[column])
