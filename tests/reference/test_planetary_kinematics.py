"""Speeds, torques, efficiencies and forces of planetary sets of all types, and of the train of the Alm thesis."""

import math

import pytest
from support.planetary_trains import alm_train, unchecked_set
from support.published import Published

from gearcad.planetary import TrainLoad
from gearcad.planetary.power import efficiency, forces, power_flow
from gearcad.planetary.train_data import speeds, willis_row

MESH_EFFICIENCY = math.sqrt(0.985 * 0.99)

SETS = {
    "A": ((24, 21, 21, -66), -2.75, 90),
    "B": ((24, 40, 22, -74), -5.606060606060606, 1744),
    "C": ((30, 24, 23, 31), 1.0782608695652174, 54),
    "D": ((-70, 22, 21, -72), 1.0775510204081633, 114),
    "D in phase": ((-75, 24, 21, -72), 1.0971428571428572, 51),
}
"""Teeth of a, its rim, the rim of b, b; basic ratio; positions of planets (own computation in closed form)."""

CASES = [
    # type; fixed, input, output; ratio, planet against carrier, torques on a, b, c, efficiency, rolling power over input
    (
        "A",
        "abc",
        1.3636363636363638,
        0.838095238095238,
        (0.35459999999999997, 1.0, -1.3546),
        0.9933733333333333,
        0.26003999999999994,
    ),
    (
        "A",
        "acb",
        0.7333333333333334,
        1.1428571428571428,
        (-0.27161642328703406, -0.7283835767129659, 1.0),
        0.9932503318813172,
        0.27161642328703406,
    ),
    ("A", "bac", 3.75, -0.8380952380952381, (1.0, 2.6816625, -3.6816625), 0.9817766666666666, 0.7333333333333334),
    (
        "A",
        "bca",
        0.26666666666666666,
        -3.142857142857143,
        (-0.26177469363649786, -0.7382253063635021, 1.0),
        0.9816551011368669,
        0.7198804075003691,
    ),
    ("A", "cab", -2.75, -1.1428571428571428, (1.0, 2.6816625, -3.6816625), 0.97515, 1.0),
    ("A", "cba", -0.36363636363636365, 3.142857142857143, (0.35459999999999997, 1.0, -1.3546), 0.97515, 0.97515),
    (
        "B",
        "abc",
        1.1783783783783783,
        0.5091743119266054,
        (0.17394567567567565, 1.0, -1.1739456756756756),
        0.9962383027522935,
        0.1476144495412844,
    ),
    (
        "B",
        "acb",
        0.8486238532110092,
        0.6,
        (-0.15463718251053465, -0.8453628174894654, 1.0),
        0.9961572660146133,
        0.15463718251053465,
    ),
    ("B", "bac", 6.606060606060607, -0.5091743119266054, (1.0, 5.46675, -6.46675), 0.9789116972477063, 0.8486238532110092),
    (
        "B",
        "bca",
        0.1513761467889908,
        -3.3636363636363638,
        (-0.14817182709545698, -0.8518281729045429, 1.0),
        0.9788320699033219,
        0.830660242807865,
    ),
    ("B", "cab", -5.606060606060606, -0.6, (1.0, 5.46675, -6.46675), 0.97515, 1.0),
    ("B", "cba", -0.17837837837837836, 3.3636363636363638, (0.17394567567567565, 1.0, -1.1739456756756756), 0.97515, 0.97515),
    (
        "C",
        "abc",
        0.07258064516129031,
        17.22222222222222,
        (-0.9510530224465054, 1.0, -0.0489469775534947),
        0.674380579625927,
        13.103397198151852,
    ),
    ("C", "acb", 13.77777777777778, 1.25, (9.45729586135649, -10.45729586135649, 1.0), 0.7589972802597452, 9.45729586135649),
    (
        "C",
        "bac",
        -0.07826086956521738,
        -17.22222222222222,
        (1.0, -1.0514660869565218, 0.05146608695652177),
        0.6576222222222227,
        13.777777777777779,
    ),
    (
        "C",
        "bca",
        -12.777777777777779,
        1.3478260869565217,
        (9.45729586135649, -10.45729586135649, 1.0),
        0.7401361978452905,
        10.19743205920178,
    ),
    ("C", "cab", 1.0782608695652174, -1.25, (1.0, -1.0514660869565218, 0.05146608695652177), 0.97515, 1.0),
    (
        "C",
        "cba",
        0.9274193548387096,
        -1.3478260869565217,
        (-0.9043729838709677, 1.0, -0.09562701612903232),
        0.9751499999999999,
        0.9751499999999999,
    ),
    (
        "D",
        "abc",
        0.071969696969697,
        -44.21052631578945,
        (-0.9516795395890919, 1.0, -0.048320460410908095),
        0.6714000814989333,
        13.223336760606323,
    ),
    (
        "D",
        "acb",
        13.894736842105257,
        -3.1818181818181817,
        (9.52285432423543, -10.52285432423543, 1.0),
        0.7573266369714896,
        9.52285432423543,
    ),
    (
        "D",
        "bac",
        -0.07755102040816331,
        44.21052631578945,
        (1.0, -1.0507738775510205, 0.050773877551020474),
        0.6547157894736847,
        13.894736842105257,
    ),
    (
        "D",
        "bca",
        -12.894736842105257,
        -3.4285714285714284,
        (9.52285432423543, -10.52285432423543, 1.0),
        0.7385070700427481,
        10.261361394278179,
    ),
    ("D", "cab", 1.0775510204081633, 3.1818181818181817, (1.0, -1.0507738775510205, 0.050773877551020474), 0.97515, 1.0),
    (
        "D",
        "cba",
        0.928030303030303,
        3.4285714285714284,
        (-0.9049687499999999, 1.0, -0.09503125000000016),
        0.9751499999999999,
        0.9751499999999999,
    ),
    (
        "D in phase",
        "abc",
        0.08854166666666671,
        -35.294117647058805,
        (-0.9346852620964295, 1.0, -0.06531473790357048),
        0.7376723339697367,
        10.55644531308908,
    ),
    (
        "D in phase",
        "acb",
        11.294117647058817,
        -3.125,
        (7.993500790444395, -8.993500790444395, 1.0),
        0.7962995491539312,
        7.993500790444395,
    ),
    (
        "D in phase",
        "bac",
        -0.0971428571428572,
        35.294117647058805,
        (1.0, -1.0698788571428572, 0.06987885714285724),
        0.7193411764705888,
        11.294117647058817,
    ),
    (
        "D in phase",
        "bca",
        -10.294117647058817,
        -3.428571428571429,
        (7.993500790444395, -8.993500790444395, 1.0),
        0.776511505357456,
        8.770012295801852,
    ),
    ("D in phase", "cab", 1.0971428571428572, 3.125, (1.0, -1.0698788571428572, 0.06987885714285724), 0.97515, 1.0),
    (
        "D in phase",
        "cba",
        0.9114583333333333,
        3.428571428571429,
        (-0.8888085937499999, 1.0, -0.11119140625000012),
        0.97515,
        0.97515,
    ),
]
"""Own computation; torques agreed with powers balanced mesh by mesh on 3972 random sets."""


