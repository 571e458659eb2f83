"""LoadFactors of a pair: against another implementation, in their order, by options, and at their limits."""

import math
import re
from dataclasses import replace
from typing import Any

import pytest

from gearcad import Body, Gear, GearPair, Load, Material
from gearcad.core.errors import GearcadError
from gearcad.core.records import PerGear
from gearcad.core.symbols import LOAD_FACTOR_DETAILS
from gearcad.geometry import FlankModification
from gearcad.rating import DynamicFactor, RatingOptions
from gearcad.rating.load_factor_formulas import face_load_factor
from gearcad.rating.load_factors import FaceLoad, LoadFactors

EXACT = 1e-9
"""Relative: the same equations by another program, whose pressure angles are from a bisection."""

EH = Material(group="Eh", contact_endurance_limit=1500.0)  # type: ignore[arg-type]
V = Material(group="V", contact_endurance_limit=700.0)  # type: ignore[arg-type]
GG = Material(group="GG", contact_endurance_limit=350.0)  # type: ignore[arg-type]


def pair_of(teeth: tuple[int, int], module: float, width: float, helix: float = 0.0, **gears: Any) -> GearPair:
    pinion, wheel = (
        Gear(teeth=z, normal_module=module, face_width=width, helix_angle=beta, profile_shift=x, **gears)
        for z, beta, x in zip(teeth, (helix, -helix), (0.3, 0.1) if module == 4 else (0.0, 0.0), strict=True)
    )
    return GearPair(pinion=pinion, wheel=wheel)


HELICAL = pair_of((25, 40), 2.0, 26.0, 20.0)
LOAD = Load(torque=150.0, speed=3000.0, application_factor=1.25)


def factors(options: RatingOptions | None = None, load: Load = LOAD, **given: Any) -> LoadFactors:
    return LoadFactors.of(HELICAL, EH, load, options or RatingOptions(**given))


def tilted(torque: float, stiffness: float, misalignment: float) -> FaceLoad:
    """Flanks that stand off by f_sh = 3 µm at 100 N·m and f_ma, in a straight line."""
    deflection, mean = 0.03 * torque, 2000 * torque / HELICAL.pinion.reference_diameter / HELICAL.common_width.width
    factor = float(face_load_factor(abs(deflection + misalignment), stiffness, mean))
    return FaceLoad(factor=factor, factor_at_end=factor, deflection=deflection, misalignment=misalignment)


def test_on_shafts_the_worse_side_counts_under_all_factors_before() -> None:
    """F_m = F_t K_A K_gamma K_v goes to the function of the shafts; f_ma by the grade as Method C has it, to both sides."""
    loads: list[tuple[float, float, float]] = []

    def heard(torque: float, stiffness: float, misalignment: float) -> FaceLoad:
        loads.append((torque, stiffness, misalignment))
        return tilted(torque, stiffness, misalignment)

    options = RatingOptions(face_load_factor="shafts", mesh_load_factor=1.2)
    found, by_c = LoadFactors.of(HELICAL, EH, LOAD, options, heard), factors(mesh_load_factor=1.2)
    assert [each[2] for each in loads] == pytest.approx([by_c.details["f_ma"], -float(by_c.details["f_ma"])])  # type: ignore[arg-type]
    for torque, stiffness, _ in loads:
        assert torque == pytest.approx(150 * 1.25 * 1.2 * found.dynamic)
        assert stiffness == by_c.details["c_gamma_beta"]
    assert found.face_flank == max(tilted(*each).factor for each in loads) == tilted(*loads[0]).factor
    assert found.face_root == pytest.approx(found.face_flank ** float(found.details["N_F"]))  # type: ignore[arg-type]
    assert found.details["K_Hbeta_C"] == by_c.face_flank and found.details["f_sh_C"] == by_c.details["f_sh"]
    (said,) = (each for each in found.assumed if "beside" in each)
    steps = [float(each) for each in re.findall(r"([+-][\d.]+)[, ]?", said.partition("makes")[2])]
    assert by_c.face_flank + sum(steps) == pytest.approx(found.face_flank, abs=2e-3)
    assert steps[2] == pytest.approx(0.0, abs=1e-9)  # a straight gap has no shape
    assert "K_Hbeta" in found.verify and "annex E" in found.sources["K_Hbeta"]


