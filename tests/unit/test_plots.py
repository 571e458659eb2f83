"""Pictures of results: which rows and columns they show, how these are labelled, and where the contours run."""

import subprocess
import sys
import warnings
from io import BytesIO
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from gearcad import ParameterError, SpecError
from gearcad.core import symbols
from gearcad.designs.keys import FIELDS
from gearcad.plots import axis_label, plot_contours, plot_scatter, save_plot
from gearcad.plots.paper import prepared
from gearcad.plots.table_data import Column, Points, read_points

HEADINGS = (
    "name,status,error,warnings,seconds,pair.helix_angle,pinion.profile_shift,wheel.profile_shift,"
    "material.name,pinion.undercut,pinion.helix_angle,pair.transverse_contact_ratio,pinion.body.rim_diameter"
)
ROWS = (
    "a,ok,,,0.1,26.0,-0.1,0.3,steel,true,26.0,1.5,",
    "b,ok,,,0.1,26.0,0.1,0.1,'=brass,false,26.0,1.4,",
    "c,failed,no gear,,0.1,28.0,-0.1,,steel,,,,",
    "d,ok,,,,28.0,0.1,-0.1,steel,false,28.0,1.3,",
    "e,not run,,,,,,,,,,,",
)

SAME_PLACE = 1e-9
"""Absolute, for places on axes of length about 1: linear interpolation in double precision."""


@pytest.fixture
def results(tmp_path: Path) -> Path:
    path = tmp_path / "helix" / "results.csv"
    path.parent.mkdir()
    path.write_text("\n".join([HEADINGS, *ROWS, ""]), encoding="utf-8")
    return path


def points(x: object, y: object, third: object = None, keys: tuple[str, str, str] = ("x", "y", "z")) -> Points:
    columns = [None if values is None else Column(key, tuple(values)) for key, values in zip(keys, (x, y, third), strict=True)]
    return Points(name="trial", x=columns[0], y=columns[1], third=columns[2])


# ---------------------------------------------------------------------- reading


def test_rows_that_are_ok_and_complete_are_the_points(results: Path) -> None:
    found = read_points(results, "pinion.profile_shift", "pair.transverse_contact_ratio", colour="pair.helix_angle")
    assert found == Points(
        name="helix",
        x=Column("pinion.profile_shift", (-0.1, 0.1, 0.1)),
        y=Column("pair.transverse_contact_ratio", (1.5, 1.4, 1.3)),
        third=Column("pair.helix_angle", (26.0, 26.0, 28.0)),
        omitted=2,
    )


def test_a_row_that_failed_is_left_out_even_if_it_has_the_inputs(results: Path) -> None:
    found = read_points(results, "pinion.profile_shift", "pair.helix_angle")
    assert (found.y.values, found.omitted) == ((26.0, 26.0, 28.0), 2)


def test_a_blank_cell_leaves_a_row_out(results: Path) -> None:
    found = read_points(results, "seconds", "wheel.profile_shift")
    assert (found.x.values, found.omitted, found.third) == ((0.1, 0.1), 3, None)


def test_texts_are_without_the_apostrophe_of_the_spreadsheet(results: Path) -> None:
    third = read_points(results, "pinion.profile_shift", "wheel.profile_shift", colour="material.name").third
    assert third is not None and third.is_text
    assert third.values == ("steel", "=brass", "steel")


def test_a_file_that_a_spreadsheet_saved_again_reads_the_same(results: Path) -> None:
    before = read_points(results, "pinion.profile_shift", "wheel.profile_shift", colour="name")
    results.write_bytes(b"\xef\xbb\xbf" + results.read_bytes().replace(b"\n", b"\r\n"))
    assert read_points(results, "pinion.profile_shift", "wheel.profile_shift", colour="name") == before
    assert before.third == Column("name", ("a", "b", "d"))


@pytest.mark.parametrize(("name", "title"), [("results.csv", "helix"), ("other.csv", "other")])
def test_results_are_called_after_their_folder_or_their_own_name(name: str, title: str, results: Path) -> None:
    path = results.rename(results.with_name(name))
    assert read_points(path, "pinion.profile_shift", "wheel.profile_shift").name == title