ALM = "Alm, master's thesis on a planetary train: its own statics"


def named(role: str) -> str:
    return "carrier" if role == "c" else role


@pytest.mark.parametrize(("kind", "roles", "ratio", "planet", "torques", "efficient", "rolling"), CASES)
def test_sets_have_the_speeds_torques_and_efficiency_of_willis(
    kind: str, roles: str, ratio: float, planet: float, torques: tuple[float, ...], efficient: float, rolling: float
) -> None:
    teeth = SETS[kind][0]
    fixed, driving, driven = map(named, roles)
    train = unchecked_set(*teeth, stepped=kind != "A", fixed=fixed, input=driving, output=driven)
    found = speeds(train, {driving: 1.0})
    assert found.members[driving] / found.members[driven] == pytest.approx(ratio, rel=1e-12)
    assert found.planet_relative == pytest.approx(planet, rel=1e-12)
    assert efficiency(train, MESH_EFFICIENCY) == pytest.approx(efficient, rel=1e-12)
    output = torques["abc".index(roles[2])]
    flow = power_flow(train, TrainLoad(torque=abs(output), speed=1.0, mesh_efficiency=MESH_EFFICIENCY))
    assert [flow.torques[name] for name in train.members] == pytest.approx(torques, rel=1e-12)
    assert flow.rolling_ratio == pytest.approx(rolling, rel=1e-12)
    assert flow.efficiency == pytest.approx(efficient, rel=1e-12)


@pytest.mark.parametrize("kind", SETS)
def test_basic_ratio_and_positions(kind: str) -> None:
    teeth, basic_ratio, positions = SETS[kind]
    train = unchecked_set(*teeth, stepped=kind != "A")
    row = willis_row(train)
    assert -row["b"] / row["a"] == pytest.approx(basic_ratio, rel=1e-15)
    assert abs(row["carrier"]) // math.gcd(*teeth[1:3]) == positions


@pytest.mark.parametrize(("in_phase", "ratio"), [(False, -124.28070175438597), (True, -101.01960784313727)])
def test_ratio_of_the_thesis(in_phase: bool, ratio: float) -> None:
    assert alm_train(in_phase=in_phase).ratio == pytest.approx(ratio, rel=1e-14)


def test_ratio_as_printed(published: Published) -> None:
    published("i", alm_train().ratio, "-124.28", 0.005, ALM)


def test_efficiency_of_the_set_of_the_thesis() -> None:
    """Of both meshes together 0.99; own computation, three decimals."""
    train, in_phase = alm_train(stages=()), alm_train(in_phase=True, stages=())
    assert efficiency(train, math.sqrt(0.99)) == pytest.approx(0.886, abs=5e-4)
    assert efficiency(train, math.sqrt(0.99), back=True) == pytest.approx(0.870, abs=5e-4)
    assert efficiency(in_phase, math.sqrt(0.99)) == pytest.approx(0.907, abs=5e-4)


@pytest.mark.parametrize(("in_phase", "force"), [(False, 1014.838), (True, 1248.518)])
def test_force_of_the_pre_stage_of_the_thesis(in_phase: bool, force: float) -> None:
    train = alm_train(in_phase=in_phase)
    found = forces(train, power_flow(train, TrainLoad(torque=1600.0)))
    assert found.stages["pre_stage"].normal == pytest.approx(force, abs=1e-3)


def test_forces_in_the_set_of_the_thesis(published: Published) -> None:
    """Normal forces of the thesis's own statics. On the pin 4772 N inwards; along the circle what the carrier's torque asks:
    1600/13.8947 N·m on three pins at 69 mm, which is 556.3 N."""
    train = alm_train()
    found = forces(train, power_flow(train, TrainLoad(torque=1600.0)))
    published("normal force of mesh 3-4, N", found.meshes["ring_4-rim_3"].normal, 5374.64, 0.01, ALM)
    published("normal force of mesh 3'-5, N", found.meshes["ring_5-rim_3p"].normal, 6063.69, 0.01, ALM)
    published("radial force on a pin, N", found.pin.radial, "-4772", 0.5, ALM)
    assert found.pin.tangential == pytest.approx(1600 / 13.894736842105257 / (3 * 0.069), rel=1e-12)
