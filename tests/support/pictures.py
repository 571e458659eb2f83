"""Reports without their pictures: drawing takes longer than all the rest of a command, and tests of reports have it."""

import pytest

_PICTURED = ("document", "check", "strength", "planetary", "dynamics")


def leave_out_pictures(patch: pytest.MonkeyPatch) -> None:
    """Every picture of a report is empty from here on."""
    for room in _PICTURED:
        for name in ("figure_address", "picture_address"):
            patch.setattr(f"gearcad.report.{room}.{name}", lambda *_drawing: "data:,", raising=False)
