"""Natural frequencies of planetary trains: those of Lin and Parker's paper, and of matrices of our own that give these."""

from __future__ import annotations

import numpy as np
import pytest
from support.mode_trains import lin_parker_train, masses_of
from support.published import Published

from gearcad.dynamics.planetary.planetary_modes import ModeKind, PlanetaryModes, planetary_modes

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


OWN = {
    3: (
        "RTTTTRTTRTTRTTRTTR",
        "363.2260818754145 734.9741243731031 734.9741243731198 1136.6811736980162 1136.6811736980228 1737.652767212085 "
        "1740.264066806391 1740.2640668063946 2082.275701903859 2522.9563285068843 2522.9563285068875 "
        "2753.5220121058046 6324.357511703619 6324.35751170362 6964.288845142367 7149.817156072234 7149.817156072236 "
        "8713.882741189838",
    ),
    4: (
        "RTTTTRTTPRTTRPPTTRTTR",
        "341.9154716829598 695.1383626840493 695.1383626840495 1098.6308183130411 1098.6308183130454 1775.5320720551606 "
        "1796.009395691892 1796.0093956918927 1943.1667328337219 2133.3569295337134 2713.38284864732 2713.3828486473303 "
        "2791.350549874559 4941.718118112714 6077.711059004204 6583.735740775849 6583.735740775849 7297.592410771802 "
        "7602.734173871728 7602.7341738717305 9612.135409499233",
    ),
    5: (
        "RTTTTRTTPPRRTTPPPPTTRTTR",
        "323.8965398543423 660.7109332038785 660.7109332039041 1064.6438224188862 1064.6438224188953 1778.6139770960358 "
        "1834.491565465734 1834.4915654657373 1943.1667328337226 1943.1667328337237 2159.137941980994 "
        "2870.8076246804544 2893.419559735585 2893.419559735587 4941.718118112714 4941.718118112716 6077.711059004203 "
        "6077.711059004206 6806.107310853633 6806.107310853636 7604.020368245861 8054.6329990649365 8054.632999064937 "
        "10441.524378523534",
    ),
    6: (
        "RTTTTRTTPPPRRTTPPPPPPTTRTTR",
        "308.4370311193642 630.7902027736903 630.7902027737026 1033.9640256599478 1033.9640256599482 1766.3370905063878 "
        "1862.8694444823348 1862.8694444823363 1943.1667328337203 1943.1667328337226 1943.1667328337267 "
        "2165.903626980628 2974.178981844645 3063.15937923829 3063.1593792382923 4941.718118112711 4941.718118112713 "
        "4941.7181181127135 6077.711059004203 6077.711059004204 6077.711059004206 7008.856314730588 7008.856314730588 "
        "7891.955938314625 8493.83203972403 8493.832039724031 11213.451463743104",
    ),
}
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
    kinds, frequencies = OWN[planets][0], _numbers(planets)
    assert modes.frequency == pytest.approx(frequencies, rel=1e-8)
    assert list(modes.kinds) == [LETTERS[letter] for letter in kinds]
    assert _count(modes, ModeKind.PLANET) == [planets - 3] * (3 if planets > 3 else 0)
    assert modes.notices == ()


def _numbers(planets: int) -> list[float]:
    return [float(each) for each in OWN[planets][1].split()]


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
    assert turned.frequency == pytest.approx(_numbers(3), rel=1e-8)
    apart = planetary_modes(lin_parker_train(3, **given, moved=np.radians(8)), masses)
    assert np.abs(apart.frequency / _numbers(3) - 1).max() > 1e-3
    assert apart.notices[0].text.endswith("the planets are not at equal angles")
