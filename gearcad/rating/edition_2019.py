"""What ISO 6336-2:2019 and -3:2019 have otherwise than the editions of 2006. All of it is to be verified.

Their texts were not at hand: Y_beta is by one public transcription, f_eps and f_ZCa are as remembered.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gearcad.geometry import FlankModification
from gearcad.notice import Notice
from gearcad.rating.editions import Edition
from gearcad.rating.factors.elementwise import Values, bounded, chosen, number_or_array, power

__all__ = ["RECALLED", "edition_notices", "helix_angle_divisor", "load_distribution_factor", "modification_factor", "relieved"]

RECALLED = ("Z_B", "Z_D", "Y_F", "Y_beta", "Y_DT")
"""Symbols of what is to be verified in a rating by this edition."""

_UNMODIFIED = FlankModification()


def load_distribution_factor(virtual_contact_ratio: Values, overlap_ratio: Values) -> Values:
    """f_eps of Y_F: what one tooth has of the load, by eps_alphan and eps_beta.

    Without overlap 1, and 0.7 from eps_alphan = 2 on. With it sqrt(1 - eps_beta + eps_beta/eps_alphan), from eps_alphan = 2 on
    sqrt((1 - eps_beta)/2 + eps_beta/eps_alphan), and sqrt(1/eps_alphan) from eps_beta = 1 on.
    """
    alone = chosen(virtual_contact_ratio < 2, 1.0, 0.5)
    overlap = chosen(overlap_ratio < 1, overlap_ratio, 1.0)
    helical = power(alone * (1 - overlap) + overlap / virtual_contact_ratio, 0.5)
    return chosen(overlap_ratio > 0, helical, chosen(virtual_contact_ratio < 2, 1.0, 0.7))


def helix_angle_divisor(helix_angle: Values) -> Values:
    """cos^3 beta, by which Y_beta is divided (-3, (66)), |beta| at most 30 deg."""
    return number_or_array(helix_angle, np.cos(np.radians(bounded(helix_angle, -30, 30))) ** 3)


def modification_factor(helix_angle: Values, *, modified: bool) -> Values:
    """f_ZCa, by which Z_B and Z_D are multiplied (-2): 1 with an adequate profile modification, else 1.07, of spur gears 1.2.

    Whether it multiplies the stress or the load was not known: the stress is the greater.
    """
    return chosen(helix_angle == 0, 1.0 if modified else 1.2, 1.0 if modified else 1.07)


def relieved(pinion: FlankModification, wheel: FlankModification = _UNMODIFIED) -> bool:
    """Whether profiles are taken back where contact begins and where it ends, which is taken to be adequate."""
    crowned = max(pinion.profile_crowning, wheel.profile_crowning) > 0
    return crowned or bool((pinion.tip_relief or wheel.root_relief) and (wheel.tip_relief or pinion.root_relief))


def edition_notices(edition: Edition, *, modified: bool) -> Iterator[Notice]:
    """That the edition of 2019 is known at second hand only, and what it was asked of the profiles."""
    if edition is not Edition.ISO_2019:
        return
    text = (
        "ISO 6336:2019: f_eps in Y_F, Y_beta/cos³β, Y_DT = 1 beside f_eps, and f_ZCa in Z_B and Z_D are not from its own text,"
        " which was not at hand: verify them before they decide"
    )
    yield Notice("edition-2019-to-verify", text)
    if not modified:
        text = "sigma_H: profiles are not taken back at both ends of the contact, so ISO 6336:2019 raises Z_B and Z_D by f_ZCa"
        yield Notice("profile-not-modified", text)
