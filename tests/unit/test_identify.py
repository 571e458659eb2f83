"""`identify`: the least of its sum of squares, what gauges read, what is refused, what is said."""

import numpy as np
import pytest
from scipy.optimize import least_squares

import gearcad
from gearcad import BasicRack, Gear, GeometryError, ParameterError, plots
from gearcad.cli.identify import identification_lines
from gearcad.geometry.inspection import chord_below_tip
from gearcad.identify import Gauge, Identification, Measured, Reading, identify_gear
from gearcad.identify.fit import fitted, read_off
from gearcad.identify.search import fits
from gearcad.identify.standards import SIZES, UNKNOWNS, Hypothesis, Unknown, ways

PINION = Gear(teeth=31, normal_module=2.5, face_width=20, helix_angle=17.0, profile_shift=0.21, tooth_thinning=0.06)
RING = Gear(
    teeth=-62, normal_module=2.0, face_width=20, profile_shift=-0.1, tooth_thinning=0.05, rack=BasicRack(root_radius=0.2)
)

EXACT = 1e-9
"""Of readings: rounding in diameters of some hundred mm."""

LEAST = 1e-4
"""Of a sum of squares of some units: our steps end a thousandth of a spread from the least."""


def _reading(gauge: Gauge, value: float, size: float = 0.0, uncertainty: float = 0.02) -> Reading:
    return Reading(gauge=gauge, value=value, uncertainty=uncertainty, size=size)


def _exact(gear: Gear) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    found = np.zeros(UNKNOWNS)
    found[Unknown.MODULE], found[Unknown.PRESSURE_ANGLE] = gear.normal_module, gear.rack.pressure_angle
    found[Unknown.HELIX_ANGLE], found[Unknown.SHIFT] = gear.helix_angle, gear.profile_shift
    found[Unknown.ADDENDUM], found[Unknown.DEDENDUM] = gear.rack.addendum + gear.tip_alteration, gear.rack.dedendum
    found[Unknown.THINNING] = np.log(gear.tooth_thinning)
    return found


def test_gauges_read_what_the_gear_has() -> None:
    places = [
        _reading(Gauge.TIP_DIAMETER, 1.0),
        _reading(Gauge.ROOT_DIAMETER, 1.0),
        _reading(Gauge.LEAD, 1.0),
        _reading(Gauge.SPAN, 1.0, 4),
        _reading(Gauge.OVER_PINS, 1.0, 4.5),
        _reading(Gauge.OVER_BALLS, 1.0, 4.5),
        _reading(Gauge.CHORDAL_THICKNESS, 1.0, PINION.inspection.chordal_thickness.height),
    ]
    over = PINION.inspection
    expected = (PINION.tip_diameter, PINION.root_diameter, PINION.lead, over.span_measurement(4))
    found = read_off(Measured(teeth=31, readings=tuple(places)), places, _exact(PINION))
    assert found == pytest.approx(
        (
            *expected,
            over.over_pins(4.5),
            over.over_balls(4.5),
            over.chordal_thickness.thickness,
        ),
        rel=EXACT,
    )
    places = [_reading(Gauge.TIP_DIAMETER, 1.0), _reading(Gauge.SPAN, 1.0, 8), _reading(Gauge.BETWEEN_PINS, 1.0, 3.4)]
    inside = RING.inspection
    found = read_off(Measured(teeth=-62, readings=tuple(places)), places, _exact(RING))
    assert found == pytest.approx((-RING.tip_diameter, inside.span_measurement(8), inside.between_pins(3.4)), rel=EXACT)


