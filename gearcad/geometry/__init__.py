"""Exact geometry of cylindrical gears: numpy, and scipy inside functions. Lengths in mm, angles in degrees."""

from gearcad.geometry.gear import Gear
from gearcad.geometry.gear_parts import (
    ISO53_A,
    ISO53_B,
    ISO53_C,
    ISO53_D,
    NAMED_RACKS,
    BasicRack,
    Body,
    DoubleHelix,
    HubSide,
    ShaperCutter,
)
from gearcad.geometry.gear_pictures import Pose, RackPose
from gearcad.geometry.inspection import Inspection, RackInspection
from gearcad.geometry.involute import inverse_involute, involute
from gearcad.geometry.modification import FlankForm, FlankModification, ReliefShape
from gearcad.geometry.pair import GearPair
from gearcad.geometry.pair_data import (
    CommonWidth,
    ShiftSplit,
    profile_shift_sum,
    specific_sliding,
    split_profile_shift,
    zero_backlash_centre_distance,
)
from gearcad.geometry.path_of_contact import BaseTangent, ContactLineLengths, ContactZone, PathOfContact
from gearcad.geometry.profile import InternalProfile, ToothProfile
from gearcad.geometry.rack import Rack, RackProfile
from gearcad.geometry.rack_pair import RackPair
from gearcad.geometry.spline import SplineJoint
from gearcad.geometry.spline_inputs import HubInputs, ShaftInputs

__all__ = [
    "ISO53_A",
    "ISO53_B",
    "ISO53_C",
    "ISO53_D",
    "NAMED_RACKS",
    "BaseTangent",
    "BasicRack",
    "Body",
    "CommonWidth",
    "ContactLineLengths",
    "ContactZone",
    "DoubleHelix",
    "FlankForm",
    "FlankModification",
    "Gear",
    "GearPair",
    "HubInputs",
    "HubSide",
    "Inspection",
    "InternalProfile",
    "PathOfContact",
    "Pose",
    "Rack",
    "RackInspection",
    "RackPair",
    "RackPose",
    "RackProfile",
    "ReliefShape",
    "ShaftInputs",
    "ShaperCutter",
    "ShiftSplit",
    "SplineJoint",
    "ToothProfile",
    "inverse_involute",
    "involute",
    "profile_shift_sum",
    "specific_sliding",
    "split_profile_shift",
    "zero_backlash_centre_distance",
]
