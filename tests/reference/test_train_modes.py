"""Natural frequencies and modes of trains against Osinski's paper, and of planetary trains against Lin and Parker's."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq
from support.cases import data_rows
from support.planetary_trains import lin_parker_train, masses_of
from support.published import Published
from support.trains import SHORT, one_stage, two_stages

from gearcad.dynamics.planetary.planetary_modes import ModeKind, PlanetaryModes, planetary_modes
from gearcad.dynamics.trains.members import GROUND, Inertia, Shaft, ToothMesh
from gearcad.dynamics.trains.shaft_lines import lines_of, system, twist_shapes
from gearcad.dynamics.trains.train import Train, static_forces
from gearcad.dynamics.trains.train_modes import count_below, natural_modes

CONTINUOUS = (1641.12352431, 10077.48060731, 12708.28743912, 19523.94715846, 20154.95062324, 28022.64288784)
"""Roots (1/s) of the frequency equation of two clamped shafts and their mesh, bracketed on a fine scan: eight decimals."""

DIGITS = 1e-8
"""The decimals of CONTINUOUS (1/s)."""

ELEMENTS = 2e-12
"""Relative: one element of degree 12 on each shaft has no greater error in the first five modes, or the sixth."""

DECIMALS_3 = 6e-4
"""Computed values of the reference with three decimals (1/s)."""

OSINSKI = "Osinski, choice of the dynamic model of a gear drive, table 1"


def test_isolated_pair(published: Published) -> None:
    modes = natural_modes(one_stage("isolated"))
    assert modes.rigid == 1 and modes.circular[0] == 0
    assert modes.circular[1] == pytest.approx(math.sqrt(7.05e8 * (0.0507**2 / 0.0058 + 0.1353**2 / 0.2228)), rel=1e-12)
    assert modes.circular[1] == pytest.approx(19245.076, abs=DECIMALS_3)
    published(
        "isolated pair, 1/s", modes.circular[1], "19251", 4e-4 * 19251, OSINSKI
    )  # base radii are printed with three figures
    assert modes.rpm[1, 0] == pytest.approx(19245.076 * 60 / (2 * math.pi * 18), rel=1e-7)
    assert modes.inertias == ("pinion", "wheel") and modes.shafts == ()


def test_massless_shafts() -> None:
    modes = natural_modes(one_stage("massless"))
    assert modes.circular == pytest.approx([1681.679, 19656.795], abs=DECIMALS_3)
    assert modes.circular == pytest.approx([1691, 19682], rel=6e-3)  # printed; no positive stiffness gives both
    assert modes.missed == 0


def test_shafts_with_mass() -> None:
    exact = natural_modes(one_stage("exact"), count=6)
    elements = natural_modes(one_stage("elements"), count=6)
    assert exact.circular == pytest.approx(CONTINUOUS, abs=DIGITS)
    assert elements.circular == pytest.approx(exact.circular, rel=ELEMENTS)
    assert exact.missed == elements.missed == exact.rigid == elements.rigid == 0
    assert elements.shape == pytest.approx(exact.shape, abs=1e-6 * np.abs(exact.shape).max())
    assert elements.shaft_shape == pytest.approx(exact.shaft_shape, abs=1e-5 * np.abs(exact.shaft_shape).max())
    assert elements.kinetic_shafts == pytest.approx(exact.kinetic_shafts, abs=1e-8)
    assert elements.potential_meshes == pytest.approx(exact.potential_meshes, abs=1e-8)
    # What the paper prints; its fourth is between the true fourth and fifth mode, and its 1679 and 10006 nothing gives.
    for printed, place, within in ((1679, 0, 0.024), (10006, 1, 0.0072), (12750, 2, 0.0034), (19863, 3, 0.018)):
        assert exact.circular[place] == pytest.approx(printed, rel=within)


def test_component_modes_of_the_paper(published: Published) -> None:
    train = one_stage("modes")
    modes = natural_modes(train)
    assert modes.circular == pytest.approx([1641.941, 12752.092, 19861.483], abs=DECIMALS_3)
    for number, printed in ((1, 12750), (2, 19863)):
        published(f"component modes, {number + 1}, 1/s", modes.circular[number], f"{printed}", 2e-4 * printed, OSINSKI)
    published("component modes, 2, rpm", modes.rpm[1, 0], "6750", 3e-3 * 6750, OSINSKI)
    # Below 19861 1/s the train itself has four: 10077 is not among these.
    assert modes.missed == 1
    lines = lines_of(train)
    first, second = (lines.shafts[0].T @ twist_shapes(12, [0.5, 1.0]))[:2]  # each in the middle and at the gear
    assert np.abs(first) == pytest.approx([6.1575, 11.1690], abs=6e-5)
    assert np.abs(second) == pytest.approx([17.4184, 5.0591], abs=6e-5)
    assert np.prod(first) > 0 > np.prod(second)
    assert abs(lines.system.inertias[2, 1]) == pytest.approx(2.1184, abs=6e-5)
    # As printed, without the sign and decimal points that were lost.
    found = modes.component_modes
    assert found is not None and found.circular == pytest.approx(np.sqrt(lines.system.squares))
    # The rows of (2.7) are modes, its columns the middle of the first shaft and its gear; the last is the second gear.
    assert [found.middle[1, 0], found.shape[1, 0]] == pytest.approx([-17.42, 5.06], abs=6e-3)
    assert [found.middle[0, 0], found.shape[0, 0]] == pytest.approx([6.16, 11.17], abs=6e-3)
    assert found.shape[2].tolist() == pytest.approx([0, 2.12], abs=6e-3)
    # A shaft clamped at one end with an inertia J at the other: beta tan beta = J_s/J, its middle turns as sin(beta/2).
    stiffness, inertia = train.shafts[0].stiffness, train.shafts[0].inertia
    beta = found.circular[:2] * math.sqrt(inertia / stiffness)
    assert beta * np.tan(beta) == pytest.approx([inertia / 0.0058] * 2, rel=1e-8)
    assert found.middle[:2, 0] / found.shape[:2, 0] == pytest.approx(np.sin(beta / 2) / np.sin(beta), rel=1e-7)
    assert natural_modes(one_stage("massless")).component_modes is None
    assert np.abs([*second, *first, lines.system.inertias[2, 1]]) == pytest.approx([17.42, 5.06, 6.16, 11.17, 2.12], abs=6e-3)


def test_short_shafts() -> None:
    modes = natural_modes(one_stage("exact", SHORT), count=2)
    assert modes.circular == pytest.approx([1693.9, 19610.1], abs=0.06)
    assert modes.circular == pytest.approx([1694, 19610], rel=1e-4)


SOFT = (
    (0.0007, -0.0007, -0.7071, 0.7071),
    (0.7042, -0.7100, 0.0007, -0.0007),
    (0.0007, 0.0007, 0.7071, 0.7071),
    (0.7100, 0.7042, -0.0007, -0.0007),
)
"""Shapes of norm 1 of table 2, its misprints corrected: what it gives as 0.007 holds for ten times the stiffness."""
STIFF = (
    (0.4937, -0.4998, -0.5022, 0.5042),
    (0.6822, -0.1977, 0.1857, -0.6790),
    (-0.5039, -0.4977, -0.5002, -0.4982),
    (0.1922, 0.6808, -0.6805, -0.1912),
)
"""Those of table 3; gears 3 and 4 turn as (3.5) has it."""


@pytest.mark.parametrize(
    ("between", "computed", "printed", "shapes"),
    [
        (100.0, (107.0, 1057.2, 16542.2, 16575.9), (107, 1057, 16542, 16576), SOFT),
        (1e7, (747.46, 9971.01, 16559.10, 24975.53), (747, 9971, 16559, 24976), STIFF),
    ],
)
def test_two_stages(between: float, computed: tuple[float], printed: tuple[float], shapes: tuple[tuple[float]]) -> None:
    modes = natural_modes(two_stages(between))
    assert modes.circular == pytest.approx(computed, abs=0.06)
    assert modes.circular == pytest.approx(printed, abs=0.5)
    for unit, expected in zip(modes.unit_shape, shapes, strict=True):
        assert unit * math.copysign(1, unit[2] * expected[2]) == pytest.approx(expected, abs=1e-4)
    isolated = natural_modes(two_stages(between, "isolated"))
    assert isolated.circular == pytest.approx([0, 0, 16542, 16542], abs=0.5)
    assert isolated.rigid == 2


# ---------------------------------------------------------------------- cases in closed form


def _star(branches: int) -> Train:
    """A hub with equal shafts, each to an equal disc."""
    discs = [f"disc {place}" for place in range(branches)]
    return Train(
        model="exact",
        inertias=[Inertia(name="hub", inertia=0.2), *(Inertia(name=disc, inertia=0.01) for disc in discs)],
        shafts=[Shaft(name=f"to {disc}", start="hub", end=disc, length=400.0, diameter=40.0) for disc in discs],
    )


def test_modes_of_one_frequency_are_all_found() -> None:
    """Of three equal branches, two modes leave the hub at rest: a shaft clamped at one end, beta tan beta = J_s/J."""
    modes = natural_modes(_star(3), count=6)
    polar = math.pi / 32 * 0.04**4
    beta = brentq(lambda b: b * math.tan(b) - 7850 * polar * 0.4 / 0.01, 1e-3, 1.5, xtol=1e-15)
    omega = beta / 0.4 * math.sqrt(80.77e9 / 7850)
    assert modes.rigid == 1
    assert modes.circular[1:3] == pytest.approx([omega, omega], rel=1e-12)
    assert np.abs(modes.shape[1:3, 0]) == pytest.approx([0, 0], abs=1e-9)
    gram = (modes.shape * [0.2, 0.01, 0.01, 0.01]) @ modes.shape.T
    assert gram[1, 2] == pytest.approx(0, abs=1e-12)
    elements = natural_modes(replace(_star(3), model="elements"), count=6)
    assert elements.circular == pytest.approx(modes.circular, rel=1e-9)


def test_modes_with_every_inertia_at_rest_are_found() -> None:
    """A disc between two equal shafts to ground stays at rest in the modes of half waves on both: beta = pi, 2 pi, ..."""
    shafts = tuple(Shaft(name=name, start=GROUND, end="disc", length=500.0, diameter=30.0) for name in "ab")
    train = Train(model="exact", inertias=(Inertia(name="disc", inertia=0.05),), shafts=shafts)
    modes = natural_modes(train, count=5)
    half_wave = math.pi / 0.5 * math.sqrt(80.77e9 / 7850)
    assert modes.circular[[1, 3]] == pytest.approx([half_wave, 2 * half_wave], rel=1e-12)
    assert np.abs(modes.shape[[1, 3], 0]) == pytest.approx([0, 0], abs=1e-6)
    assert modes.kinetic_shafts[[1, 3]] == pytest.approx(np.full((2, 2), 0.5), abs=1e-9)
    # One shaft moves as a sine of modal mass 1/2, the other against it.
    amplitude = math.sqrt(2 / (2 * 7850 * math.pi / 32 * 0.03**4 * 0.5))
    assert np.abs(modes.shaft_shape[1, :, 10]) == pytest.approx([amplitude, amplitude], rel=1e-9)
    assert np.abs(modes.shaft_shape[3][:, [5, 15]]) == pytest.approx(np.full((2, 2), amplitude), rel=1e-9)
    assert count_below(train, modes.frequency[1] * (1 - 1e-9)) == 1
    assert count_below(train, modes.frequency[1] * (1 + 1e-9)) == 2


# ---------------------------------------------------------------------- what the response is made of


def test_system_of_one_stage() -> None:
    """In the order of the reference program: c_p of a pair's damping ratio 0.2, the preload along the mesh."""
    result = system(one_stage("modes"))
    assert result.load == pytest.approx(result.mesh[:, 0] * 2256 / 0.0507, rel=1e-14)
    assert result.damping == pytest.approx(2 * 0.05 * np.sqrt(result.squares), rel=1e-12)
    assert np.abs(result.mesh[:, 0]) == pytest.approx([0.0507 * 11.16902, 0.0507 * 5.05910, 0.1353 * 2.118425], rel=1e-6)
    isolated = one_stage("isolated")
    ratio = replace(isolated.meshes[0], damping=None, damping_ratio=0.2)
    damping = system(replace(isolated, meshes=(ratio,))).mesh_damping[0]
    assert damping == pytest.approx(2 * 0.2 * 7.05e8 / 19245.076, rel=1e-7)
    assert damping == pytest.approx(14660, rel=1e-3)
    assert static_forces(isolated) == pytest.approx([2256 / 0.0507], rel=1e-12)


