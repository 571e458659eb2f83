"""Directives of the pages of commands: `{command} NAME` shows what its help says, `{options} NAME` its options."""

from __future__ import annotations

import re
from inspect import cleandoc
from typing import Any

import click
from docutils import nodes
from docutils.parsers.rst import Directive

from gearcad.cli import main
from manual.tables import Cell, table, text

__all__ = ["setup"]


def _command(name: str) -> tuple[click.Command, click.Context]:
    found = main.get_command(click.Context(main), name)
    if found is None:
        raise ValueError(f"gearcad has no command {name}")
    return found, click.Context(found, info_name=f"gearcad {name}")


class Command(Directive):
    """How a command is called, and what it does."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        command, context = _command(self.arguments[0])
        usage = " ".join(command.collect_usage_pieces(context))
        found: list[nodes.Node] = [_literal(f"gearcad {command.name} {usage}")]
        for paragraph in re.split(r"\n\s*\n", cleandoc(command.help or "")):
            first, _, rest = paragraph.partition("\n")
            kept = first.strip() == "\b"
            found.append(_literal(rest) if kept else nodes.paragraph("", "", *text(" ".join(paragraph.split()))))
        return found


class Options(Directive):
    """Options, what they do and what they are by default."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        command, context = _command(self.arguments[0])
        rows: list[tuple[Cell, ...]] = []
        for option in command.get_params(context):
            record = option.get_help_record(context)
            if record is None:
                continue
            words, _, said = record[1].partition("[default: ")
            rows.append(([nodes.literal(text=record[0])], text(" ".join(words.split())), text(said.removesuffix("]"))))
        return [table("options", ("Option", "Meaning", "Default"), rows)]


def _literal(words: str) -> nodes.literal_block:
    block = nodes.literal_block(words, words)
    block["language"] = "text"
    return block


def setup(app: Any) -> dict[str, bool]:
    app.add_directive("command", Command)
    app.add_directive("options", Options)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