def test_a_fit_is_the_least_that_scipy_finds() -> None:
    """Of the squares of readings over their uncertainties and of unknowns over their spreads, by the best way."""
    inspection = PINION.inspection
    measured = Measured(
        teeth=31,
        readings=(
            _reading(Gauge.TIP_DIAMETER, PINION.tip_diameter - 0.03),
            _reading(Gauge.ROOT_DIAMETER, PINION.root_diameter + 0.02),
            _reading(Gauge.OVER_BALLS, inspection.over_balls(4.5) + 0.01, 4.5),
            _reading(Gauge.TIP_HELIX_ANGLE, 18.0, uncertainty=1.0),
            _reading(Gauge.SPAN, inspection.span_measurement(5), 5),
        ),
    )
    hypothesis = Hypothesis(next(size for size in SIZES if size.module == 2.5), 20.0, helical=True)
    start = ways(hypothesis, False).means[0]
    fit = fitted(measured, hypothesis, start)
    assert fit is not None
    mean, root = fit.ways.means[fit.best], fit.ways.roots[fit.best]
    read = np.array([each.value for each in measured.readings])
    noise = np.array([each.uncertainty for each in measured.readings])

    def off(spreads: np.ndarray[tuple[int], np.dtype[np.float64]]) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        return np.concatenate([(read - read_off(measured, measured.readings, mean + root @ spreads)) / noise, spreads])

    least = least_squares(off, np.zeros(UNKNOWNS), xtol=1e-12, ftol=1e-12)
    assert fit.chi_square == pytest.approx(2 * least.cost, abs=LEAST)
    assert abs(fit.unknowns[Unknown.HELIX_ANGLE] - 17.0) < 3 * fit.uncertainty(Unknown.HELIX_ANGLE)


@pytest.mark.parametrize("gear", [PINION, RING, Gear(teeth=9, normal_diametral_pitch=10, face_width=20, profile_shift=0.45)])
def test_exact_readings_give_the_gear_back(gear: Gear) -> None:
    inspection, sizes = gear.inspection, [1.55 * gear.normal_module, 1.9 * gear.normal_module]
    over = inspection.between_balls if gear.internal else inspection.over_balls
    gauges = {"between_balls" if gear.internal else "over_balls": {size: over(size) for size in sizes}}
    found = gearcad.identify(
        gear.teeth,
        tip_diameter=abs(gear.tip_diameter),
        root_diameter=abs(gear.root_diameter),
        helix_angle=(gear.helix_angle, 0.5),
        uncertainty=0.01,
        **gauges,
    )
    assert found.certain and found.fits
    best = found.best.gear
    assert best.normal_module == pytest.approx(gear.normal_module, rel=1e-12)
    assert best.rack.pressure_angle == 20.0 and best.rack.dedendum == 1.25
    assert best.profile_shift == pytest.approx(gear.profile_shift, abs=3 * found.best.shift_uncertainty + 1e-4)
    assert max(map(abs, found.best.residuals)) < 1.5


def test_a_worn_tip_with_an_uncertainty_of_its_own_leaves_the_rest() -> None:
    inspection = PINION.inspection
    spans = {count: inspection.span_measurement(count) for count in (4, 5)}
    found = gearcad.identify(
        31, tip_diameter=(PINION.tip_diameter - 0.4, 0.3), root_diameter=PINION.root_diameter, span=spans, tip_helix_angle=18.2
    )
    assert found.best.gear.normal_module == 2.5 and found.best.gear.rack.pressure_angle == 20.0


def test_gears_that_differ_in_little_are_ambiguous_and_what_would_decide_is_said() -> None:
    """The tip diameter alone is not enough; two spans tell the pressure angle by the base pitch."""
    found = gearcad.identify(24, tip_diameter=52.0, helix_angle=0)
    assert not found.certain and found.rivals
    told = found.deciding[0]
    assert min(told.apart) > 2 and len(told.predicted) == min(len(found.rivals) + 1, 4)
    assert told.place.gauge is Gauge.SPAN and told.less is not None
    pitches = [np.pi * each.gear.normal_module * np.cos(np.radians(each.gear.rack.pressure_angle)) for each in found.candidates]
    apart = told.place.size - told.less.size
    assert told.predicted == pytest.approx([apart * pitch for pitch in pitches[: len(told.predicted)]], rel=1e-6)
    decided = gearcad.identify(24, tip_diameter=52.0, root_diameter=43.0, span={3: 15.40, 4: 21.30, 2: 9.49}, helix_angle=0)
    assert decided.certain and decided.best.gear.normal_module == 2.0