@pytest.mark.parametrize("model", ["massless", "elements", "exact"])
def test_static_twist_and_mesh_forces(model: str) -> None:
    """Flanks press whichever way the torques turn; an intermediate shaft carries the torque of its stage."""
    for sign in (1.0, -1.0):
        train = replace(two_stages(1e7, model), torques={"1": sign * 2256.0, "4": -sign * 2256.0})
        one = system(train)
        z = np.linalg.solve(one.stiffness_matrix(), one.load)
        forces = one.stiffness * (one.mesh.T @ z)
        assert forces == pytest.approx(static_forces(train), rel=1e-9)
        # Both ends are held softly: nearly all of the torque goes through; the torque on gear 3 turns it as gear 2 is turned.
        carried = one.shaft_torques.T @ z
        assert abs(carried[1]) == pytest.approx(forces[0] * 0.0902, rel=1e-9)
        assert forces[0] == pytest.approx(forces[1], rel=1e-9)
        assert math.copysign(1, carried[1]) == sign


def test_free_train_of_two_reductions() -> None:
    """Torque times ratio, stage by stage; what rounding leaves of the balance is taken out."""
    ratios = (60.0 / 20.0, 45.0 / 15.0)
    train = Train(
        model="elements",
        inertias=[Inertia(name=n, inertia=j) for n, j in (("motor", 0.01), ("a", 1e-3), ("b", 0.05), ("c", 2e-3), ("d", 0.1))],
        shafts=[
            Shaft(name="input", start="motor", end="a", torsional_stiffness=2e3),
            Shaft(name="middle", start="b", end="c", length=120.0, diameter=30.0, inner_diameter=10.0),
        ],
        meshes=[
            ToothMesh(name="first", pinion="a", wheel="b", base_radii=(20, 60), stiffness=300.0, teeth=20),
            ToothMesh(name="second", pinion="c", wheel="d", base_radii=(15, 45), stiffness=400.0, teeth=15),
        ],
        torques={"motor": 10.0, "d": -10.0 * math.prod(ratios) * (1 + 1e-5)},
        speed=1500.0,
    )
    assert train.speed_ratios == pytest.approx({"motor": 1, "a": 1, "b": -1 / 3, "c": -1 / 3, "d": 1 / 9})
    assert train.tooth_frequencies == pytest.approx({"first": 500.0, "second": 125.0})
    assert static_forces(train) == pytest.approx([10 / 0.02, 30 / 0.015], rel=1e-4)
    modes = natural_modes(train)
    assert modes.rigid == 1 and modes.shape[0] == pytest.approx(modes.shape[0, 0] * np.array([1, 1, -1 / 3, -1 / 3, 1 / 9]))
    assert modes.approach[0] == pytest.approx([0, 0], abs=1e-12 * np.abs(modes.approach).max())
    assert modes.rpm[1] == pytest.approx(modes.frequency[1] * 60 / np.array([20, 15 / 3]))
    lines = lines_of(train)
    assert lines.system.stiffness_matrix() @ lines.free == pytest.approx(np.zeros((lines.system.size, 1)), abs=1e-4)
    assert lines.free.T @ lines.system.load == pytest.approx([0], abs=1e-12 * np.abs(lines.system.load).max())


