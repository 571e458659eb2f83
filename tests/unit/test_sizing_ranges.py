"""Ranges of `gearcad size`, and what is said of absurd ones."""

from __future__ import annotations

from fractions import Fraction

import pytest
from click.testing import CliRunner

from gearcad.cli import main
from gearcad.cli.size_options import values_of
from gearcad.core.errors import ParameterError

TASK = {"--torque": "302", "--speed": "1500", "--ratio": "1.5", "--material": "Eh MQ"}


def run(**changes: str | None) -> str:
    """Standard error of a command that must refuse, in one line with exit status 2."""
    given = TASK | {f"--{name.replace('_', '-')}": value for name, value in changes.items()}
    words = [word for name, value in given.items() if value is not None for word in (name, value)]
    result = CliRunner().invoke(main, ["size", *words])
    assert result.exit_code == 2, result.output
    assert result.stderr.count("\n") == 1
    return result.stderr


def test_values_of_ranges() -> None:
    assert values_of("helix_angle", "0,10:25:5") == (0.0, 10.0, 15.0, 20.0, 25.0)
    assert values_of("shift", "0:1:0.1") == tuple(float(Fraction(number, 10)) for number in range(11))
    assert values_of("shift", "-0.2:0.25:0.2") == (-0.2, 0.0, 0.2)


@pytest.mark.parametrize("text", ["", "a", "1:2", "2:1:0.5", "0:1:0", "0:1:-1", "nan", "inf", "1/0", "0:1e9:1e-3", "1:2:3:4"])
def test_absurd_ranges_are_refused(text: str) -> None:
    with pytest.raises(ParameterError):
        values_of("shift", text)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"ratio": "0"}, "ratio = 0: must be a number at least 1"),
        ({"ratio": "nan"}, "ratio"),
        ({"ratio": None}, "ratio is missing"),
        ({"life": "-5"}, "life = -5"),
        ({"torque": "0"}, "torque = 0"),
        ({"torque": "-10"}, "torque = -10"),
        ({"torque": None}, "torque is missing"),
        ({"power": "5"}, "must not stand beside --power"),
        ({"speed": None}, "speed is missing"),
        ({"speed": "0"}, "speed = 0"),
        ({"material": None}, "material is missing"),
        ({"material": "unobtainium"}, "material = 'unobtainium'"),
        ({"wheel_material": "V MQ"}, "wheel.material.hardness is missing"),
        ({"hardness": "200"}, "hardness = 200"),
        ({"grade": "13"}, "grade = 13"),
        ({"teeth": "40:12"}, "teeth = [40, 12]"),
        ({"teeth": "12.5"}, "teeth = '12.5'"),
        ({"module": "60:70"}, "module = '60:70'"),
        ({"module": "0"}, "module = 0"),
        ({"helix_angle": "80"}, "helix_angle = 80"),
        ({"width_ratio": "0"}, "width_ratio = 0"),
        ({"ratio_tolerance": "0", "ratio": "1.0123456"}, "ratio_tolerance = 0"),
        ({"centre_distance": "-80"}, "centre_distance = -80"),
        ({"rack": "E"}, "rack = 'E'"),
        ({"by": "price"}, "must be one of 'mass'"),
        ({"rating": "nonsense=3"}, "rating = 'nonsense=3'"),
        ({"rating": "face_load_factor=fe"}, "face_load_factor = 'fe'"),
        ({"safety_scuffing": "1.5"}, "scuffing_stage is missing"),
        ({"count": "0"}, "count = 0"),
        ({"shift": "0:0.9:0.001", "shift_sum": "0:0.9:0.001", "width_ratio": "0.1:5:0.01"}, "variants together"),
    ],
)
def test_absurd_tasks_are_told_in_one_line(changes: dict[str, str | None], said: str) -> None:
    assert said in run(**changes)
