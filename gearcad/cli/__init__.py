"""The commands. Results on stdout, progress and messages on stderr; exit status 0, 1 (fell short) or 2 (wrong input)."""

from __future__ import annotations

import io
import logging
import sys

import click

from gearcad.cli.group import Commands, debug_option
from gearcad.cli.language import language_option
from gearcad.version import __version__

__all__ = ["main"]

_EXAMPLE = """\b
Three commands from nothing to a pair of gears:
  gearcad new pair                  writes volvo-13-44.toml, full of comments
  gearcad data volvo-13-44.toml     shows the geometry
  gearcad build volvo-13-44.toml    writes STEP and STL to output/volvo-13-44/
"""

_CHATTY = ("matplotlib", "ezdxf")
"""Libraries that warn of a home folder in which they cannot keep their caches, which they do not need."""


@click.group(cls=Commands, epilog=_EXAMPLE, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, prog_name="gearcad")
@language_option
@debug_option
def main() -> None:
    """Exact cylindrical gears from a handful of numbers: data sheet, STEP, STL and more.

    A gear, a rack or a pair is described in a SPEC, a short TOML file. Lengths are in mm, angles in degrees.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # an old terminal shows ? for a Greek letter, and goes on
    for library in _CHATTY:
        logging.getLogger(library).setLevel(logging.ERROR)