PRINTED = 4e-4
"""What is left of frequencies printed with one decimal."""

LETTERS = {"R": ModeKind.ROTATIONAL, "T": ModeKind.TRANSLATIONAL, "P": ModeKind.PLANET}

PUBLISHED = {
    3: {
        "R": (0, 1475.7, 1930.3, 2658.3, 7462.8, 11775.3),
        "T": (743.2, 1102.4, 1896.0, 2276.4, 6986.3, 9647.9),
        "P": (),
    },
    4: {
        "R": (0, 1536.6, 1970.6, 2625.7, 7773.6, 13071.1),
        "T": (727.0, 1091.0, 1892.8, 2342.5, 7189.9, 10437.6),
        "P": (1808.2, 5963.8, 6981.7),
    },
}
"""J. Lin and R. G. Parker, J. Vib. Acoust. 121 (1999) 316-321, as remembered: three planets and four."""

SOURCE = "Lin and Parker, J. Vib. Acoust. 121 (1999) 316-321, as remembered"


@pytest.mark.parametrize("planets", PUBLISHED)
def test_published_frequencies(planets: int, published: Published) -> None:
    springs = lin_parker_train(
        planets,
        meshes=(5e8, 5e8),
        angles=(24.6, 24.6),
        supports={"c": 1e8, "r": 1e8, "s": 1e8},
        torsion={"c": 0.0, "r": 1e9, "s": 0.0},
        pin=1e8,
    )
    modes = planetary_modes(springs, masses_of((0.66, 0.61), c=(5.43, 6.29), r=(2.35, 3.0), s=(0.4, 0.39)))
    for letter, frequencies in PUBLISHED[planets].items():
        own = [family.frequency for family in modes.families if family.kind is LETTERS[letter]]
        for number, (found, printed) in enumerate(zip(own, frequencies, strict=True), start=1):
            within = PRINTED * printed + 1e-6 * (printed == 0)
            published(f"{letter}{number}, Hz", found, f"{printed:.1f}", within, SOURCE, f"{planets} planets")
    assert [family.multiplicity for family in modes.families if family.kind is ModeKind.TRANSLATIONAL] == [2] * 6