def test_one_side_and_given_stiffness_on_shafts() -> None:
    given = {"face_load_factor": "shafts", "face_mesh_stiffness": 11.0, "misalignment_sides": "one"}
    found = {}
    for misalignment in (-9.0, 9.0):
        options = RatingOptions(**given, manufacturing_misalignment=misalignment)  # type: ignore[arg-type]
        found[misalignment] = LoadFactors.of(HELICAL, EH, LOAD, options, tilted)
        assert found[misalignment].details["f_ma"] == misalignment
        assert found[misalignment].details["c_gamma_beta"] == 11.0
    assert found[9.0].face_flank > found[-9.0].face_flank
    worse = RatingOptions(**{**given, "misalignment_sides": "worse"}, manufacturing_misalignment=9.0)  # type: ignore[arg-type]
    assert LoadFactors.of(HELICAL, EH, LOAD, worse, tilted).face_flank == found[9.0].face_flank
    with pytest.raises(GearcadError, match=r"manufacturing_misalignment = -9 µm: must be a number at least 0 µm"):
        RatingOptions(manufacturing_misalignment=-9.0)
    c = factors(face_mesh_stiffness=11.0).details
    assert c["c_gamma_beta"] == 11.0


@pytest.mark.parametrize(
    ("pair", "materials", "load", "options", "expected"),
    [
        (
            HELICAL,
            PerGear(EH, EH),
            LOAD,
            RatingOptions(),
            (1.0353925284786107, 1.3198351497061298, 1.2594470356189498, 1.0417471436060404, 1.0417471436060404),
        ),
        (
            pair_of((20, 55), 4.0, 40.0),
            PerGear(EH, V),
            Load(torque=400.0, speed=1200.0, application_factor=1.5),
            RatingOptions(accuracy_grade=8, bearing_span=150.0, pinion_offset=20.0, shaft_diameter=60.0),
            (1.0544382545320719, 1.4662240324776439, 1.3498618876317063, 1.0, 1.0),
        ),
        (
            pair_of((31, 33), 3.0, 30.0, 12.0, body=Body(bore=30.0)),
            PerGear(GG, GG),
            Load(torque=40.0, speed=5000.0),
            RatingOptions(accuracy_grade=7),
            (2.027028283762845, 1.790186448881551, 1.5785356594075433, 1.3964048243413894, 1.3964048243413894),
        ),
    ],
    ids=["helical, hardened", "spur, two materials, off the middle", "light, cast iron, bored"],
)
def test_as_another_implementation(
    pair: GearPair, materials: PerGear[Material], load: Load, options: RatingOptions, expected: tuple[float, ...]
) -> None:
    """K_v, K_Hbeta, K_Fbeta, K_Halpha, K_Falpha of a program of its own, which reproduces printed reports."""
    found = LoadFactors.of(pair, materials, load, options).to_dict()
    assert list(found.values())[2:] == pytest.approx(expected, rel=EXACT)
    assert list(found) == ["K_A", "K_gamma", "K_v", "K_Hbeta", "K_Fbeta", "K_Halpha", "K_Falpha"]


def test_bands_of_a_printed_report() -> None:
    """Helical 25/40 at 5638 N: K_v 1.05, K_Halpha 1.18 in the report, whose grade is not printed; K_v is that of 6 and 7."""
    load = Load(torque=5638 * HELICAL.pinion.reference_diameter / 2000, speed=3000.0)
    by_grade = [factors(load=load, accuracy_grade=grade) for grade in (6, 7, 8, 9)]
    assert [each.dynamic for each in by_grade[:2]] == pytest.approx([1.05, 1.05], abs=0.02)
    assert by_grade[2].transverse_flank < 1.18 < by_grade[3].transverse_flank + 0.04
    assert by_grade[0].details["N"] == pytest.approx(0.163, abs=0.01)


