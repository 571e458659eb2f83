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
@click.option("--host", metavar="ADDRESS", help="Listen at this address of the machine, for others who have the token.")
@click.option("--port", type=click.IntRange(1, 65535), help="Where it listens.  [default: 8765, or the next that is free]")
@click.option(
    "--token",
    metavar="TEXT",
    envvar="GEARCAD_TOKEN",
    show_envvar=True,
    help="Token for scripts, at least 16 characters; only the variable is hidden from other accounts.  [default: a new one]",
)
@click.option("--no-browser", is_flag=True, help="Only print the address.")
@click.option("--time-limit", type=float, metavar="S", help="Longest time of one run, in seconds.  [default: 3600]")
@click.option(
    "--memory-limit", type=float, metavar="GB", help="Most memory of one run.  [default: half of the machine's, at most 16 GB]"
)
@debug_option
def open(
    spec: Path | None,
    host: str | None,
    port: int | None,
    token: str | None,
    no_browser: bool,
    time_limit: float | None,
    memory_limit: float | None,
) -> None:
    """Open a page in the browser in which the gears move: every change of SPEC, or of a starter, is seen at once.

    It listens at 127.0.0.1 only, unless --host is given, until Ctrl-C. Only a browser that has opened the address printed, with
    its token, may read and save: the token becomes a cookie, and leaves the address.
    """
    from gearcad.designs.files import spec_text
    from gearcad.designs.starters import starter_text
    from gearcad.page.run import GIGABYTE, Limits
    from gearcad.page.runs import Runs
    from gearcad.page.server import serve

    given = {"seconds": time_limit, "memory": None if memory_limit is None else memory_limit * GIGABYTE}
    Runs.permitted = Limits(**{name: value for name, value in given.items() if value is not None})
    if spec is None:
        name, text = starter_text(_STARTER)
        spec = Path(name)
    else:
        text = spec_text(spec)
    serve(text, spec.stem, spec.parent, host=host, port=port, browser=not no_browser, token=token)
