"""Where the factors come from, and which of them are to be verified against the standards' own text, and why."""

from __future__ import annotations

from gearcad.rating.editions import Edition

__all__ = ["citations", "to_verify"]

_CLAUSES = {
    2: {
        "Z_H": "6.1",
        "Z_B": "6.2",
        "Z_D": "6.2",
        "Z_E": "7",
        "Z_eps": "8",
        "Z_beta": "9",
        "Z_NT": "11",
        "Z_L": "12",
        "Z_v": "12",
        "Z_R": "12",
        "Z_W": "13",
        "Z_X": "14",
        **dict.fromkeys(("sigma_H0", "sigma_H", "sigma_HG", "sigma_HP"), "5"),
    },
    3: {
        "Y_F": "6",
        "Y_S": "7",
        "Y_beta": "8",
        "Y_B": "9",
        "Y_DT": "10",
        "Y_NT": "12",
        "Y_delta_relT": "13",
        "Y_RrelT": "14",
        "Y_X": "15",
        "Y_M": "annex B",
        **dict.fromkeys(("Y_ST", "sigma_F0", "sigma_F", "sigma_FG", "sigma_FP"), "5"),
    },
}
"""Of ISO 6336:2006, by part."""

_OWN = {
    Edition.ISO_2006: (),
    Edition.ISO_2019: ("Z_B", "Z_D", "Y_F", "Y_beta", "Y_DT"),
    Edition.DIN_1987: ("Z_beta", "Z_X", "Y_B", "Y_DT"),
}
"""What an edition has otherwise than that of 2006."""

_TRANSITION = "between static strength and endurance limit, and the static value, by one public transcription of DIN 3990-11"
_FLANK_2019 = "f_ZCa is as remembered of ISO 6336-2:2019"


def citations(edition: Edition) -> dict[str, str]:
    """Part and clause by symbol. Other editions than that of 2006 are cited where they differ, without a clause."""
    return {
        symbol: edition.dated_part(part)
        if symbol in _OWN[edition]
        else f"{Edition.ISO_2006.dated_part(part)}, {clause if ' ' in clause else f'clause {clause}'}"
        for part, clauses in _CLAUSES.items()
        for symbol, clause in clauses.items()
    }


def to_verify(
    edition: Edition, *, internal: bool = False, limited_flank: bool = False, limited_root: bool = False
) -> dict[str, str]:
    """Why, by symbol. `limited_flank`: load cycles of a flank are fewer than its endurance limit asks; of a root likewise."""
    found = {"Z_D": "that of a ring is as remembered of ISO 6336-2:2006"} if internal else {}
    if edition is Edition.ISO_2019:
        found |= {
            "Z_B": _FLANK_2019,
            "Z_D": _FLANK_2019,
            "Y_F": "f_eps is as remembered of ISO 6336-3:2019",
            "Y_beta": "by one public transcription of ISO 6336-3:2019",
            "Y_DT": "taken as 1 beside f_eps of ISO 6336-3:2019",
        }
    if limited_flank:
        found |= dict.fromkeys(("Z_L", "Z_v", "Z_R", "Z_W", "Z_X"), _TRANSITION)
    if limited_root:
        found |= dict.fromkeys(("Y_delta_relT", "Y_RrelT", "Y_X"), _TRANSITION)
    return found
