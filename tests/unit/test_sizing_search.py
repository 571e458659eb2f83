"""The search for sizes: its ranges, complete, in no order but its own, and the same each time; fronts, ripple, rounding."""

import itertools
import math
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from support.commands import invoke

from gearcad import GearPair, Load, Material, PerGear
from gearcad.core.errors import InputError, ParameterError
from gearcad.geometry import Gear
from gearcad.geometry.pair_data import profile_shift_sum, zero_backlash_centre_distance
from gearcad.jobs.size_options import values_of
from gearcad.rating import RatingOptions
from gearcad.rating.strength import rate_strength
from gearcad.sizing import Criterion, SizeTask, search_pairs
from gearcad.sizing.geometry import ManyPairs
from gearcad.sizing.proposals import PairsSoFar
from gearcad.sizing.rating import Rated, line_ripple, rate_many
from gearcad.sizing.search import (
    LIMITS,
    NEARLY,
    VariantGrid,
    front,
    least_width,
    ranked,
    refined,
    rounded_distance,
    rounded_width,
    survey,
)

EH = Material(name="Eh MQ")
SMALL = SizeTask(
    load=Load(torque=100.0, speed=1500.0, application_factor=1.25),
    ratio=2.0,
    materials=PerGear(EH, EH),
    rating=RatingOptions(life=10_000.0),
    ratio_tolerance=0.0,
    teeth=(18, 18),
    modules=(2.0, 2.5),
    helix_angles=(15.0,),
    width_ratios=(0.8, 1.0),
    shifts=(0.2, 0.4),
    shift_sums=(0.5,),
)
MORE = replace(
    SMALL, teeth=(13, 20), helix_angles=(0.0, 15.0), shifts=(0.1, 0.3, 0.5), shift_sums=(0.25, 0.75), ratio_tolerance=3.0
)
WIDE = replace(MORE, teeth=(16, 24), modules=(1.5, 2.0, 2.5), shifts=(0.0, 0.2, 0.4), shift_sums=(0.0, 0.5))


def by_loops(task: SizeTask) -> list[tuple[float, tuple[float, ...]]]:
    """Every variant made as a GearPair and rated one by one, with none of the arrays: mass, and what it is."""
    found = []
    for (z_1, z_2), m, beta, total, x_1, ratio in itertools.product(
        task.teeth_pairs, task.modules, task.helix_angles, task.shift_sums, task.shifts, task.width_ratios
    ):
        sizes = {"normal_module": m, "teeth": PerGear(z_1, z_2), "helix_angle": beta, "pressure_angle": 20.0}
        distance = round(zero_backlash_centre_distance(**sizes, shift_sum=total) * 2) / 2
        x_2 = profile_shift_sum(**sizes, centre_distance=distance) - x_1
        d_1 = m * z_1 / np.cos(np.radians(beta))
        width = round(ratio * d_1)

        def gear(z: int, x: float, hand: int, k: float, m: float = m, b: float = width, beta: float = beta) -> Gear:
            return Gear(teeth=z, normal_module=m, face_width=b, helix_angle=hand * beta, profile_shift=x, tip_alteration=k)

        try:
            k = 0.0
            for _ in range(2):
                pair = GearPair(pinion=gear(z_1, x_1, 1, k), wheel=gear(z_2, x_2, -1, k), centre_distance=distance)
                k = pair.tip_alteration
        except InputError:
            continue
        if any(each.undercut or each.tip_thickness < 0.4 * m for each in pair.gears) or width > 30 * m:
            continue
        if pair.transverse_contact_ratio < 1.2 or pair.usable_contact_ratio < pair.transverse_contact_ratio - 1e-9:
            continue
        one = rate_strength(pair, task.materials, task.load, task.rating)
        if one.passed:
            areas = sum(np.pi / 8 * (each.tip_diameter**2 + each.root_diameter**2) for each in pair.gears)
            found.append((float(areas * width * 7850e-9), (z_1, z_2, m, beta, x_1, width)))
    return sorted(found)


