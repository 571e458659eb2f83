"""Exact geometry of cylindrical gears: numpy, and scipy inside functions. Lengths in mm, angles in degrees."""

from gearcad.geometry.body import Body, HubSide
from gearcad.geometry.gear import Gear
from gearcad.geometry.inspection import chordal_thickness, over_balls, over_pins, span_contact_diameter, span_measurement
from gearcad.geometry.involute import inverse_involute, involute
from gearcad.geometry.modification import FlankForm, FlankModification, ReliefShape
from gearcad.geometry.pair import CommonWidth, GearPair
from gearcad.geometry.path import ContactLineLengths, PathOfContact, contact_line_length
from gearcad.geometry.pose import MeshPose, mesh_pose
from gearcad.geometry.profile import ToothProfile
from gearcad.geometry.rack import ISO53_A, ISO53_B, ISO53_C, ISO53_D, NAMED_RACKS, BasicRack
from gearcad.geometry.shift import (
    ShiftSplit,
    profile_shift_sum,
    specific_sliding,
    split_profile_shift,
    zero_backlash_centre_distance,
)

__all__ = [
    "ISO53_A",
    "ISO53_B",
    "ISO53_C",
    "ISO53_D",
    "NAMED_RACKS",
    "BasicRack",
    "Body",
    "CommonWidth",
    "ContactLineLengths",
    "FlankForm",
    "FlankModification",
    "Gear",
    "GearPair",
    "HubSide",
    "MeshPose",
    "PathOfContact",
    "ReliefShape",
    "ShiftSplit",
    "ToothProfile",
    "chordal_thickness",
    "contact_line_length",
    "inverse_involute",
    "involute",
    "mesh_pose",
    "over_balls",
    "over_pins",
    "profile_shift_sum",
    "span_contact_diameter",
    "span_measurement",
    "specific_sliding",
    "split_profile_shift",
    "zero_backlash_centre_distance",
]
