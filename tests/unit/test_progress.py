"""Progress of long jobs: never backwards, on stderr only, and what they take is told before they start."""

import json
import math
import re
import tracemalloc
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from click.testing import Result
from support.checks import coarse_pair
from support.commands import invoke
from support.pictures import leave_out_pictures
from support.responses import cosine, oscillator
from support.specs import TEMPLATES
from support.trains import thesis_model
from threadpoolctl import threadpool_limits

from gearcad import Gear, GearPair, Load, Material
from gearcad.check.options import CheckOptions
from gearcad.check.run import expected_check, plane_steps
from gearcad.check.task import check_task
from gearcad.cli import job as shown
from gearcad.contact.shared.bodies import BodyModel
from gearcad.contact.solid.pair import SolidPair, SolidSizes, expected_bodies, solid_pair
from gearcad.core.runtime import Agenda, Expected, Share, cores, onwards, part
from gearcad.designs import TrainDesign
from gearcad.designs.reader import read_spec
from gearcad.dynamics.response.speed_charts import over_speed
from gearcad.dynamics.time_domain import campbell as module
from gearcad.dynamics.time_domain.campbell import campbell
from gearcad.jobs.dynamics import Dynamics
from gearcad.stiffness import finite_elements
from gearcad.stiffness.methods import compare_methods

SPEC = """
[pair]
normal_module = 2.0
face_width = 6.0
tooth_thinning = 0.05
[pinion]
teeth = 20
[wheel]
teeth = 30
[load]
torque = 40.0
[check]
model = "3d"
body_teeth = 3
refinement = 0.35
positions = 12
torques = [40.0]
"""

LINE = re.compile(r"\[ *(\d+) %\] (.+?)(?:, about (\d+) (?:s|min) left)?")


def test_steps_count_by_the_seconds_they_are_expected_to_take() -> None:
    told: list[tuple[str, float, float]] = []
    agenda = Agenda(lambda *each: told.append(each), {"bodies": 30.0, "cycle": 9.0, "rating": 1.0})
    agenda("bodies")
    agenda.within("bodies")(0.5)
    agenda.counted("cycle", "position")(2, 3)
    agenda("rating", detail="flanks")
    assert told == [
        ("bodies", 0.0, 40.0),
        ("bodies", 15.0, 40.0),
        ("cycle, position 3 of 3", 36.0, 40.0),
        ("rating, flanks", 39.0, 40.0),
    ]
    Agenda(None, {"bodies": 1.0})("bodies")  # nobody asks


@pytest.fixture(scope="module")
def checked(tmp_path_factory: pytest.TempPathFactory) -> Result:
    """A check of solid bodies, its progress shown, where there is no terminal."""
    place = tmp_path_factory.mktemp("progress")
    (place / "spur.toml").write_text(SPEC, encoding="utf-8")
    with pytest.MonkeyPatch.context() as patch:
        leave_out_pictures(patch)
        patch.setattr(shown, "_LONG", 0.01)
        return invoke("check", str(place / "spur.toml"), "--json", "-o", str(place / "out"))


def test_percent_and_time_left_stand_on_stderr(checked: Result) -> None:
    assert json.loads(checked.stdout)["kind"] == "check"
    first, *rest, verdict = checked.stderr.splitlines()
    assert re.fullmatch(r"takes about \d+ s and \d+(?:\.\d)? [MG]B of memory", first)
    found = [LINE.fullmatch(line) for line in rest]
    percents = [int(each[1]) for each in found if each]
    assert len(percents) == len(rest) and percents[0] == 0
    assert percents == sorted(percents) and percents[-1] <= 100
    assert all(each[3] for each in found[:2] if each)
    assert "strength not asked for" in verdict


def test_a_check_tells_of_bodies_positions_and_other_meshes(checked: Result) -> None:
    steps = [each[2] for line in checked.stderr.splitlines() if (each := LINE.fullmatch(line))]
    told = list(dict.fromkeys(re.sub(r" \d+ of \d+", "", step) for step in steps))
    assert told == [
        "bodies of pinion and wheel",
        "mesh cycle, position",
        "torque sweep",
        "coarser bodies, for the error",
        "finer bodies, for the error",
        "rating",
    ]


def test_stiffness_of_solids_tells_how_far_its_bodies_are(monkeypatch: pytest.MonkeyPatch) -> None:
    """The bodies' share is most of the method's, which is most of all methods'."""

    def coarse(*given: Any, tell: Share, **options: Any) -> SolidPair:
        made = solid_pair(*given, sizes=SolidSizes().refined(0.35), **options)
        for share in (0.0, 0.5, 1.0):
            tell(share)
        return made

    monkeypatch.setattr(finite_elements, "solid_pair", coarse)
    told: list[tuple[str, float, float]] = []
    pair, load, body = coarse_pair("helical"), Load(torque=60.0), BodyModel(teeth=3)
    with threadpool_limits(1):
        compare_methods(
            pair, Material(), load, ("iso6336", "3d"), body=body, positions=12, progress=lambda *each: told.append(each)
        )
    assert [what for what, _, _ in told] == ["iso6336", "3d", "3d", "3d", "3d"]
    expected = expected_bodies(pair, body, SolidSizes()).seconds
    begin, _, half, whole = (done for _, done, _ in told[1:])
    assert half - begin == pytest.approx(expected / 2)
    assert whole - begin == pytest.approx(expected)
    assert [every for _, _, every in told] == pytest.approx([begin + expected] * 5, rel=0.5)


def test_what_takes_much_memory_says_so_however_quick_it_is(capsys: pytest.CaptureFixture[str]) -> None:
    for seconds, memory in ((9.0, 9e8), (9.0, 1.1e9)):
        with shown.job_progress(shown=True, expected=Expected(seconds, memory, "makes 9 hex8")):
            pass
    assert capsys.readouterr().err == "makes 9 hex8\nmakes 9 hex8, takes about 9 s and 1.1 GB of memory\n"


