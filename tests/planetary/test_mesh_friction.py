"""Efficiency of the meshes of a planetary set by the friction of their flanks."""

import math

import pytest

from gearcad import Gear
from gearcad.designs import read_spec
from gearcad.designs.reader import starter_text
from gearcad.geometry.tooth_friction import ohlendorf_loss_factor
from gearcad.planetary.members import TrainLoad
from gearcad.planetary.power import power_flow


@pytest.fixture(scope="module")
def train(tmp_path_factory: pytest.TempPathFactory) -> object:
    path = tmp_path_factory.mktemp("set") / "set.toml"
    path.write_text(starter_text("planetary-24-21-66")[1], encoding="utf-8")
    return read_spec(path).train


def test_friction_finds_what_is_not_given(train: object) -> None:
    flow = power_flow(train, TrainLoad(output_torque=100.0, speed=1000.0, friction=0.06))
    sun, ring = (1 - 0.06 * ohlendorf_loss_factor(mesh.pair) for mesh in train.meshes)
    assert list(flow.mesh_efficiencies.values()) == pytest.approx([sun, ring], rel=1e-12)
    assert sun < ring < 1  # flanks of a ring slide less
    # From the sun to the carrier with the ring held (VDI 2157): (1 + eta |z_r|/z_s)/(1 + |z_r|/z_s), eta of both in a row.
    ratio = 66 / 24
    assert flow.efficiency == pytest.approx((1 + sun * ring * ratio) / (1 + ratio), rel=1e-9)
    document = flow.to_dict()
    assert document["mesh_efficiency_source"] == "friction"
    assert document["mesh_efficiency"] == pytest.approx(math.sqrt(sun * ring), rel=1e-12)


def test_what_is_given_stays_given(train: object) -> None:
    given = power_flow(train, TrainLoad(output_torque=100.0, mesh_efficiency=0.99, friction=0.06)).to_dict()
    assert (given["mesh_efficiency"], given["mesh_efficiency_source"]) == (0.99, "given")
    assert "mesh_efficiencies" not in given
    none = power_flow(train, TrainLoad(output_torque=100.0)).to_dict()
    assert (none["mesh_efficiency"], none["mesh_efficiency_source"]) == (1.0, "assumed")


def test_loss_factor_of_a_ring_is_that_of_its_sliding(train: object) -> None:
    """Sliding levers over the base radius by half and whole shares, over the base pitch: the ratio of a ring is negative."""
    pair = next(mesh.pair for mesh in train.meshes if mesh.pair.internal)
    assert isinstance(pair.pinion, Gear)
    path, pitch, lost = pair.path_of_contact, pair.pinion.transverse_base_pitch, 0.0
    for low, high, share in ((path.A, path.B, 0.5), (path.B, path.C, 1.0), (path.C, path.D, 1.0), (path.D, path.E, 0.5)):
        lost += share * (abs(low - path.C) + abs(high - path.C)) / 2 * (high - low)
    factor = lost / pitch * (1 - pair.pinion.teeth / abs(pair.wheel.teeth)) / (pair.pinion.base_diameter / 2)
    assert ohlendorf_loss_factor(pair) == pytest.approx(factor, rel=1e-6)
