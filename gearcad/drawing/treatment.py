"""What a part is made of and how it is hardened, in the words of a sheet."""

from __future__ import annotations

from gearcad.drawing.options import DrawingOptions
from gearcad.drawing.subject import DrawnGear
from gearcad.drawing.words import Words
from gearcad.material import Material, MaterialGroup, grade_of
from gearcad.schema import is_assumed

__all__ = ["material_text", "treatment_text"]

_BRINELL = (
    MaterialGroup.STRUCTURAL_STEEL,
    MaterialGroup.CAST_STEEL,
    MaterialGroup.NODULAR_IRON,
    MaterialGroup.FERRITIC_NODULAR_IRON,
    MaterialGroup.MALLEABLE_IRON,
    MaterialGroup.GREY_IRON,
)
"""Groups whose hardness ISO 6336-5 has in HBW, all others' in HV."""

_IRON = _BRINELL[2:]
"""Groups of cast iron: an unnamed material has their name."""

_STEEL = Material().name
"""The name of a material that nobody named."""


def material_text(drawn: DrawnGear, options: DrawingOptions, words: Words) -> str:
    """As the sheet shall name it, else the name of the material; "" where nothing is known.

    Without a name it is what the group says, and steel is said to be assumed where there is no group either.
    """
    if options.material is not None:
        return options.material
    material = drawn.material
    if material is None:
        return ""
    if not is_assumed(material.name) and material.name != _STEEL and grade_of(material.name) is None:
        return material.name
    if material.group in _IRON:
        return words[f"data.group_{material.group.name.lower()}"]
    unknown = material.group is None and is_assumed(material.name)
    return f"{words['data.steel']} ({words['data.assumed']})" if unknown else words["data.steel"]


def treatment_text(drawn: DrawnGear, options: DrawingOptions, words: Words) -> str:
    """As it was given, else what the group of the material is, and its hardness; with the depth of the case. "" if unknown."""
    text = options.heat_treatment or ("" if drawn.material is None else _of_group(drawn.material, words))
    depth = options.case_depth or ""
    if depth and not depth.upper().startswith("CHD"):
        depth = f"CHD {depth}"
    return ", ".join(filter(None, (text, depth)))


def _of_group(material: Material, words: Words) -> str:
    group = material.group
    treated = "" if group is None else words[f"data.group_{group.name.lower()}"]
    if material.hardness is None:
        return treated
    scale = "HBW" if group in _BRINELL else "HV"
    return ", ".join(filter(None, (treated, f"{words.shortest(material.hardness, 1)} {scale}")))
