"""The live page: open."""

from __future__ import annotations

from pathlib import Path

import click

from gearcad.cli.group import debug_option

__all__ = ["open"]

_STARTER = "reducer"
"""What is opened if nothing is given."""


@click.command("open")
@click.argument("spec", type=click.Path(path_type=Path), required=False)
@click.option("--host", metavar="ADDRESS", help="Let others in at this address of the machine, who have the token.")
@click.option("--port", type=click.IntRange(1, 65535), help="Where it listens.  [default: 8765, or the next that is free]")
@click.option("--no-browser", is_flag=True, help="Only print the address.")
@debug_option
def open(spec: Path | None, host: str | None, port: int | None, no_browser: bool) -> None:
    """Open a page in the browser in which the gears move: every change of SPEC, or of a starter, is seen at once.

    It listens at 127.0.0.1 only, until Ctrl-C.
    """
    from gearcad.designs.files import spec_text
    from gearcad.designs.starters import starter_text
    from gearcad.page.server import serve

    if spec is None:
        name, text = starter_text(_STARTER)
        spec = Path(name)
    else:
        text = spec_text(spec)
    serve(text, spec.stem, spec.parent, host=host, port=port, browser=not no_browser)