def test_other_names_of_the_same_flanks_are_called_alike() -> None:
    """Module 4.98 at 26.325 degrees is in no series, and flanks have no module: what is left differs in nothing measurable."""
    rack = BasicRack(pressure_angle=26.325, addendum=0.795, dedendum=1.178, root_radius=0.2)
    gear = Gear(teeth=30, normal_module=4.98, profile_shift=0.0695, face_width=40, rack=rack)
    circles = {"tip_diameter": gear.tip_diameter, "root_diameter": gear.root_diameter}
    spans = {count: gear.inspection.span_measurement(count) for count in (4, 5, 6)}
    found = gearcad.identify(30, **circles, span=spans, helix_angle=0, uncertainty=0.005)
    assert found.rivals and len(found.alike) >= 2
    for each in found.alike:
        balls = [candidate.gear.inspection.over_balls(8.5) for candidate in (found.best, each)]
        assert balls[0] == pytest.approx(balls[1], abs=0.01)
    other = gearcad.identify(24, tip_diameter=52.0, helix_angle=0)
    assert other.rivals and not other.alike


def test_thin_teeth_are_told() -> None:
    gear = Gear(teeth=40, normal_diametral_pitch=20, face_width=10, tooth_thinning=0.3)
    spans = {count: gear.inspection.span_measurement(count) for count in (4, 5, 6)}
    found = gearcad.identify(40, tip_diameter=gear.tip_diameter, root_diameter=gear.root_diameter, span=spans, helix_angle=0)
    assert "0.3 mm thinner than without backlash" in " ".join(found.warnings)


def test_readings_that_contradict_each_other_are_told() -> None:
    found = gearcad.identify(24, tip_diameter=52.0, root_diameter=43.0, span={2: 9.49, 3: 15.40, 4: 21.60}, helix_angle=0)
    assert not found.fits and not found.certain
    assert any(each.code == "no-fit" for each in found.notices)


def test_a_span_beside_the_involute_is_told() -> None:
    gear = Gear(teeth=24, normal_module=2, face_width=20)
    spans = {count: gear.inspection.span_measurement(count) for count in (3, 7)}
    found = gearcad.identify(24, tip_diameter=52.0, root_diameter=43.0, span=spans, helix_angle=0)
    assert "span over 7 teeth would not touch the involute" in " ".join(found.warnings)


def test_what_gauges_cannot_have_read_is_not_certain() -> None:
    """Spans over 1 and 7 of 24 teeth: their formula names a gear on whose flanks they find no place."""
    inspection = Gear(teeth=24, normal_module=2, face_width=20).inspection
    spans = {count: inspection.span_measurement(count) for count in (1, 7)}
    found = gearcad.identify(24, tip_diameter=52.0, root_diameter=43.0, span=spans, helix_angle=0)
    assert found.best.probability > 0.95 and len(found.best.off_involute) == 2 and not found.certain
    assert "Not certain: a gauge would not touch" in " ".join(identification_lines(found))


@pytest.mark.parametrize(("size", "helix", "normal"), [(3.0, 24.1, 2.75), (25.4 / 8, 45.0, 2.25)])
def test_a_standard_size_of_the_transverse_section_is_found_beside_the_normal_one(
    size: float, helix: float, normal: float
) -> None:
    gear = Gear(teeth=31, normal_module=size * np.cos(np.radians(helix)), face_width=30, helix_angle=helix, tooth_thinning=0.05)
    over, spanned = gear.inspection, gear.inspection.spanned or 0
    angle = float(np.degrees(np.arctan(np.pi * gear.tip_diameter / gear.lead)))
    readings = (
        _reading(Gauge.TIP_DIAMETER, gear.tip_diameter),
        _reading(Gauge.ROOT_DIAMETER, gear.root_diameter),
        _reading(Gauge.TIP_HELIX_ANGLE, angle, uncertainty=1.0),
        *(_reading(Gauge.SPAN, over.span_measurement(count), count) for count in (spanned, spanned + 1)),
        _reading(Gauge.OVER_BALLS, over.over_balls(5.0), 5.0),
    )
    found = identify_gear(Measured(teeth=31, readings=readings))
    assert found.best.transverse and found.best.fit.hypothesis.size.module == size
    assert found.best.gear.normal_module == pytest.approx(gear.normal_module, abs=found.best.module_uncertainty)
    assert found.best.gear.normal_module / np.cos(np.radians(found.best.gear.helix_angle)) == pytest.approx(size, rel=1e-7)
    others = [each for each in found.candidates[1:] if not each.transverse]
    assert any(each.gear.normal_module == normal for each in others)
    assert "transverse" in next(line for line in identification_lines(found) if line.startswith("1"))