@pytest.mark.parametrize(
    ("asked", "key"),
    [
        ("pinion.profile_shift", "pinion.profile_shift"),
        ("transverse_contact_ratio", "pair.transverse_contact_ratio"),
        ("helix_angle", "pair.helix_angle"),
        ("pinion.helix_angle", "pinion.helix_angle"),
        ("seconds", "seconds"),
    ],
)
def test_a_key_may_lack_its_beginning(asked: str, key: str, results: Path) -> None:
    assert read_points(results, asked, "wheel.profile_shift").x.key == key
    assert read_points(results, asked, "wheel.profile_shift", colour="undercut").third == Column(
        "pinion.undercut", ("true", "false") if key == "seconds" else ("true", "false", "false")
    )


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ("profile_shift", "x = 'profile_shift': could be pinion.profile_shift or wheel.profile_shift; write the one in full"),
        ("contact", "x = 'contact': no such column; did you mean pair.transverse_contact_ratio?"),
        ("qwerty", "x = 'qwerty': no such column; columns.csv beside the file explains them all"),
        ("epsilon_alpha", "x = 'epsilon_alpha': no such column; did you mean pair.transverse_contact_ratio?"),
        ("ratio_of_contact", "x = 'ratio_of_contact': no such column; did you mean pair.transverse_contact_ratio?"),
        (
            "mesh_stiffness",
            "x = 'mesh_stiffness': no such column; figures of a check are there after `gearcad batch --do check`",
        ),
        ("wheel.rim_diameter", "x = 'wheel.rim_diameter': no such column; did you mean pinion.body.rim_diameter?"),
        ("pinion.profil_shift", "x = 'pinion.profil_shift': no such column; did you mean pinion.profile_shift?"),
    ],
)
def test_a_key_that_fits_no_column_or_two_is_one_line(asked: str, message: str, results: Path) -> None:
    with pytest.raises(ParameterError) as caught:
        read_points(results, asked, "wheel.profile_shift")
    assert str(caught.value) == message


def test_colour_and_contour_exclude_each_other(results: Path) -> None:
    with pytest.raises(ParameterError) as caught:
        read_points(results, "pinion.profile_shift", "wheel.profile_shift", colour="seconds", contour="helix_angle")
    assert str(caught.value) == "contour = 'helix_angle': cannot stand beside colour; give one of them"


@pytest.mark.parametrize("role", ["x", "y", "contour"])
@pytest.mark.parametrize(("key", "shown"), [("material.name", "steel"), ("pinion.undercut", "true")])
def test_a_text_cannot_be_an_axis(role: str, key: str, shown: str, results: Path) -> None:
    keys = {"x": "pair.helix_angle", "y": "wheel.profile_shift", role: key}
    with pytest.raises(SpecError) as caught:
        read_points(results, keys["x"], keys["y"], contour=keys.get("contour"))
    assert str(caught.value) == f"{results} row 2: {key} = '{shown}': must be a number to be drawn; take another column"


def test_nothing_to_draw_is_one_line(results: Path) -> None:
    with pytest.raises(SpecError) as caught:
        read_points(results, "seconds", "pinion.body.rim_diameter")
    assert str(caught.value) == (
        f"{results}: has nothing to draw: "
        "no row is ok and has a value of each of seconds, pinion.body.rim_diameter (5 left out)"
    )


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "is no table of results, for it has no column status; "),
        (b"name,pinion.teeth\na,20\n", "is no table of results, for it has no column status; "),
        (b"\x89PNG\r\n", "is no table of results, for it is not CSV in UTF-8 ("),
        (HEADINGS.encode() + b"\na,ok," + b"x" * 200_000, "is no table of results, for it is not CSV in UTF-8 (field larger"),
    ],
)
def test_another_file_is_refused_in_one_line(content: bytes, message: str, tmp_path: Path) -> None:
    path = tmp_path / "other.csv"
    path.write_bytes(content)
    with pytest.raises(SpecError) as caught:
        read_points(path, "seconds", "seconds")
    assert str(caught.value).startswith(f"{path}: {message}")
    assert str(caught.value).endswith("; give the results.csv of `gearcad batch`")


