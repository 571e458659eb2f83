"""The order in which nodes of a swept sector go: all of them, once, and at what cost over the width."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from gearcad import Gear
from gearcad.contact.solid.dissection import HalfTurn, Halves, dissected
from gearcad.meshing.outline import MeshSizes, OutlineSide
from gearcad.meshing.quads import mesh_quads
from gearcad.meshing.sector import SweptMesh, sweep

GEAR = Gear(teeth=20, normal_module=2.0, face_width=20, helix_angle=15)
SIZES = MeshSizes(flank=0.6, corner=0.3, fillet=0.3, outline=0.6, cut=0.5, rim=4.0, growth=0.45)


def halves_of(mesh: SweptMesh) -> Halves:
    section = mesh.section
    return dissected(HalfTurn(mesh), np.r_[section.behind, section.ahead], mesh.side(OutlineSide.HELD))


def swept(layers: int, finer: float = 1.0) -> SweptMesh:
    return sweep(GEAR, mesh_quads(GEAR, 12.0, SIZES.scaled(finer)), layers)


@pytest.mark.parametrize(("layers", "finer"), [(1, 1.0), (2, 0.8), (5, 0.8), (8, 1.0), (9, 1.0)])
def test_every_node_goes_once(layers: int, finer: float) -> None:
    """In the half or what the turn makes of it, or between both; none of the cuts or the hub goes."""
    mesh = swept(layers, finer)
    turn, halves = HalfTurn(mesh), halves_of(mesh)
    own = np.concatenate([part.own for part in halves.half.every()])
    every = np.concatenate([own, turn.nodes[own], np.union1d(halves.between, turn.nodes[halves.between])])
    kept = mesh.over(np.r_[mesh.section.behind, mesh.section.ahead, mesh.side(OutlineSide.HELD)])
    assert sorted(every) == sorted(set(range(mesh.nodes)) - set(kept.tolist()))


def test_turn_brings_every_node_to_the_place_of_another() -> None:
    """Seen from the axes that turn with the section, half-way up."""
    mesh = swept(5)
    turn = HalfTurn(mesh)
    assert (turn.nodes[turn.nodes] == np.arange(mesh.nodes)).all()
    places = np.c_[mesh.in_section, mesh.heights - GEAR.face_width / 2]
    assert turn.turned(places.ravel()).reshape(-1, 3) == pytest.approx(places, abs=1e-9)


def test_cost_grows_slower_than_the_square_of_the_width() -> None:
    """Operations and numbers that are kept, from a width of 12 layers on."""
    found = [halves_of(swept(layers)) for layers in (12, 24, 48)]
    for few, many in pairwise(found):
        assert np.log2(many.factors / few.factors) < 1.45
    assert np.log(found[-1].flops / found[0].flops) / np.log(4) < 2.0
