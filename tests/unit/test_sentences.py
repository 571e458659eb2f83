"""Sentences of templates are plain text on one line, whatever lines, branches and macros they are written in."""

from gearcad.check.explanation import Compared, LinesExplanation
from gearcad.report.document import sentences

LINES = LinesExplanation(
    greatest_pressure=None,
    length=Compared(computed=31.25, standard=30.0),
    mean_line_load=12345.6,
    pitch_point_radius=9.5,
    face_load_factor=Compared(computed=1.25, standard=1.5),
    greatest_across=-4.0,
    misalignment=-8.0,
)


def test_branches_and_lines_follow_each_other_after_one_space() -> None:
    assert sentences("reasons_solid.txt", "pressure", LINES) == (
        "Pressure: none away from the edges. ISO has the mean, F_bn K_A over 30 mm of lines: 12\u202f350 N/mm, on the radius "
        "9.5 mm of the pitch point, and carries it to the inner point of single contact by Z_B and Z_D."
    )


def test_nothing_is_escaped_before_the_page_does_it() -> None:
    said = sentences("reasons_solid.txt", "lines", LINES)
    assert said.startswith("Lines of contact: 31.25 mm carry on the mean; the rigid gears' lines are 30 mm long. Teeth that")