def test_a_missing_file_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(
        SpecError, match=r"cannot be read \(No such file or directory\); give the results.csv of `gearcad batch`$"
    ):
        read_points(tmp_path / "results.csv", "seconds", "seconds")


# ---------------------------------------------------------------------- labels


@pytest.mark.parametrize(
    ("key", "label"),
    [
        ("pinion.profile_shift", "pinion: profile shift coefficient $x$"),
        ("pair.transverse_contact_ratio", r"transverse contact ratio $ε_{\mathrm{α}}$"),
        ("wheel.tip_diameter", r"wheel: tip diameter $d_{\mathrm{a}}$ in mm"),
        ("gear.rack.root_radius", r"root radius of the rack $ρ_{\mathrm{fP}}^{*}$"),
        ("pair.helix_angle", "helix angle (right hand +) $β$ in °"),
        ("pair.working_pitch_diameters.wheel", r"wheel: working pitch diameter $d_{\mathrm{w}}$ in mm"),
        ("pair.path_of_contact.A", "first contact, from T1 $T_1A$ in mm"),
        ("pair.usable_contact_ratio", "contact ratio above the form circles"),
        ("load.torque", r"torque on the pinion $T_{\mathrm{1}}$ in N·m"),
        ("material.density", "density $ρ$ in kg/m³"),
        ("seconds", "time to make the row in s"),
        ("what.$is$.this", r"what.\$is\$.this"),
    ],
)
def test_a_label_has_words_symbol_and_unit(key: str, label: str) -> None:
    assert axis_label(key) == label


def test_every_symbol_can_be_drawn() -> None:
    """A glyph that the font lacks is a warning of matplotlib, and mathtext that it cannot read an error."""
    tables = {**FIELDS, "pinion": {*FIELDS["pinion"], *symbols.GEAR}, "pair": {*FIELDS["pair"], *symbols.PAIR}}
    keys = [f"{table}.{field}" for table, known in tables.items() for field in known]
    labels = [axis_label(key) for key in keys]
    assert not set(labels) & set(keys)
    figure = Figure()
    for label in labels:
        figure.text(0.1, 0.5, label)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figure.canvas.draw()


# ---------------------------------------------------------------------- scatter


def test_few_numbers_make_a_series_each_joined_where_the_table_sweeps() -> None:
    x = [0.0, 0.0, 0.1, 0.1, 0.2, 0.2]
    axes = plot_scatter(points(x, [1, 2, 3, 4, 5, 6], [28.0, 26.0] * 3, ("a", "b", "pair.helix_angle")))
    first, second = axes.lines
    assert (list(first.get_ydata()), list(second.get_ydata())) == ([2, 4, 6], [1, 3, 5])
    assert first.get_linestyle() == second.get_linestyle() == "-"
    assert [to_hex(line.get_color()) for line in axes.lines] == ["#0072b2", "#d55e00"]
    assert first.get_marker() != second.get_marker()
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["26", "28"]
    assert axes.get_legend().get_title().get_text() == "helix angle (right\nhand +) $β$ in °"
    assert (axes.get_title(), axes.get_xlabel(), axes.get_ylabel()) == ("trial", "a", "b")


@pytest.mark.parametrize(
    ("x", "line"), [([1, 2, 3], "-"), ([3, 2, 1], "-"), ([1, 3, 2], "None"), ([1, 1, 2], "None"), ([1, 2], "None")]
)
def test_points_are_joined_only_where_x_goes_one_way(x: list[float], line: str) -> None:
    assert plot_scatter(points(x, x)).lines[0].get_linestyle() == line


def test_one_series_that_is_not_swept_leaves_all_unjoined() -> None:
    axes = plot_scatter(points([1, 2, 3, 1, 3, 2], [0] * 6, ["a"] * 3 + ["b"] * 3))
    assert [line.get_linestyle() for line in axes.lines] == ["None", "None"]


