"""Ratings as standards and public programs print them, through a spec text, its reader, the job and its document."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from support.cases import half_unit
from support.published import Published
from support.ratings import rating_case
from support.specs import figures, rate_document

from gearcad.material import MaterialGroup
from gearcad.rating.factors import flank_points
from gearcad.rating.strength.duty import damage_sum, permissible_cycles, safety_at_failure

_PRINTED = json.loads((Path(__file__).parents[1] / "data" / "rating_printed.json").read_text(encoding="utf-8"))
_CASES = {entry["id"]: entry for entry in _PRINTED["cases"]}


@pytest.mark.parametrize("name", _CASES)
def test_printed_figures(name: str, tmp_path: Path, published: Published) -> None:
    case = _CASES[name]
    document = rate_document(case["spec"], tmp_path)
    document |= {"S_H": document["safety"]["flank"], "S_F": document["safety"]["root"]}
    allowed = case.get("tolerance", {})
    for symbol, printed in case["printed"].items():
        found = figures(document, symbol)
        texts = printed if isinstance(printed, list) else [printed] * len(found)
        assert found
        for role, value, text in zip(("",) if len(found) == 1 else (" pinion", " wheel"), found, texts, strict=True):
            if text is not None:
                within = allowed.get(symbol, half_unit(text)) * (1 + 1e-9)
                published(f"{symbol}{role}", value, text, within, case["source"], name)


# ---------------------------------------------------------------------- plain formulas of our own


FORMULA = 1e-10
"""Relative: the same formulas evaluated twice."""

OF_BOTH = {"q_prime": "q_prime", "c_th": "c_th", "c_prime": "c_prime", "c_gamma_alpha": "c_gamma_alpha", "Z_H": "Z_H"}
OF_BOTH |= {"Z_E": "Z_E", "Z_eps": "Z_eps", "Z_B": "Z_B", "Z_D": "Z_D", "sigma_H0_MPa_Zbeta_2008": "sigma_H0"}
OF_EACH = {"Y_F": "Y_F", "Y_S": "Y_S", "Y_beta": "Y_beta", "sigma_F0_MPa": "sigma_F0"}


@pytest.mark.parametrize(
    "name", ["helical_unequal_widths_19_47", "helical_z12_51_beta22", "volvo_13_44_rating", "alm_18_161_rating"]
)
def test_nominal_values_by_way_of_a_spec(name: str, tmp_path: Path) -> None:
    given, expected = rating_case(name)["inputs"], rating_case(name)["expected"]
    common = {"normal_module": given["m_n_mm"], "helix_angle": given["beta_deg"]}
    distance = {"centre_distance": given["a_mm"]} if isinstance(given["a_mm"], float | int) else {}
    gears = {
        role: {"teeth": given["z"][place], "profile_shift": given["x"][place], "face_width": given["b_mm"][place]}
        for place, role in enumerate(("pinion", "wheel"))
    }
    steel = {"youngs_modulus": given["E_MPa"]}
    document = rate_document(
        {"pair": common | distance, **gears, "material": steel, "load": {"torque": given["T1_Nm"]}}, tmp_path
    )["nominal"]
    assert [document[ours] for ours in OF_BOTH.values()] == pytest.approx([expected[key] for key in OF_BOTH], rel=FORMULA)
    for role in gears:
        found, values = document[role], expected[role]
        assert [found[ours] for ours in OF_EACH.values()] == pytest.approx([values[key] for key in OF_EACH], rel=FORMULA)


# ---------------------------------------------------------------------- load spectra

PRINTED_DIGITS = 0.018
"""Relative, of load cycles: those of two or three digits, by stresses of four and torques of three."""


def test_annex_c_of_iso_6336_6(published: Published) -> None:
    # Its S-N line has the influence factors of endurance throughout, and goes on above 1.6 sigma_Hlim: bins 3 to 7 lie there.
    given = _PRINTED["spectrum"]
    cycles, stresses, permissible, damages = np.array(given["bins"]).T
    borne = given["limit"] * given["Z_L"] * given["Z_v"] * given["Z_R"]
    curve = [(reached, factor * borne) for reached, factor in flank_points(MaterialGroup.CASE_HARDENED)]
    found = permissible_cycles(stresses, curve)
    assert (stresses > 1.6 * borne).sum() == 5
    assert found == pytest.approx(permissible, rel=PRINTED_DIGITS)
    assert cycles / found == pytest.approx(damages, rel=PRINTED_DIGITS)
    published("damage sum of 42 bins", damage_sum(cycles, stresses, curve), f"{damages.sum():.4f}", 0.0015, given["source"])
    # With its S-N line, the static strength is not reached before 1e4 cycles.
    (_, static), *rest = curve
    slope = np.log(1.6) / np.log(500)
    longer = [(1e4, static * 10**slope), *rest]
    assert damages.sum() == pytest.approx(1, abs=0.001)
    published("safety at a damage of 1", safety_at_failure(cycles, stresses, longer), "1", 2e-4, given["source"])