def test_each_is_of_the_load_times_all_before_it() -> None:
    """F_t K_A K_gamma K_v/b for K_Hbeta, that times K_Hbeta for K_Halpha; K_gamma counts as more K_A does."""
    found = factors(mesh_load_factor=1.2)
    b, d = HELICAL.common_width.width, HELICAL.pinion.reference_diameter
    mean = 2000 * 150 / d * 1.25 * 1.2 * found.dynamic / b
    assert found.details["F_m_b"] == pytest.approx(mean, rel=EXACT)
    assert found.details["F_tH_b"] == pytest.approx(mean * found.face_flank, rel=EXACT)
    more = factors(load=replace(LOAD, application_factor=1.5))
    assert list(found.to_dict().values())[2:] == pytest.approx(list(more.to_dict().values())[2:], rel=EXACT)
    assert (found.mesh_load, found.application, more.application) == (1.2, 1.25, 1.5)


def test_every_figure_has_its_words() -> None:
    named = {symbol for method in ("B", "C") for symbol in factors(dynamic_factor=method).details}
    named |= set(LoadFactors.of(HELICAL, EH, LOAD, RatingOptions(face_load_factor="shafts"), tilted).details)
    assert named == set(LOAD_FACTOR_DETAILS)


def test_clauses_are_those_that_are_known() -> None:
    """Of 2006, for that of 2019 too; DIN 3990 has no numbers of clauses here. What is from memory is marked."""
    assert factors(standard="ISO 6336:2019").sources["K_v"] == "ISO 6336-1:2006, 6.5 (Method B)"
    din = factors(standard="DIN 3990:1987", helix_modification="end relief")
    assert din.sources["K_Hbeta"] == "DIN 3990-1:1987 (Method C)"
    assert din.verify == ("K_Hbeta", "K_Fbeta")
    assert factors().verify == ()


def test_numbers_win() -> None:
    found = factors(dynamic_factor=1.3, face_load_factor=1.4, transverse_load_factor=1.1)
    assert (found.dynamic, found.face_flank, found.transverse_flank, found.transverse_root) == (1.3, 1.4, 1.1, 1.1)
    assert found.face_root == pytest.approx(1.4 ** found.details["N_F"])  # type: ignore[operator]
    assert {found.sources[symbol] for symbol in ("K_v", "K_Hbeta", "K_Halpha")} == {"given"}
    assert found.assumed == ()


def test_given_deviations_win() -> None:
    """f_pb, f_falpha, f_Hbeta, f_ma and f_sh as given, of the worse gear."""
    found = factors(
        base_pitch_deviation=[9.0, 11.0], profile_form_deviation=7.0, helix_slope_deviation=[14.0, 15.0], shaft_deflection=2.0
    ).details
    assert (found["f_pb"], found["f_falpha"], found["f_sh"]) == (11.0, 7.0, 2.0)
    assert found["f_ma"] == pytest.approx(20.518, abs=5e-4)
    assert found["F_betax"] == pytest.approx(2.66 + 20.518, abs=5e-4)
    assert factors(manufacturing_misalignment=3.0, shaft_deflection=0.0).details["F_betax"] == 4.25  # half of f_Hbeta
    assert factors(manufacturing_misalignment=5.0, shaft_deflection=0.0).details["F_betax"] == 5.0


def test_a_gear_may_have_a_grade_of_its_own() -> None:
    coarse = replace(HELICAL, wheel=replace(HELICAL.wheel, accuracy_grade=8))
    found, whole = LoadFactors.of(coarse, EH, LOAD), factors(accuracy_grade=8)
    assert (found.dynamic, found.details["f_pb"]) == (whole.dynamic, whole.details["f_pb"])
    assert factors().face_flank < found.face_flank < whole.face_flank


def test_at_rest_speed_is_not_known() -> None:
    found = factors(load=replace(LOAD, speed=0.0))
    assert found.unknown == ("K_v",)
    assert found.to_dict()["K_v"] is None
    assert found.notices[0].code == "no-speed"
    assert (found.dynamic, found.face_flank) == (1.0, pytest.approx(factors(dynamic_factor=1.0).face_flank, rel=1e-12))
    assert factors(load=replace(LOAD, speed=0.0), dynamic_factor=1.2).unknown == ()