def test_texts_are_shown_as_they_are() -> None:
    names = ["_hidden", "$x$", "steel"]
    axes = plot_scatter(points([1, 2, 3], [1, 2, 3], names, ("a", "b", "material.name")))
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["_hidden", r"\$x\$", "steel"]
    assert [list(line.get_xdata()) for line in axes.lines] == [[1], [2], [3]]


def test_nearly_equal_numbers_stay_apart() -> None:
    axes = plot_scatter(points([1, 2], [1, 2], [1.0, 1.0 + 1e-13]))
    assert len(axes.lines) == 2


def test_many_numbers_make_a_colour_bar() -> None:
    values = [float(value) for value in range(7)]
    axes = plot_scatter(points(values, values, values, ("a", "b", "pinion.tip_diameter")))
    assert not axes.lines and axes.get_legend() is None
    assert list(axes.collections[0].get_array()) == values
    assert axes.figure.axes[1].get_ylabel() == r"pinion: tip diameter $d_{\mathrm{a}}$ in mm"


def test_more_texts_than_colours_are_refused() -> None:
    names = [f"steel {number}" for number in range(7)]
    with pytest.raises(ParameterError) as caught:
        plot_scatter(points(range(7), range(7), names, ("a", "b", "material.name")))
    assert str(caught.value) == "colour = 'material.name': has 7 different texts, and at most 6 colours can be told apart"


def test_it_draws_on_the_axes_that_are_given() -> None:
    left, right = Figure().subplots(1, 2)
    assert plot_scatter(points([1, 2, 3], [1, 2, 3]), right) is right
    assert (len(left.lines), len(right.lines)) == (0, 1)


# ---------------------------------------------------------------------- contours


def plane(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return 0.3 + 2.0 * x - 0.02 * y


def lines_of(axes: matplotlib.axes.Axes) -> dict[float, np.ndarray]:
    """Vertices of the contour line of every level that has one."""
    filled, lines = axes.collections[:2]
    assert list(filled.levels) == list(lines.levels)
    paths = zip(lines.levels, lines.get_paths(), strict=True)
    return {float(level): path.vertices for level, path in paths if len(path.vertices)}


def grid() -> tuple[np.ndarray, np.ndarray]:
    x, y = np.meshgrid(np.linspace(-0.2, 0.6, 9), np.linspace(20, 30, 6))
    return x.ravel(), y.ravel()


def scattered() -> tuple[np.ndarray, np.ndarray]:
    x, y = np.random.default_rng(0).random((2, 60))
    return 0.8 * x - 0.2, 20 + 10 * y


@pytest.mark.parametrize("places", [grid, scattered])
def test_contours_of_a_plane_are_where_they_belong(places: object) -> None:
    """Interpolation between points is linear, so for a plane it is exact."""
    x, y = places()
    lines = lines_of(plot_contours(points(x, y, plane(x, y))))
    assert len(lines) >= 6
    for level, vertices in lines.items():
        assert plane(*vertices.T) == pytest.approx(level, abs=SAME_PLACE)


@pytest.mark.parametrize("places", [grid, scattered])
def test_contours_over_many_decades_are_straight_between_logarithms(places: object) -> None:
    x, y = places()
    axes = plot_contours(points(10 ** (5 * x), y, plane(x, y)))
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "linear")
    off = [np.abs(plane(np.log10(v[:, 0]) / 5, v[:, 1]) - level) for level, v in lines_of(axes).items()]
    assert len(off) >= 6
    # matplotlib cuts a line on both sides of its number, where it takes it for straight without logarithms.
    beside = np.concatenate(off) > SAME_PLACE
    assert beside.sum() <= 2 * len(axes.texts)
    assert np.concatenate(off).max() < 0.01
    assert plot_contours(points(10 ** (2 * x), y, plane(x, y))).get_xscale() == "linear"


def test_a_grid_in_any_order_is_a_grid() -> None:
    x, y = grid()
    order = np.random.default_rng(0).permutation(len(x))
    ordered, mixed = (lines_of(plot_contours(points(x[o], y[o], plane(x, y)[o]))) for o in (slice(None), order))
    assert ordered.keys() == mixed.keys()
    assert all(np.array_equal(ordered[level], mixed[level]) for level in ordered)


