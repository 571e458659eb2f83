"""The live page: open."""

from __future__ import annotations

from pathlib import Path

import click

from gearcad.cli.group import debug_option

__all__ = ["open"]


@click.command("open")
@click.argument("spec", type=click.Path(path_type=Path), required=False)
@click.option("--host", metavar="ADDRESS", help="Let others in at this address of the machine: the page then has a token.")
@click.option("--port", type=click.IntRange(1, 65535), default=8765, show_default=True, help="Where it listens.")
@click.option("--no-browser", is_flag=True, help="Only print the address.")
@debug_option
def open(spec: Path | None, host: str | None, port: int, no_browser: bool) -> None:
    """Open a page in the browser, in which the design of SPEC follows every change."""
    from gearcad.designs.starters import starter_text
    from gearcad.page.server import serve

    if spec is None:
        name, text = starter_text("fzg")
        name, folder = Path(name).stem, Path.cwd()
    else:
        name, text, folder = spec.stem, spec.read_bytes().decode("utf-8-sig"), spec.parent
    serve(text, name, folder, host, port, not no_browser)
