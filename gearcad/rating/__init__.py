"""Analytic ratings of a gear pair: Hertz's line contact, and ISO 6336:2006 or DIN 3990:1987, Method B. Pure functions."""

from __future__ import annotations

TYPE_CHECKING = False  # as in guard.py
if TYPE_CHECKING:
    from gearcad.rating.both import Both, both
    from gearcad.rating.duty_options import LoadBin
    from gearcad.rating.dynamic_factor import DynamicFactor
    from gearcad.rating.editions import Edition
    from gearcad.rating.face_load import face_load_factor, root_face_load_factor, width_to_height
    from gearcad.rating.hertz import LineContact, Peak, Stresses, reduced_modulus, reduced_radius
    from gearcad.rating.iso6336_1 import MeshStiffness, gear_blank_factor
    from gearcad.rating.iso6336_2 import FlankRating
    from gearcad.rating.iso6336_3 import RootRating
    from gearcad.rating.iso6336_5 import EnduranceLimits, endurance_limits, endurance_limits_of
    from gearcad.rating.load_factor_options import AlphaDeviation, BearingArrangement, ContactPattern, HelixModification
    from gearcad.rating.lubricant_options import Lubrication, OilType
    from gearcad.rating.mesh_contact import base_normal_force, contact_at, pitch_point_contact
    from gearcad.rating.options import RatingOptions, RootShift
    from gearcad.rating.rack_rating import RackRating, rack_contact_at, rate_rack
    from gearcad.rating.rate import Rating, rate
    from gearcad.rating.root_section import RootSection
    from gearcad.rating.running_in import RunningIn, running_in_alpha, running_in_beta
    from gearcad.rating.tolerances import Accuracy
    from gearcad.rating.virtual import LoadPoint, VirtualGear

__all__ = [
    "Accuracy",
    "AlphaDeviation",
    "BearingArrangement",
    "Both",
    "ContactPattern",
    "DynamicFactor",
    "Edition",
    "EnduranceLimits",
    "FlankRating",
    "HelixModification",
    "LineContact",
    "LoadBin",
    "LoadPoint",
    "Lubrication",
    "MeshStiffness",
    "OilType",
    "Peak",
    "RackRating",
    "Rating",
    "RatingOptions",
    "RootRating",
    "RootSection",
    "RootShift",
    "RunningIn",
    "Stresses",
    "VirtualGear",
    "base_normal_force",
    "both",
    "contact_at",
    "endurance_limits",
    "endurance_limits_of",
    "face_load_factor",
    "gear_blank_factor",
    "pitch_point_contact",
    "rack_contact_at",
    "rate",
    "rate_rack",
    "reduced_modulus",
    "reduced_radius",
    "root_face_load_factor",
    "running_in_alpha",
    "running_in_beta",
    "width_to_height",
]

if not TYPE_CHECKING:
    import sys

    from gearcad.lazy import NamesFirst, lazily

    __getattr__ = lazily(
        __name__,
        __all__,
        (
            "editions",
            "options",
            "hertz",
            "both",
            "duty_options",
            "load_factor_options",
            "lubricant_options",
            "tolerances",
            "running_in",
            "iso6336_5",
            "virtual",
            "face_load",
            "rate",
            "dynamic_factor",
            "iso6336_1",
            "iso6336_2",
            "iso6336_3",
            "mesh_contact",
            "rack_rating",
            "root_section",
        ),
    )
    sys.modules[__name__].__class__ = NamesFirst
