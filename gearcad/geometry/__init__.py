"""Exact geometry of cylindrical gears: numpy, and scipy inside functions. Lengths in mm, angles in degrees."""

from gearcad.geometry.basic_rack import ISO53_A, ISO53_B, ISO53_C, ISO53_D, NAMED_RACKS, BasicRack
from gearcad.geometry.body import Body, HubSide
from gearcad.geometry.cutter import ShaperCutter
from gearcad.geometry.double_helix import DoubleHelix
from gearcad.geometry.gear import Gear
from gearcad.geometry.inspection import Inspection
from gearcad.geometry.internal_profile import InternalProfile
from gearcad.geometry.involute import inverse_involute, involute
from gearcad.geometry.modification import FlankForm, FlankModification, ReliefShape
from gearcad.geometry.pair import GearPair
from gearcad.geometry.pair_data import CommonWidth
from gearcad.geometry.path import BaseTangent, ContactLineLengths, ContactZone, PathOfContact
from gearcad.geometry.pose import Pose, RackPose
from gearcad.geometry.profile import ToothProfile
from gearcad.geometry.rack import Rack
from gearcad.geometry.rack_inspection import RackInspection
from gearcad.geometry.rack_pair import RackPair
from gearcad.geometry.rack_profile import RackProfile
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
    "ShaperCutter",
    "ShiftSplit",
    "ToothProfile",
    "inverse_involute",
    "involute",
    "profile_shift_sum",
    "specific_sliding",
    "split_profile_shift",
    "zero_backlash_centre_distance",
]