def test_teeth_counted_wrong_are_told_by_what_no_gear_has() -> None:
    """24 teeth counted as 25: every reading can be had, by tips that stand half a module too low."""
    inspection = Gear(teeth=24, normal_module=2, face_width=20).inspection
    spans = {count: inspection.span_measurement(count) for count in (3, 4)}
    found = gearcad.identify(25, tip_diameter=52.0, root_diameter=43.0, span=spans, helix_angle=0)
    assert not found.fits and max(map(abs, found.best.residuals)) < 2
    assert "but with a height of the tips and depth of the roots as hardly any gear has" in " ".join(found.warnings)


@pytest.mark.parametrize(("pitch", "module"), [(25, 1.0), (10, 2.5)])
def test_pitches_that_are_nearly_modules_are_told_from_them(pitch: float, module: float) -> None:
    for gear in (
        Gear(teeth=40, normal_diametral_pitch=pitch, face_width=10),
        Gear(teeth=40, normal_module=module, face_width=10),
    ):
        spans = {count: round(gear.inspection.span_measurement(count), 2) for count in (5, 6)}
        found = gearcad.identify(
            40, tip_diameter=gear.tip_diameter, root_diameter=gear.root_diameter, span=spans, helix_angle=0
        )
        assert found.certain and found.best.gear.normal_module == pytest.approx(gear.normal_module, rel=EXACT)


def test_a_notebook_shows_how_far_candidates_are_off() -> None:
    found = gearcad.identify(24, tip_diameter=52.02, root_diameter=43.01, span={3: 15.40, 4: 21.30}, helix_angle=0)
    assert repr(found).startswith("<Identification of z = 24: m_n 2, 20 deg, x 0.000, ")
    first, *_ = plots.plot(found).lines
    assert tuple(first.get_xdata()) == found.best.residuals[:4]  # the last, a helix angle that is 0, no candidate is off
    assert "<img" in found._repr_html_() and "certain" in found._repr_html_()


def test_a_chord_stands_for_a_span() -> None:
    """The height is from the tip that is there: chord and tip diameter, and a second chord, name module and pressure angle."""
    gear = Gear(teeth=30, normal_module=4, face_width=20, tooth_thinning=0.05)
    inspection = gear.inspection
    chords = {height: chord_below_tip(inspection, inspection.addendum, height).thickness for height in (2.0, 4.1, 6.0)}
    circles = {"tip_diameter": gear.tip_diameter, "root_diameter": gear.root_diameter}
    found = gearcad.identify(30, **circles, chordal_thickness=chords, helix_angle=0)
    assert found.best.gear.normal_module == 4.0 and found.best.gear.rack.pressure_angle == 20.0
    assert found.best.gear.tooth_thinning == pytest.approx(0.05, abs=3 * found.best.thinning_uncertainty)


def test_an_odd_number_of_tips_is_told() -> None:
    gear = Gear(teeth=21, normal_module=2, face_width=20)
    found = gearcad.identify(21, tip_diameter=46.0, span={3: gear.inspection.span_measurement(3)}, helix_angle=0)
    assert f"{46.0 * (1 - np.cos(np.pi / 21)) / 2:.2g} mm less" in found.warnings[0]