def test_a_proven_contact_pattern_halves_nothing_by_itself() -> None:
    """|1.33 f_sh - f_Hbeta5| is 4 µm less here than f_Hbeta5 of the gears, 6 µm, but no less than half of f_Hbeta."""
    found = factors(contact_pattern="proven", shaft_deflection=1.0, accuracy_grade=5).details
    assert found["F_betax"] == pytest.approx(6.0 - 1.33, rel=EXACT)
    assert factors(contact_pattern="proven", shaft_deflection=4.5).details["F_betax"] == 4.25


@pytest.mark.parametrize("given", [0.0, 14.0, 25.0])
def test_din_takes_the_given_misalignment_off_a_proven_contact_pattern(given: float) -> None:
    """DIN 3990-11, 3.09: F_betax = |1.33 f_sh - f_ma|; without a given f_ma, and by ISO 6336-1 (53), f_Hbeta5 is taken off."""
    proven: dict[str, Any] = {"contact_pattern": "proven", "shaft_deflection": 12.0}
    own = factors(standard="DIN 3990:1987", manufacturing_misalignment=given, **proven)
    found, load = own.details, own.details["F_m_b"]
    assert found["F_betax"] == pytest.approx(max(abs(1.33 * 12.0 - given), found["F_betax_min"]), rel=EXACT)
    effective = found["F_betax"] - found["y_beta"]
    assert own.face_flank == pytest.approx(1 + effective * found["c_gamma_beta"] / (2 * load), rel=EXACT)
    by_iso = factors(manufacturing_misalignment=given, **proven)
    assert by_iso.details["F_betax"] == factors(**proven).details["F_betax"]


def test_helix_modifications() -> None:
    """Crowning halves f_ma but leaves K_Fbeta as K_Hbeta; flanks that are crowned are told of where the options are not."""
    plain, crowned = factors(), factors(helix_modification="crowning")
    assert crowned.face_flank < plain.face_flank
    assert crowned.face_root == crowned.face_flank
    assert crowned.verify == ("K_Fbeta",)
    wheel = replace(HELICAL.wheel, modification=FlankModification(lead_crowning=5.0))
    notices = LoadFactors.of(replace(HELICAL, wheel=wheel), EH, LOAD).notices
    assert [(each.code, each.where) for each in notices] == [("helix-modification-unsaid", "wheel")]


def test_the_deviation_that_runs_in() -> None:
    """Where f_falpha is larger, y_alpha is of it, or of f_pb: 0.075 (20 - 8) µm less wears off."""
    rules = [
        factors(base_pitch_deviation=8.0, profile_form_deviation=20.0, alpha_deviation_rule=rule)
        for rule in ("literal", "KISSsoft 2017")
    ]
    assert [each.details["y_alpha"] for each in rules] == pytest.approx([1.5, 0.6], rel=EXACT)
    assert rules[0].transverse_flank < rules[1].transverse_flank


def test_limits_of_light_and_coarse_gears() -> None:
    """Hardly loaded gears of grade 12: all of the load on the end of the face width or, if it is even, on one pair of teeth."""
    light = replace(LOAD, torque=0.5)
    found, even = factors(load=light, accuracy_grade=12), factors(load=light, accuracy_grade=12, face_load_factor=1.0)
    assert found.face_flank > 2
    assert "narrow-bearing" in {each.code for each in found.notices}
    assert (even.transverse_flank, even.transverse_root) == (even.details["K_Halpha_max"], even.details["K_Falpha_max"])
    assert found.transverse_flank < even.transverse_flank


def test_soft_slow_flanks_wear_until_they_fit() -> None:
    """320/sigma_Hlim is above 1: nothing is left of F_beta_x."""
    soft = Material(group="St", contact_endurance_limit=250.0)  # type: ignore[arg-type]
    found = LoadFactors.of(HELICAL, soft, Load(torque=20.0, speed=300.0))
    assert (found.details["F_betay"], found.face_flank, found.face_root) == (0.0, 1.0, 1.0)
    assert all(math.isfinite(value) for value in found.details.values() if isinstance(value, float))


