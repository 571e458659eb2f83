"""What takes long is found in a process beside the server: it is what would be found here, and needs no NiceGUI there."""

import os
import sys

import pytest
from support.page_server import awaited

from gearcad.core.errors import ParameterError
from gearcad.core.runtime import templates
from gearcad.designs.design import Design
from gearcad.designs.reader import read_spec
from gearcad.page.panels.sheet_content import Figures, strength_figures
from gearcad.page.run_process import result_in_process


def place(_design: Design) -> tuple[int, bool]:
    """Where this is called, and whether NiceGUI was imported there."""
    return os.getpid(), "nicegui" in sys.modules


def refusal(_design: Design) -> None:
    raise ParameterError("teeth", 2, "must be at least 3")


def test_a_rating_found_beside_the_server_is_the_one_found_here() -> None:
    design = read_spec(templates() / "reducer-21-43.toml")

    async def asked() -> tuple[Figures, tuple[int, bool]]:
        return await result_in_process(strength_figures, design), await result_in_process(place, design)

    strength, (process, page) = awaited(asked())
    assert strength == strength_figures(design)
    assert process != os.getpid()
    assert not page


def test_what_is_refused_there_is_refused_here() -> None:
    with pytest.raises(ParameterError, match="teeth = 2: must be at least 3"):
        awaited(result_in_process(refusal, read_spec(templates() / "spur.toml")))