def described(rated: Rated, place: int) -> tuple[float, ...]:
    pairs = rated.pairs
    columns = (*pairs.teeth, pairs.normal_module, pairs.helix_angle, pairs.shifts.pinion, rated.width)
    return tuple(float(each[place]) for each in columns)


@pytest.mark.parametrize("task", [SMALL, pytest.param(MORE, marks=pytest.mark.long)], ids=["small", "more"])
def test_the_optimum_is_that_of_plain_loops(task: SizeTask) -> None:
    expected = by_loops(task)
    seen = survey(task)
    assert seen.best is not None
    assert seen.considered == task.variants
    assert 0 < sum(seen.removed.values()) == task.variants - len(expected)
    mass, variant = expected[0]
    first = int(ranked(seen.best, Criterion.MASS)[0])
    assert described(seen.best, first) == pytest.approx(variant)
    assert seen.best.mass[first] == pytest.approx(mass, rel=1e-12)


def test_the_order_of_ranges_has_no_say() -> None:
    one = survey(WIDE)
    turned = {
        name: tuple(reversed(getattr(WIDE, name))) * 2
        for name in ("modules", "helix_angles", "width_ratios", "shifts", "shift_sums")
    }
    other = survey(replace(WIDE, **turned))
    again = survey(WIDE)
    assert one.best is not None
    for each in (other, again):
        assert each.best is not None and each.removed == one.removed
        for name in ("order", "mass", "margin", "width"):
            assert np.array_equal(getattr(each.best, name), getattr(one.best, name))
    assert other.best is not None and one.best is not None
    assert np.array_equal(refined(replace(WIDE, **turned), other.best, 40).mass, refined(WIDE, one.best, 40).mass)


