"""A starter to begin with: new."""

from __future__ import annotations

from pathlib import Path

import click

from gearcad.cli.group import debug_option, require_new_file

__all__ = ["new"]


def _names(_ctx: click.Context, _parameter: click.Parameter, begun: str) -> list[str]:
    """What a shell completes."""
    from gearcad.designs.starters import starters

    return [name for name in starters() if name.startswith(begun)]


@click.command()
@click.argument("kind", required=False, shell_complete=_names)
@click.option("-o", "--output", metavar="FILE", help="Where to write it; - prints it.  [default: its own name here]")
@click.option("--force", is_flag=True, help="Replace a file that exists.")
@debug_option
def new(kind: str | None, output: str | None, force: bool) -> None:
    """Write a commented starter: a spec of one design, or a table of many.

    KIND is the name of a starter or its beginning; without it the starters are listed.
    """
    from gearcad.designs.starters import starter_text, starters

    if kind is None:
        found = starters()
        width = max(map(len, found)) + 2
        click.echo("".join(f"{name:<{width}}{what}\n" for name, what in found.items()), nl=False)
        return
    name, text = starter_text(kind)
    if output == "-":
        click.echo(text, nl=False)
        return
    path = Path(output or name)
    _write_new(path, text, force)
    click.echo(path)
    click.echo(f"Next: {_next(name, text, path)}", err=True)


def _next(name: str, text: str, path: Path) -> str:
    """The command that shows most of what a starter is; a template of drawings is named in specs."""
    if name.startswith("drawing_"):
        return f'keep what you change, and name it in a spec: [drawing] template = "{path}"'
    if name.endswith(".csv"):
        return f"gearcad batch {path}"
    commands = {"train": "dynamics", "planetary": "planetary", "measured": "identify"}
    command = next((command for table, command in commands.items() if f"\n[{table}]\n" in text), "data")
    return f"gearcad {command} {path}"


def _write_new(path: Path, text: str, force: bool) -> None:
    from gearcad.output import staged_files

    require_new_file(path, force)
    with staged_files(path.parent) as staging:
        (staging / path.name).write_text(text, encoding="utf-8")
