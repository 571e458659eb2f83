"""What pages show that can be run, read from their Markdown: commands with their output, Python, specs and other files."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

__all__ = ["Block", "Command", "blocks_of", "commands_of", "is_long"]

_FENCE = re.compile(r"^(?P<fence>`{3,})(?P<language>\w+)\n(?P<text>.*?)^(?P=fence)$", re.DOTALL | re.MULTILINE)
_FILE = re.compile(r"(?:# |<!-- )([\w.-]+\.(?:toml|csv|rexs))(?: -->)?\s*$")


@dataclass(frozen=True)
class Block:
    """A fenced block of a page: its language, its text, and the line that its text begins in."""

    language: str
    text: str
    line: int

    @property
    def file(self) -> str | None:
        """The file that a spec, a table or a file of REXS is shown as: its first line is a comment with the name."""
        found = _FILE.match(self.text.partition("\n")[0]) if self.language in ("toml", "csv", "xml") else None
        return found and found[1]


@dataclass(frozen=True)
class Command:
    """A command behind a `$`, what the page shows of its output, and the line it stands in."""

    text: str
    shown: str
    line: int


def blocks_of(page: str) -> list[Block]:
    """The fenced blocks of a page with a plain language, in their order."""
    return [
        Block(found["language"], found["text"], page.count("\n", 0, found.start("text")) + 1) for found in _FENCE.finditer(page)
    ]


def commands_of(block: Block) -> list[Command]:
    """The commands of a `console` block; a `\\` at the end of a line goes on in the next."""
    found: list[Command] = []
    lines = block.text.replace("\\\n", " \\\0").splitlines()
    number = block.line
    for line in lines:
        if line.startswith("$ "):
            found.append(Command(re.sub(r" +\\\0 *", " ", line[2:]), "", number))
        elif found:
            last = found[-1]
            found[-1] = Command(last.text, last.shown + line + "\n", last.line)
        else:
            raise ValueError(f"line {number}: output before the first command")
        number += 1 + line.count("\0")
    return found


def is_long(page: Path) -> bool:
    """Whether what a page shows takes more than a second or two: `run: long` stands between its first lines."""
    head = re.match(r"---\n(.*?)^---$", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    return head is not None and re.search(r"^run: long$", head[1], re.MULTILINE) is not None