def test_lines_come_now_and_then(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """A step is told when it begins and every five seconds; time left goes by what was expected, later by the pace."""
    now = 1000.0
    monkeypatch.setattr(shown.time, "monotonic", lambda: now)
    with shown.job_progress(shown=True, expected=Expected(7300.0, 2.46e9)) as told:
        assert told is not None
        for second, (what, done) in enumerate([("a", 0.0), ("a", 1.0), ("b, 1 of 9", 2.0), ("b, 2 of 9", 3.0), ("c", 9.0)]):
            now = 1000.0 + second
            told(what, done, 100.0)
        now = 1060.0
        told("c", 50.0, 100.0)
    assert capsys.readouterr().err.splitlines() == [
        "takes about 2.0 h and 2.5 GB of memory",
        "[  0 %] a, about 2.0 h left",
        "[  2 %] b, 1 of 9, about 2.0 h left",
        "[  9 %] c, about 1.8 h left",
        "[ 50 %] c, about 60 s left",
    ]


def test_memory_of_bodies_is_what_was_expected() -> None:
    """Within a third, one gear after the other; arrays of numpy are traced, libraries are there before."""
    import skfem  # noqa: F401

    import gearcad.contact.solid.kernels  # noqa: F401

    pair, body, sizes = coarse_pair("helical"), BodyModel(), SolidSizes().refined(0.6)
    tracemalloc.start()
    try:
        with threadpool_limits(1):
            solid_pair(pair, Material(), body=body, sizes=sizes)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert expected_bodies(pair, body, sizes).memory == pytest.approx(peak, rel=1 / 3)


@pytest.mark.parametrize("backlash", [None, math.inf])
def test_a_chart_tells_how_far_it_is(backlash: float | None) -> None:
    """Of a resonance over which flanks stick, or part: many shares, never backwards, most of it told."""
    told: list[float] = []
    over_speed(oscillator(0.05), cosine(0.2, phase=180.0, backlash=backlash), np.linspace(0.5, 1.4, 13), share=told.append)
    assert len(set(told)) > 3 and told == sorted(told)
    assert 0 < told[0] < 0.6 and told[-1] == 1


def test_speeds_are_counted_and_an_interrupt_ends_a_study(monkeypatch: pytest.MonkeyPatch) -> None:
    speeds, told, begun = np.linspace(1000.0, 4000.0, 40), list[tuple[int, int]](), list[float]()
    motion = module.time_history

    def noted(model: object, speed: float, **options: object) -> object:
        begun.append(speed)
        return motion(model, speed, **options)  # type: ignore[arg-type]

    monkeypatch.setattr(module, "time_history", noted)
    campbell(thesis_model(), speeds[:3], duration=0.01, counted=lambda done, count: told.append((done, count)))
    assert told == [(1, 3), (2, 3), (2, 3)]
    begun.clear()

    def interrupt(_done: int, _count: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        campbell(thesis_model(), speeds, duration=0.2, counted=interrupt)
    assert len(begun) < 20


def test_runs_in_time_of_a_train_are_told_beforehand() -> None:
    """A Campbell diagram by its duration, drawn errors by the number of samples; nothing of what is soon there."""
    design = read_spec(TEMPLATES / "train-pairs.toml")
    assert isinstance(design, TrainDesign)

    def seconds(**options: object) -> float:
        found = Dynamics().expected(replace(design, dynamics=replace(design.dynamics, **options)))
        assert found is not None
        return found.seconds

    assert Dynamics().expected(design) is None
    half, whole = seconds(campbell="on", duration=0.5), seconds(campbell="on")
    drawn = [seconds(tooth_errors="on", error_samples=count) for count in (9, 19, 29)]
    assert drawn[2] - drawn[1] == pytest.approx(drawn[1] - drawn[0], rel=1e-9)
    # 54 CPU seconds were measured for the first, and more than 289 for some 20 samples.
    assert 25 < whole * cores() < 110 and whole > 1.3 * half
    assert drawn[1] * cores() > 289


def test_shares_of_parts() -> None:
    told: list[float] = []
    share = onwards(told.append)
    for done in (0.0, 0.5, 1.0):
        part(share, 0.2, 0.6)(done)
    part(share, 0.2, 0.6)(0.0)  # once more
    assert told == pytest.approx([0.2, 0.4, 0.6, 0.6])


PAIR = GearPair(
    pinion=Gear(teeth=16, normal_module=4.5, face_width=14.0), wheel=Gear(teeth=24, normal_module=4.5, face_width=14.0)
)


def steps(**options: object) -> dict[str, float]:
    asked = replace(CheckOptions(), **options)
    return plane_steps(check_task(PAIR, Material(), Load(torque=302.0), asked))


def test_steps_follow_what_is_asked_for() -> None:
    usual = steps()
    assert steps(convergence="off")["convergence"] == 0.0
    assert steps(torques=(100.0,))["torque sweep"] == pytest.approx(usual["torque sweep"] / 5)
    more, most = (steps(positions=count)["mesh cycle"] - usual["mesh cycle"] for count in (120, 180))
    assert most == pytest.approx(2 * more) and more > 0
    fine, finer = (steps(refinement=factor)["mesh cycle"] - usual["mesh cycle"] for factor in (2.0, 3.0))
    assert finer / fine == pytest.approx(8 / 3)


def test_all_of_them_are_what_the_check_takes() -> None:
    from gearcad import Material

    asked = CheckOptions(model="2d")
    assert expected_check(check_task(PAIR, Material(), Load(torque=302.0), asked)).seconds == pytest.approx(
        sum(steps().values())
    )
