"""Specs of new features, and properties: one for each key of its spec, made from gearcad's own schema of keys.

A key that is a number and always has a value is a property of that type. One that may be left out is such a property too
where 0 is outside its range; 0 then means "not given". All others are texts as a spec has them (`0.5`, `auto`); an empty
text means "not given".
"""

import tomllib

_GEAR = "[gear]\nteeth = {teeth}\nnormal_module = 2.0\nface_width = 20.0\n"
SPECS = {
    "Gear": _GEAR.format(teeth=20) + "body.bore = 12.0\n",
    "Ring": _GEAR.format(teeth=-60) + "cutter.teeth = 25\nbody.rim_diameter = 150.0\n",
    "Pair": (
        "[pair]\nnormal_module = 2.0\nface_width = 20.0\ntooth_thinning = 0.04\n\n"
        "[pinion]\nteeth = 20\nbody.bore = 12.0\n\n[wheel]\nteeth = 41\nbody.bore = 20.0\n"
    ),
    "Rack": "[rack]\nteeth = 20\nnormal_module = 2.0\nface_width = 20.0\nheight = 20.0\n",
    "Planetary": "planetary-24-21-66",
    "Spline": "spline",
}
"""The spec of a new feature by the name of its kind; a word is the name of one of gearcad's own specs."""

_TEETH = "teeth normal_module face_width helix_angle profile_shift tooth_thinning"
_PANELS = {
    "gear": f"{_TEETH} rack.pressure_angle body.bore body.keyway body.end_chamfer",
    "ring": f"{_TEETH} rack.pressure_angle cutter.teeth body.rim_diameter body.end_chamfer",
    "pair": (
        "pinion.teeth wheel.teeth normal_module face_width helix_angle centre_distance pinion.profile_shift "
        "wheel.profile_shift pinion.body.bore wheel.body.bore"
    ),
    "rack": (
        "teeth length normal_module face_width height helix_angle tip_alteration tooth_thinning rack.pressure_angle tip_chamfer"
    ),
    "rack_pair": (
        "pinion.teeth rack.teeth normal_module face_width helix_angle mounting_distance pinion.profile_shift tooth_thinning "
        "rack.height pinion.body.bore"
    ),
    "planetary": (
        "sun.teeth planet.teeth ring.teeth planets normal_module face_width helix_angle sun.profile_shift "
        "planet.profile_shift ring.body.rim_diameter"
    ),
    "spline": (
        "designation standard nominal_diameter module teeth pressure_angle centring length shaft.bore hub.outer_diameter"
    ),
}
"""The ten keys in the task panel of each kind of feature; those without a table are of the main table."""

_LEFT_OUT = ("drawing", "making", "material", "pre_stage", "premachining", "carrier", "speeds")
"""Parts of tables without properties: a spec that has them keeps them."""

_NEVER_ZERO = (
    "centre_distance",
    "mounting_distance",
    "tip_diameter",
    "root_diameter",
    "normal_module",
    "normal_diametral_pitch",
)
"""Keys whose range may hold 0, which means "not given" all the same."""

_TAKEN = ("Angle", "Content", "Document", "Label", "Module", "Name", "Placement", "Proxy", "Root", "Shape", "Spec", "State")
"""Names that FreeCAD, or the workbench itself, gives something else."""

_OF_UNITS = {"mm": "App::PropertyDistance", "deg": "App::PropertyAngle"}