OWN = {int(planets): (kinds, [*map(float, frequencies)]) for planets, kinds, *frequencies in data_rows("planetary_modes")}
"""Hz, by matrices written down one by one and scipy's eigh."""


@pytest.mark.parametrize("planets", OWN)
def test_frequencies_and_kinds_of_other_matrices(planets: int) -> None:
    springs = lin_parker_train(
        planets,
        meshes=(3e8, 4.2e8),
        angles=(25.0, 21.0),
        supports={"c": 8e7, "r": 1.5e8, "s": 3e7},
        torsion={"c": 5e7, "r": 9e8, "s": 0.0},
        pin=1.2e8,
    )
    modes = planetary_modes(springs, masses_of((0.7, 0.6), c=(3.2, 3.9), r=(2.1, 2.6), s=(0.5, 0.45)))
    kinds, frequencies = OWN[planets]
    assert modes.frequency == pytest.approx(frequencies, rel=1e-8)
    assert list(modes.kinds) == [LETTERS[letter] for letter in kinds]
    assert _count(modes, ModeKind.PLANET) == [planets - 3] * (3 if planets > 3 else 0)
    assert modes.notices == ()


def _count(modes: PlanetaryModes, kind: ModeKind) -> list[int]:
    return [family.multiplicity for family in modes.families if family.kind is kind]


def test_the_reference_is_not_that_of_equal_angles_whatever_these_are() -> None:
    """Where the first planet stands is no matter; where the second stands is."""
    given = {
        "meshes": (3e8, 4.2e8),
        "angles": (25.0, 21.0),
        "supports": {"c": 8e7, "r": 1.5e8, "s": 3e7},
        "torsion": {"c": 5e7, "r": 9e8, "s": 0.0},
        "pin": 1.2e8,
    }
    masses = masses_of((0.7, 0.6), c=(3.2, 3.9), r=(2.1, 2.6), s=(0.5, 0.45))
    turned = planetary_modes(lin_parker_train(3, **given, turned=0.3), masses)
    assert turned.frequency == pytest.approx(OWN[3][1], rel=1e-8)
    apart = planetary_modes(lin_parker_train(3, **given, moved=np.radians(8)), masses)
    assert np.abs(apart.frequency / OWN[3][1] - 1).max() > 1e-3
    assert apart.notices[0].text.endswith("the planets are not at equal angles")