def test_a_hole_in_a_grid_stays_a_hole() -> None:
    """Rows that make no gear are not bridged; only the corners of the cells around them are cut off."""
    x, y = grid()
    kept = ~((x > 0.05) & (x < 0.35) & (y > 23) & (y < 27))
    assert kept.sum() == len(x) - 6
    vertices = np.vstack(list(lines_of(plot_contours(points(x[kept], y[kept], plane(x, y)[kept]))).values()))
    inside = (vertices[:, 0] > 0.1) & (vertices[:, 0] < 0.3) & (vertices[:, 1] > 24) & (vertices[:, 1] < 26)
    assert not inside.any()
    assert len(vertices) > 50


def test_triangles_do_not_depend_on_the_scales_of_the_axes() -> None:
    x, y = np.random.default_rng(1).random((2, 60))
    plain, stretched = (lines_of(plot_contours(points(x, y * scale, np.sin(5 * x * y)))) for scale in (1.0, 1e6))
    assert plain.keys() == stretched.keys()
    for level, vertices in plain.items():
        assert stretched[level] / [1.0, 1e6] == pytest.approx(vertices, abs=SAME_PLACE)


def test_nothing_is_drawn_across_a_border_that_bends_in_a_little() -> None:
    """There the triangles between border points are so flat that all lines would crowd in them."""
    x = np.linspace(0.0, 1.0, 41)
    border = 4e-3 * x * (1 - x)
    xs, ys = np.concatenate([x, x[1:-1:4], [0, 1]]), np.concatenate([border, np.full(10, 0.7), [1, 1]])
    vertices = np.vstack(list(lines_of(plot_contours(points(xs, ys, np.sin(12 * xs) + ys))).values()))
    assert (vertices[:, 1] >= np.interp(vertices[:, 0], x, border) - SAME_PLACE).all()
    assert len(vertices) > 100


def test_rows_that_agree_are_one_point() -> None:
    x, y = (np.concatenate([values, values]) for values in grid())
    assert (
        lines_of(plot_contours(points(x, y, plane(x, y)))).keys()
        == lines_of(plot_contours(points(*grid(), plane(*grid())))).keys()
    )


def test_contours_have_numbers_points_and_a_bar() -> None:
    x, y = grid()
    axes = plot_contours(points(x, y, plane(x, y), ("a", "b", "pinion.tip_diameter")))
    assert {text.get_text() for text in axes.texts} <= {"-0.6", "-0.4", "-0.2", "0", "0.2", "0.4", "0.6", "0.8", "1"}
    assert len(axes.texts) >= 4
    assert not any(text.get_clip_on() for text in axes.texts)
    assert np.array_equal(axes.lines[0].get_xydata(), np.column_stack([x, y]))
    assert axes.figure.axes[1].get_ylabel() == r"pinion: tip diameter $d_{\mathrm{a}}$ in mm"


IN_LINE = "contour = 'z': needs three points at least that do not lie in line"


@pytest.mark.parametrize(
    ("x", "y", "z", "message"),
    [
        ([1], [1], [1], IN_LINE),
        ([1, 2], [1, 3], [1, 2], IN_LINE),
        ([1, 2, 3], [2, 4, 6], [1, 2, 5], IN_LINE),
        ([1, 1, 1, 1], [1, 2, 3, 4], [1, 2, 3, 4], IN_LINE),
        ([0.1, 0.2, 0.3, 0.4], [0.2, 0.4, 0.6 + 1e-12, 0.8], [1, 2, 3, 4], IN_LINE),
        ([1, 1, 2, 2], [1, 2, 1, 2], [5, 5, 5, 5], "contour = 'z': is 5 everywhere; take another column"),
        (
            [1, 1, 2, 2, 1],
            [1, 2, 1, 2, 2],
            [1, 2, 3, 4, 2.5],
            "contour = 'z': has two values at x = 1, y = 2: the rows differ in more; take colour instead",
        ),
    ],
)
def test_points_without_contours_are_refused_in_one_line(x: list[float], y: list[float], z: list[float], message: str) -> None:
    with warnings.catch_warnings(), pytest.raises(ParameterError) as caught:
        warnings.simplefilter("error")
        plot_contours(points(x, y, z))
    assert str(caught.value) == message


