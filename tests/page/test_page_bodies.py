"""The bodies that the page shows: surfaces that are kept by gear, in mesh as the exact gears are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gearcad.core.runtime import templates
from gearcad.designs.pair_designs import PairDesign
from gearcad.designs.reader import read_spec
from gearcad.page.panels.drawn_data import bodies_of, surface_of


def test_what_did_not_change_is_the_same_surface() -> None:
    design = read_spec(templates() / "reducer-21-43.toml")
    assert isinstance(design, PairDesign)
    before = bodies_of(design)
    wider = replace(design.pair, pinion=replace(design.pair.pinion, face_width=26.0))
    after = bodies_of(replace(design, pair=wider))
    assert before.bodies[1].surface == after.bodies[1].surface
    assert before.bodies[0].surface != after.bodies[0].surface
    assert set(after.surfaces) == {body.surface for body in after.bodies}


def test_a_surface_is_what_the_browser_reads() -> None:
    design = read_spec(templates() / "spur.toml")
    (gear,) = design.gears.values()  # type: ignore[attr-defined]
    content = surface_of(gear).content
    vertices, triangles = np.frombuffer(content, "<u4", 2)
    corners = np.frombuffer(content, "<u2", offset=8 + 12 * int(vertices))
    assert len(corners) == 3 * triangles
    assert corners.max() == vertices - 1
    x, y, _ = np.frombuffer(content, "<f4", 3 * int(vertices), 8).reshape(-1, 3).T
    assert np.hypot(x, y).max() == pytest.approx(gear.tip_diameter / 2, abs=1e-4)


def test_why_there_are_no_bodies() -> None:
    found = bodies_of(read_spec(templates() / "train-1-stage.toml"))
    assert not found.bodies
    assert "has no bodies" in found.why_not