def test_rings() -> None:
    """A ring whose rim is not given is held; with one it turns, and the mesh resonates at a higher speed."""
    pinion, body = Gear(teeth=22, normal_module=2.0, face_width=20.0), Body(rim_diameter=170.0)
    held, turning = (
        LoadFactors.of(GearPair(pinion=pinion, wheel=Gear(teeth=-70, normal_module=2.0, face_width=20.0, body=each)), EH, LOAD)
        for each in (Body(), body)
    )
    assert any("the ring is held" in text for text in held.assumed)
    assert not any("held" in text for text in turning.assumed)
    assert held.details["n_E1"] < turning.details["n_E1"]  # type: ignore[operator]
    assert all(value is not None and value >= 1 for value in turning.to_dict().values())


def test_more_torque_never_asks_for_larger_factors() -> None:
    """Nor a finer grade, nor slower gears below resonance."""
    courses = [
        [factors(load=replace(LOAD, torque=torque)) for torque in (2.0, 20.0, 80.0, 300.0, 2000.0)],
        [factors(accuracy_grade=grade) for grade in range(12, 5, -1)],
        [factors(load=replace(LOAD, speed=speed)) for speed in (12000.0, 6000.0, 600.0, 60.0)],
    ]
    for course in courses:
        values = [list(each.to_dict().values()) for each in course]
        for milder, worse in zip(values[1:], values, strict=False):
            assert milder[2] <= worse[2]  # type: ignore[operator]
    for milder, worse in zip(courses[0][1:], courses[0], strict=False):
        product = [each.dynamic * each.face_flank * each.transverse_flank for each in (milder, worse)]
        assert product[0] <= product[1]


def test_method_b_is_that_of_the_charts() -> None:
    """With the inertias of the same bodies `DynamicFactor.of` has the same K_v."""
    found = factors()
    mass = float(found.details["m_red"])  # type: ignore[arg-type]
    radius, width = HELICAL.pinion.base_diameter / 2000, HELICAL.common_width.width
    whole = DynamicFactor.of(HELICAL, EH, LOAD, PerGear(mass * width * radius**2, math.inf))
    assert float(whole.values(LOAD.speed)) == pytest.approx(found.dynamic, rel=EXACT)


def test_face_factor_by_its_own_misalignment() -> None:
    found = factors(accuracy_grade=9).details
    off, stiffness, mean = (float(found[each]) for each in ("F_betay", "c_gamma_beta", "F_m_b"))  # type: ignore[arg-type]
    assert factors(accuracy_grade=9).face_flank == face_load_factor(off, stiffness, mean)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"face_load_factor": "fe"}, r"rating.face_load_factor = 'fe': must be \"C\" or a number here"),
        (
            {"face_load_factor": "shafts"},
            r"rating.face_load_factor = 'shafts': .* no gear has a shaft with its bearings",
        ),
        ({"pinion_offset": 10.0}, r"rating.bearing_span is missing: must be given with pinion_offset"),
        ({"pinion_offset": 10.0, "bearing_span": 90.0}, r"rating.shaft_diameter is missing"),
        ({"bearing_arrangement": "c"}, r"rating.pinion_offset = 0 mm: must not be 0 mm for bearing_arrangement \"c\""),
        ({"dynamic_factor": "C", "accuracy_grade": 2}, "accuracy_grade = 2"),
    ],
)
def test_what_is_lacking_is_said_in_one_line(given: dict[str, Any], message: str) -> None:
    with pytest.raises(GearcadError, match=message) as error:
        factors(**given)
    assert "\n" not in str(error.value)


def test_narrow_gears_have_no_helix_tolerance() -> None:
    """3 mm is narrower than ISO 1328-1 has gears: f_Hbeta given would do."""
    narrow = pair_of((25, 40), 2.0, 3.0)
    with pytest.raises(GearcadError, match=r"pinion.face_width = 3 mm: must be .* 4 mm"):
        LoadFactors.of(narrow, EH, LOAD)
    assert LoadFactors.of(narrow, EH, LOAD, RatingOptions(helix_slope_deviation=8.0)).face_flank > 1
    with pytest.raises(GearcadError, match="torque"):
        LoadFactors.of(narrow, EH, Load(torque=0.0))