# ---------------------------------------------------------------------- files


@pytest.mark.parametrize(
    ("draw", "suffix"),
    [
        *((plot_scatter, suffix) for suffix in (".svg", ".pdf", ".PNG")),
        (plot_contours, ".png"),
    ],
)
def test_the_same_points_are_the_same_bytes(draw: object, suffix: str, tmp_path: Path) -> None:
    x, y = grid()
    files = [tmp_path / f"one{suffix}", tmp_path / f"other{suffix}"]
    for file in files:
        save_plot(draw, points(x, y, plane(x, y)), file)
    one, other = (file.read_bytes() for file in files)
    assert one == other
    assert one.startswith({".png": b"\x89PNG", ".svg": b"<?xml", ".pdf": b"%PDF"}[suffix.lower()])


def test_a_picture_is_made_for_print_whatever_the_users_style(tmp_path: Path) -> None:
    shared = points([1, 2, 3], [1, 2, 3])
    save_plot(plot_scatter, shared, tmp_path / "plain.png")
    with matplotlib.rc_context({"font.size": 30, "axes.facecolor": "black", "savefig.dpi": 30}):
        before = dict(matplotlib.rcParams)
        save_plot(plot_scatter, shared, tmp_path / "styled.png")
        assert dict(matplotlib.rcParams) == before
    picture = (tmp_path / "plain.png").read_bytes()
    assert (tmp_path / "styled.png").read_bytes() == picture
    width, height = (int.from_bytes(picture[start : start + 4], "big") for start in (16, 20))
    assert (width, height) == (960, 660)


def test_a_name_in_another_script_is_no_warning(tmp_path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        save_plot(plot_scatter, Points(name="歯車 $1", x=Column("x", (1.0,)), y=Column("y", (1.0,))), tmp_path / "a.png")


def test_another_kind_of_picture_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError) as caught:
        save_plot(plot_scatter, points([1], [1]), Path("picture.jpg"))
    assert str(caught.value) == "output = 'picture.jpg': must end in .png or .svg or .pdf"


def test_drawing_needs_neither_a_screen_nor_pyplot(tmp_path: Path) -> None:
    code = f"""
import sys
from pathlib import Path
from gearcad.plots.paper import prepared
from gearcad.plots.table_data import Column, Points
from gearcad.plots import plot_contours, save_plot
assert "matplotlib" not in sys.modules
columns = [Column("x", (0.0, 0.0, 1.0, 1.0)), Column("y", (0.0, 1.0, 0.0, 1.0)), Column("z", (0.0, 1.0, 2.0, 3.0))]
save_plot(plot_contours, Points(name="a", x=columns[0], y=columns[1], third=columns[2]), Path({str(tmp_path / "a.png")!r}))
assert "matplotlib.pyplot" not in sys.modules
"""
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60, env={"PATH": "", "HOME": str(tmp_path)})
    assert (tmp_path / "a.png").stat().st_size > 10_000


@pytest.mark.parametrize(
    ("values", "shown"),
    [
        ([5e-15, -3e-15, 4e-15], (-1.0, 1.0)),
        ([1 + 5e-15, 1 - 3e-15, 1.0], (0.95, 1.05)),
        ([1.0, 2.0, 3.0], (0.9, 3.1)),
        ([], (-0.055, 0.055)),
        ([1.0, 1 + 1e-7, 1.0], (1 - 5e-9, 1 + 1.05e-7)),
    ],
)
def test_an_axis_does_not_show_rounding(values: list[float], shown: tuple[float, float]) -> None:
    axes = prepared(None, "x", "y")
    axes.plot(range(len(values)), values)
    axes.figure.savefig(BytesIO(), format="png")
    assert axes.get_ylim() == pytest.approx(shown, rel=1e-12)