class Key:
    """One key of a spec and its property: `table` and `key` with dots, the `field` of the schema.

    `own` is whether the table is another than the main one of its kind.
    """

    def __init__(self, table, key, field, main):
        self.dotted = f"{table}.{key}"
        self.field = field
        self.own = table != main
        self.group = ".".join([table, *key.split(".")[:-1]])
        words = [] if table == main else table.split("_")
        words += [word for part in key.split(".") for word in part.split("_")]
        self.name = "".join(word[:1].upper() + word[1:] for word in words)
        if self.name in _TAKEN:
            self.name = f"Design{self.name}"
        self.shared = table in ("pinion", "wheel", "sun", "planet", "ring", "planet_2", "sun_2", "ring_2") or (
            table in ("pair", "planetary") and table == main
        )
        self.type = self._type()

    def _type(self):
        field = self.field
        numeric = field.members[0] in (int, float) and not (field.words or field.several or field.nested)
        if field.choices is not None and not field.optional and not self.shared:
            return "App::PropertyEnumeration"
        if field.switch and not self.shared:
            return "App::PropertyBool"
        if not numeric or not (field.required or self.zero_is_absent or not (field.optional or self.shared)):
            return "App::PropertyString"
        if field.whole:
            return "App::PropertyInteger"
        return _OF_UNITS.get(field.symbol.unit, "App::PropertyFloat")

    @property
    def zero_is_absent(self):
        """Whether a property of 0 means that the key is not given."""
        if self.field.required:
            return False
        if self.field.name in _NEVER_ZERO or (self.field.name == "face_width" and self.shared):
            return True
        permitted = self.field.permitted
        least, ends = getattr(permitted, "least", None), getattr(permitted, "ends", "[]")
        if not self.field.optional or self.field.whole or least is None or permitted.may_vanish or permitted.signed:
            return False
        return least > 0 or (least == 0 and ends[0] == "(")

    @property
    def tooltip(self):
        """Words, symbol, unit and range of the key, and what stands for "not given"."""
        symbol, permitted = self.field.symbol, self.field.permitted
        said = [f"{self.dotted}: {symbol.words}" if symbol.words else self.dotted]
        said += [f"symbol {symbol.symbol}"] if symbol.symbol else []
        said += [f"unit {symbol.unit}"] if symbol.unit else []
        least, most = (getattr(permitted, end, None) for end in ("least", "most"))
        if least is not None or most is not None:
            low, high = ("any" if end is None else f"{end:g}" for end in (least, most))
            said.append(f"permitted {low} to {high}")
        if negative := getattr(permitted, "negative", None):
            said.append(f"or {-permitted.most} to {negative[0]} ({negative[1]})")
        said += [f"one of {', '.join(permitted.words)}"] if hasattr(permitted, "words") else []
        said += [f"or {', '.join(self.field.words)}"] if self.field.words else []
        if self.type == "App::PropertyString":
            said.append("empty: not given")
        elif self.zero_is_absent:
            said.append("0: not given")
        return "; ".join(said)

    def shown(self, tables):
        """Return the value of the property for the tables of a spec."""
        inner = tables
        for word in self.dotted.split("."):
            inner = inner.get(word) if isinstance(inner, dict) else None
        if isinstance(inner, dict):  # rack = "ISO53_A" beside rack.addendum
            inner = None
        if self.type == "App::PropertyString":
            return "" if inner is None else inner if isinstance(inner, str) else _toml(inner)
        if inner is None:
            default = getattr(self.field.default, "value", self.field.default)
            return 0 if self.field.required or self.zero_is_absent else default
        return inner if self.type in ("App::PropertyEnumeration", "App::PropertyBool") else self._number(inner)

    def _number(self, value):
        if isinstance(value, str) or isinstance(value, list):
            raise ValueError(f"{self.dotted} = {value}: a property of FreeCAD holds a number here")
        return int(value) if self.field.whole else float(value)

    def given(self, value):
        """Return the value in a spec for that of the property; None for a key that is not given.

        The value alone decides, since the property of a document of an earlier version can have another type.
        """
        value = getattr(value, "Value", value)
        if not isinstance(value, str):
            return None if self.zero_is_absent and value == 0 else value
        value = value.strip()
        if not value or (self.field.text and not self.field.texts):
            return value or None
        try:
            return tomllib.loads(f"value = {value}")["value"]
        except tomllib.TOMLDecodeError:
            return value


def _toml(value):
    """Return a value as a spec has it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return f"[{', '.join(map(_toml, value))}]"
    return f'"{value}"' if isinstance(value, str) else repr(value)


def keys_of(tables):
    """Return the keys with properties of the kind of design that the tables of a spec describe."""
    from gearcad.designs.keys import FIELDS, MAIN_TABLES, OF_SETS, DesignKind
    from gearcad.designs.reader import kind_of

    kind = kind_of(tables)
    main = MAIN_TABLES[kind][0]
    if kind is DesignKind.PLANETARY:
        from gearcad.designs.train_keys import PLANETARY

        fields, shown = PLANETARY, (main, *(each for each in OF_SETS if each in tables))
    else:
        fields, shown = FIELDS, MAIN_TABLES[kind]
    found, names = [], set()
    for table in shown:
        for key, field in fields[table].items():
            if key.partition(".")[0] in _LEFT_OUT:
                continue
            made = Key(table, key, field, main)
            if made.name not in names:
                names.add(made.name)
                found.append(made)
    return found


def panel_kind(tables):
    """Return the word for the kind of design that the tables of a spec describe: "gear", "ring", "pair" and so on."""
    from gearcad.designs.reader import kind_of

    kind = kind_of(tables).value
    return "ring" if kind == "gear" and tables["gear"].get("teeth", 1) < 0 else kind


def panel_keys(tables):
    """Return the ten keys in the task panel of the kind of design that the tables of a spec describe."""
    from gearcad.designs.keys import MAIN_TABLES
    from gearcad.designs.reader import kind_of

    main = MAIN_TABLES[kind_of(tables)][0]
    by_name = {key.dotted: key for key in keys_of(tables)}
    found = [by_name.get(f"{main}.{key}") or by_name.get(key) for key in _PANELS[panel_kind(tables)].split()]
    return [key for key in found if key is not None]