def test_chunks_have_no_say(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = survey(WIDE)
    monkeypatch.setattr("gearcad.sizing.search.CHUNK", 37)
    monkeypatch.setattr("gearcad.sizing.search._MOST_KEPT_VARIANTS", 10)
    parts = survey(WIDE)
    assert whole.best is not None and whole.front is not None and parts.best is not None and parts.front is not None
    assert np.array_equal(whole.best.order, parts.best.order)
    assert np.array_equal(np.sort(whole.front.order), np.sort(parts.front.order))
    assert whole.removed == parts.removed
    fine = refined(WIDE, whole.best, 40)
    monkeypatch.setattr("gearcad.sizing.search._AT_A_TIME", 5)
    assert np.array_equal(refined(WIDE, whole.best, 40).mass[:20], fine.mass[:20])


@pytest.mark.parametrize("criterion", Criterion)
def test_refinement_stays_in_the_ranges_and_is_no_worse(criterion: Criterion) -> None:
    task = replace(WIDE, criterion=criterion)
    best = survey(task).best
    assert best is not None
    found = refined(task, best, 40)
    pairs, slack = found.pairs, 1e-9
    assert found.safe(task).all() and np.array_equal(ranked(found, criterion), np.arange(len(found.order)))
    assert np.all((pairs.shifts.pinion >= task.shifts[0]) & (pairs.shifts.pinion <= task.shifts[-1]))
    assert np.all((pairs.helix_angle == 0) | (pairs.helix_angle == 15))
    least, most = (rounded_width(task.width_ratios[end] * pairs.diameters.pinion) for end in (0, -1))
    assert np.all((found.width >= least - slack) & (found.width <= most + slack))
    assert np.all(pairs.centre_distance == rounded_distance(pairs.centre_distance, pairs.normal_module))
    first = Rated.joined([found.picked([0]), best])
    assert ranked(first, criterion)[0] == 0 or first.mass[0] == pytest.approx(first.mass.min(), rel=1e-9)


PLAIN = replace(
    SMALL,
    load=Load(torque=302.0, speed=1500.0),
    ratio=1.5,
    ratio_tolerance=2.0,
    rating=RatingOptions(life=20_000.0),
    teeth=(25, 25),
    modules=(3.0,),
    helix_angles=(0.0,),
    width_ratios=(0.3, 0.6, 0.9, 1.2),
    shifts=(0.0, 0.35, 0.7),
    shift_sums=(0.0, 0.5, 1.0),
)


def dense(task: SizeTask, z_1: int, z_2: int, m: float, beta: float) -> float:
    """Mass of the lightest at all round centre distances, all shifts in twentieths and all widths in whole mm."""
    sizes: dict[str, Any] = {"normal_module": m, "teeth": PerGear(z_1, z_2), "helix_angle": beta, "pressure_angle": 20.0}
    d_1 = m * z_1 / np.cos(np.radians(beta))
    widths = np.arange(round(task.width_ratios[0] * d_1), min(round(task.width_ratios[-1] * d_1), 30 * m) + 1)
    distances = [each / 2 for each in range(math.floor(d_1 * (1 + z_2 / z_1)) - 4, math.ceil(d_1 * (1 + z_2 / z_1)) + 9)]
    totals = [profile_shift_sum(**sizes, centre_distance=each) for each in distances]
    made = np.array([(a, x, total - x) for a, total in zip(distances, totals, strict=True) for x in np.arange(15) / 20])
    every = [np.full(len(made), each) for each in (float(z_1), float(z_2), m, beta)]
    pairs = ManyPairs(
        key=np.arange(len(made)),
        teeth=PerGear(*every[:2]),
        normal_module=every[2],
        helix_angle=every[3],
        centre_distance=made[:, 0],
        shifts=PerGear(made[:, 1], made[:, 2]),
        rack=task.rack,
    )
    for met in LIMITS.values():
        pairs = pairs.picked(met(pairs, task))
    size = np.tile(widths, (len(pairs.key), 1))
    found = rate_many(task, pairs, size, np.ones(size.shape, bool), np.zeros(size.shape, int))
    return float(found.mass[found.safe(task)].min(initial=np.inf))


@pytest.mark.parametrize(
    "task",
    [
        PLAIN,
        replace(PLAIN, teeth=(32, 33), modules=(2.0,), helix_angles=(22.0, 24.0)),
        pytest.param(replace(PLAIN, teeth=(20, 32), modules=(2.5, 3.0)), marks=pytest.mark.long),
        pytest.param(
            replace(PLAIN, teeth=(20, 34), modules=(2.0, 2.5, 3.0), helix_angles=(18.0, 21.0, 24.0)), marks=pytest.mark.long
        ),
    ],
    ids=["spur", "helical", "all spur", "many helical"],
)
def test_refinement_finds_what_a_dense_grid_has(task: SizeTask) -> None:
    """Each line is as light as the lightest of its teeth, module and helix angle, and the first of all helix angles."""
    found = search_pairs(task, count=10, errors=0).found
    for each in found:
        assert each.mass <= dense(task, *each.teeth, each.normal_module, each.helix_angle) * NEARLY
    angles = np.arange(2 * task.helix_angles[0], 2 * task.helix_angles[-1] + 1) / 2
    lightest = min(dense(task, *z, m, beta) for z in task.teeth_pairs for m in task.modules for beta in angles)
    assert found[0].mass <= lightest * NEARLY


@pytest.mark.long
def test_lightest_pairs_of_a_spur_task_known_from_plain_loops() -> None:
    """Masses (kg) that loops over shifts, centre distances and widths found."""
    known = {(25, 37, 3.0): 2.604, (24, 36, 3.0): 2.69, (25, 38, 3.0): 2.70, (29, 44, 2.5): 2.73, (29, 43, 2.5): 2.74}
    usual = {name: getattr(SizeTask, name) for name in ("width_ratios", "shifts", "shift_sums")}
    found = search_pairs(replace(PLAIN, teeth=(20, 32), modules=(2.5, 3.0), **usual), errors=0).found
    masses = {(*each.teeth, each.normal_module): each.mass for each in found}
    assert found[0].mass == min(masses.values())
    for pair, mass in known.items():
        assert masses[pair] <= mass * NEARLY


def test_a_search_tells_its_best_so_far_and_finds_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcad.sizing.search.CHUNK", 1 << 9)
    quiet = search_pairs(WIDE, count=5, errors=0)
    told: list[PairsSoFar] = []
    heard = search_pairs(WIDE, count=5, errors=0, heard=lambda so_far: told.append(so_far()))
    assert [each.to_dict() for each in heard.found] == [each.to_dict() for each in quiet.found]
    assert [each.name for each in told[-1].found] == [each.name for each in quiet.found] and told[-1].rated
    masses = [each.found[0].mass for each in told if each.found and not each.rated]
    assert len(masses) > 3 and masses == sorted(masses, reverse=True)
    clouds = [each.cloud.shape[1] for each in told]
    assert clouds == sorted(clouds) and clouds[-1] == quiet.cloud.shape[1]


def test_least_width_has_just_the_safety_that_is_required() -> None:
    best = survey(WIDE).best
    assert best is not None
    variant = best.picked(ranked(best, Criterion.MASS)[:1])
    width = least_width(WIDE, variant)
    assert width <= variant.width[0]
    there = np.ones((1, 1), bool)
    found = rate_many(WIDE, variant.pairs, np.array([[width]]), there, np.zeros((1, 1), int))
    assert found.margin[0] == pytest.approx(1, abs=1e-6)


def test_what_has_no_tolerances_is_left_out() -> None:
    """ISO 1328-1 begins at face widths of 4 mm."""
    tiny = replace(WIDE, load=Load(torque=0.02, speed=1500.0), modules=(0.5,), width_ratios=(0.3, 0.7))
    seen = survey(tiny)
    assert seen.removed["range of the rating"] > 0
    assert seen.best is not None
    assert seen.best.width.min() >= 4


def test_front_of_mass_and_safety() -> None:
    best = survey(WIDE).best
    assert best is not None
    mass, margin, there = best.mass, best.margin, front(best)
    for place in range(len(mass)):
        beaten = np.any((mass <= mass[place]) & (margin >= margin[place]) & ((mass < mass[place]) | (margin > margin[place])))
        assert there[place] != beaten


def test_ripple_of_the_lines_of_contact() -> None:
    pair = GearPair(
        pinion=Gear(teeth=20, normal_module=2.0, face_width=22.0, helix_angle=17.0),
        wheel=Gear(teeth=31, normal_module=2.0, face_width=22.0, helix_angle=-17.0),
    )
    lengths = pair.contact_line_lengths
    expected = (lengths.maximum - lengths.minimum) / lengths.mean
    found = line_ripple(np.array([pair.transverse_contact_ratio, 1.6]), np.array([pair.overlap_ratio, 0.0]))
    assert found == pytest.approx([expected, 1 / 1.6], rel=1e-9)


def test_figures() -> None:
    distances = rounded_distance(np.array([9.4567, 91.4567, 153.456, 1534.6]), np.array([0.3, 1.0, 2.0, 12.0]))
    assert distances == pytest.approx([9.45, 91.4, 153.5, 1534.0], rel=1e-15)
    assert rounded_width(np.array([3.14, 9.99, 10.4, 100.6])) == pytest.approx([3.1, 10.0, 10.0, 101.0])


def test_keys_name_every_variant_once() -> None:
    keys = np.concatenate([pairs.key for pairs in VariantGrid(WIDE).chunks()])
    assert np.array_equal(keys, np.arange(len(VariantGrid(WIDE))))


TASK = {"--torque": "302", "--speed": "1500", "--ratio": "1.5", "--material": "Eh MQ"}


def run(**changes: str | None) -> str:
    """Standard error of a command that must refuse, in one line with exit status 2."""
    given = TASK | {f"--{name.replace('_', '-')}": value for name, value in changes.items()}
    words = [word for name, value in given.items() if value is not None for word in (name, value)]
    result = invoke("size", *words)
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
