"""The page docs/papers.md: its commands, the numbers that it says they give, and what it counts of each document."""

import csv
import json
import re
import tomllib
from collections import Counter
from pathlib import Path
from typing import Any, NamedTuple

PAGE = Path(__file__).parents[2] / "docs" / "papers.md"

VERDICTS = ("reproduced", "differs", "unreadable")

CLOSE = 0.01
"""Relative: most distance from the printed number of one that is called reproduced."""


class Claim(NamedTuple):
    """A line of a table: what it is of, what is printed, our number or numbers, the verdict with its reason, and the place."""

    what: str
    printed: str
    ours: str
    verdict: str
    why: str
    where: str

    @property
    def places(self) -> list[str]:
        """The places of `where`."""
        return re.findall("`([^`]+)`", self.where)

    @property
    def numbers(self) -> list[str]:
        """Our numbers, one for each place of `where`."""
        return self.ours.split(", ") if self.places else []

    @property
    def items(self) -> int:
        """How many numbers of the document the line judges: none for one in brackets, which another line judges."""
        fresh = self.printed != "–" and not self.printed.startswith("(")
        return len(self.printed.split(", ")) if fresh and _number(self.printed.split(", ")[0]) is not None else int(fresh)

    def holds(self, values: list[float | str | None]) -> bool:
        """Whether values are what the page shows."""
        return len(values) == len(self.numbers) and all(map(_shown, values, self.numbers))

    @property
    def sound(self) -> bool:
        """Whether the verdict is one of three that its line allows: close numbers, a reason, a place of ours."""
        if not self.items:
            return not self.verdict
        if self.verdict == "differs":
            return bool(self.why)
        if self.verdict != "reproduced":
            return self.verdict == "unreadable"
        return all(_close(*pair) for pair in zip(self.printed.split(", "), self.numbers, strict=False)) and bool(self.places)


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def _shown(value: float | str | None, shown: str) -> bool:
    """Whether a value is what the page shows: a word, or a number to half of its last digit."""
    if value is None or isinstance(value, str):
        return shown == ("none" if value is None else value)
    last = 10.0 ** -len(shown.partition(".")[2])
    return abs(value - float(shown)) <= 0.5000001 * last


def _close(printed: str, ours: str) -> bool:
    """Whether our number is the printed one within 1 %, or half of its last digit; a mode of vibration has either sign."""
    one, other = _number(printed), _number(ours)
    if one is None or other is None:
        return True
    last = 10.0 ** -len(printed.partition(".")[2])
    return abs(abs(one) - abs(other)) <= max(CLOSE * abs(one), 0.5000001 * last)


class Pictures(NamedTuple):
    """A line on figures of a document that have no numbers in its text."""

    numbers: str
    what: str
    verdict: str
    ours: str

    @property
    def items(self) -> int:
        """How many figures: `4 to 9, 12`; those of chapters are `5.1 to 5.4`, those of an appendix `A1.1 to A1.4`."""
        return sum(_span(each) for each in self.numbers.split(", "))


def _span(text: str) -> int:
    first, _, last = text.partition(" to ")
    ends = [int(each.rpartition(".")[2]) for each in (first, last or first)]
    return ends[1] - ends[0] + 1


class Section(NamedTuple):
    """A heading with its commands, one a line, and its claims."""

    document: str
    title: str
    commands: tuple[str, ...]
    claims: tuple[Claim, ...]
    pictures: tuple[Pictures, ...]


def sections() -> list[Section]:
    """Return the sections of the documents, in their order; those with pictures only have no commands."""
    found = []
    for chapter in re.split(r"^## ", PAGE.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
        document = chapter.partition("\n")[0]
        for part in re.split(r"^### ", chapter, flags=re.MULTILINE)[1:]:
            blocks = re.findall(r"^```sh\n(.*?)^```$", part, re.DOTALL | re.MULTILINE)
            whole = "".join(blocks).replace("\\\n", "")  # a command that goes on in the next line
            commands = tuple(line for line in whole.splitlines() if line.strip())
            title = part.partition("\n")[0]
            found.append(Section(document, title, commands, tuple(_claims(part)), tuple(_pictures(part))))
    return found


def _rows(part: str, cells: int) -> list[list[str]]:
    """Return the rows of tables with so many cells, without their headings."""
    rows = [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in part.splitlines() if line.startswith("|")]
    return [row for row in rows if len(row) == cells and "verdict" not in row and set(row[0]) != {"-"}]


def _claims(part: str) -> list[Claim]:
    return [Claim(*row) for row in _rows(part, 6)]


def _pictures(part: str) -> list[Pictures]:
    return [Pictures(*row) for row in _rows(part, 4)]


def counts() -> dict[str, dict[str, int]]:
    """Return how many printed numbers and figures of each document have which verdict."""
    found: dict[str, Counter[str]] = {}
    for section in sections():
        for line in (*section.claims, *section.pictures):
            if line.items:
                found.setdefault(section.document, Counter())[line.verdict] += line.items
    return {document: {verdict: count[verdict] for verdict in VERDICTS} for document, count in found.items()}


def counted() -> dict[str, dict[str, int]]:
    """Return what the page's first table says of that."""
    head = PAGE.read_text(encoding="utf-8").partition("\n## ")[0]
    rows = _rows(head.replace("**", ""), 5)
    return {row[0]: dict(zip(VERDICTS, map(int, row[2:]), strict=True)) for row in rows if row[1].isdigit()}


def given(folder: Path, claim: Claim) -> list[float | str | None]:
    """Return what is at the places of a claim: `FILE: KEY/KEY/NUMBER` of JSON or TOML (#: how many), of CSV `FILE: COLUMN at
    OTHER = VALUE` or `FILE: COLUMN, greatest`; ` * NUMBER` multiplies it. `FILE: KEY/KEY, KEY` are several under the same keys.
    """
    return [value for where in claim.places for value in _at(folder, where)]


def _at(folder: Path, where: str) -> list[float | str | None]:
    name, _, place = where.partition(": ")
    place, _, factor = place.partition(" * ")
    path = folder / name
    if path.suffix == ".csv":
        return [_of_table(path, place)]
    head, _, last = place.rpartition("/") if ", " in place else ("", "", place)
    found = [_of_document(path, f"{head}/{key}" if head else key) for key in last.split(", ")]
    return [value * float(factor) if factor and isinstance(value, float) else value for value in found]


def _of_document(path: Path, place: str) -> float | str | None:
    text = path.read_text(encoding="utf-8")
    value: Any = tomllib.loads(text) if path.suffix == ".toml" else json.loads(text)
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
