"""Displacements over speed, as J. Osinski's paper draws them (figures 3 and 8).

Printed are only pictures, and what the text says of them; the half ranges are those of another program: harmonic balance of
five harmonics, written down matrix by matrix.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.responses import cosine, two_stages

from gearcad.core.runtime import templates
from gearcad.designs import read_spec
from gearcad.dynamics.response.kv_chart import kv_chart
from gearcad.dynamics.response.linear_response import periodic_response
from gearcad.dynamics.train_study import study_train
from gearcad.dynamics.trains.mesh_excitation import Excitation

THREE_DIGITS = 0.005

HALF_RANGES = {0.0: (34.3, 1.52, 13.9), 180.0: (10.7, 21.2, 4.95)}
"""Of y of the first stage (µm) at 9971, 16559 and 24976 1/s, for two phases of the second mesh (deg)."""


def test_figure_3_turns_peak_at_the_lowest_resonance_and_the_approach_at_the_highest() -> None:
    spec = read_spec(templates() / "train-1-stage.toml")
    study = study_train(spec.train, replace(spec.dynamics, speeds=300))  # type: ignore[union-attr]
    moved, frequencies = study.up.displacements, study.up.frequencies
    near = [np.abs(frequencies / each - 1) < 0.05 for each in study.modes.circular[[0, -1]]]
    for turn in (*moved.turns.T, *moved.farthest.T):
        assert turn[near[0]].max() == turn.max() > 4 * turn[near[1]].max()
    approach = moved.approaches[:, 0]
    assert approach[near[1]].max() == approach.max() > 1.3 * approach[near[0]].max()


@pytest.mark.parametrize("phase", HALF_RANGES)
def test_figure_8_approach_of_the_first_of_two_stages(phase: float) -> None:
    """A stiff shaft lets the stages vibrate against each other at w2 and w4, not at w3, where both meshes move alike."""
    excitation = Excitation(meshes=(*cosine(0.206).meshes, *cosine(0.206, phase=phase).meshes))
    chart = kv_chart(periodic_response(two_stages(), excitation, [9971.0, 16559.0, 24976.0]))
    assert chart.displacements.approaches[:, 0] == pytest.approx(HALF_RANGES[phase], rel=THREE_DIGITS)