TIP = {"tip_diameter": 52.0}


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"teeth": 2, **TIP}, r"^teeth = 2: must be a whole number from 3 to 2000$"),
        ({"teeth": -5, **TIP}, r"^teeth = -5: must be a whole number from 3 to 2000, or from -2000 to -10 \(a ring\)$"),
        ({"teeth": 24}, r"^tip_diameter is missing: must be given, or another length"),
        ({"teeth": 24, "helix_angle": 0}, r"^tip_diameter is missing"),
        ({"teeth": 24, "tip_diameter": -52.0}, r"^tip_diameter = -52 mm: must be a number above 0 mm"),
        (
            {"teeth": 24, "tip_diameter": (52.0, 0)},
            r"^tip_diameter.uncertainty = 0 mm: must be a number at least 1e-05 mm",
        ),
        ({"teeth": 24, "tip_diameter": (52.0, 0.1, 0.2)}, r"^tip_diameter = .*: must be a number, or a number and its uncert"),
        ({"teeth": 24, "span": {25: 80.0}}, r"^span_teeth = 25: must be a whole number from 1 to 24$"),
        ({"teeth": 24, "span": {3: 15.4, 4: 15.1}}, r"^span = 15.1 mm: must be above the span over 3, 15.4 mm$"),
        ({"teeth": 24, "span": 15.4}, r"^span = 15.4: must be \{teeth spanned"),
        (
            {"teeth": 24, "between_pins": {3.5: 50.0}},
            r"^between_pins = 50 mm: must be left out: an external gear is measured over",
        ),
        ({"teeth": -24, "over_pins": {3.5: 50.0}}, r"^over_pins = 50 mm: must be left out: a ring is measured between"),
        ({"teeth": -24, "span": {3: 15.4}, "helix_angle": 10}, r"^span = 15.4 mm: must be left out: a helical ring"),
        ({"teeth": 24, **TIP, "helix_angle": 0, "lead": 300.0}, r"^lead = 300 mm: must be left out where a helix angle is 0$"),
        ({"teeth": 24, "centre_distance": 50.0}, r"^mate_teeth is missing: must be given with the centre distance$"),
        ({"teeth": 24, **TIP, "mate_teeth": 30}, r"^centre_distance is missing: must be given with the teeth of the mate$"),
        ({"teeth": -24, "centre_distance": 50.0, "mate_teeth": -30}, r"^mate_teeth = -30: must be of a gear that meshes"),
        (
            {"teeth": 24, **TIP, "helix_angle": -18, "tip_helix_angle": 20},
            r"^tip_helix_angle = 20 deg: must have the sign",
        ),
        ({"teeth": 24, **TIP, "over_pins": {1e9: 60.0}}, r"^over_pins.diameter = 1000000000 mm: must be a number above 0 mm"),
        ({"teeth": -24, "chordal_thickness": {1.5: 3.1}}, r"^chordal_thickness = 3.1 mm: must be left out: a ring is measured"),
        ({"teeth": 24, **TIP, "uncertainty": 0}, r"^uncertainty = 0 mm: must be a number at least 1e-05 mm"),
        ({"teeth": 24, **TIP, "count": 0}, r"^count = 0: must be a whole number from 1 to 100$"),
        ({"teeth": 24, "tip_diameter": "wide"}, r"^tip_diameter = 'wide': must be a number"),
    ],
)
def test_what_no_gear_can_have_is_refused(given: dict[str, object], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        gearcad.identify(**given)  # type: ignore[arg-type]


def test_readings_that_no_gear_comes_near_are_refused() -> None:
    with pytest.raises(GeometryError, match=r"^teeth = 24: must be counted again, or the readings taken again"):
        gearcad.identify(24, tip_diameter=52.0, root_diameter=10.0, span={3: 80.0, 4: 81.0}, helix_angle=0)


def test_candidates_are_gears_whose_readings_are_those_stated() -> None:
    """Every candidate's Gear, rounded as specs have it, reads what the candidate says, to a tenth of an uncertainty."""
    found = gearcad.identify(24, tip_diameter=52.02, root_diameter=43.01, span={3: 15.40, 4: 21.30})
    assert isinstance(found, Identification) and abs(sum(each.probability for each in found.candidates) - 1) < 1e-3
    for each in found.candidates:
        inspection = each.gear.inspection
        read = [each.gear.tip_diameter, each.gear.root_diameter, *(inspection.span_measurement(count) for count in (3, 4))]
        assert read == pytest.approx(each.predicted, abs=0.002)


def test_hypotheses_are_fitted_once_each() -> None:
    measured = Measured(teeth=24, readings=(_reading(Gauge.TIP_DIAMETER, 52.0), _reading(Gauge.HELIX_ANGLE, 0.0)))
    found = [(fit.hypothesis.size, fit.hypothesis.pressure_angle, fit.hypothesis.free_angle) for fit in fits(measured)]
    assert len(set(found)) == len(found) and identify_gear(measured).best.gear.helix_angle == 0.0
