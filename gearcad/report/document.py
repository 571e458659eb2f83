"""HTML documents of all reports: symbols, sentences, figures and tables in a template."""

from __future__ import annotations

import base64
import html
import io
import platform
import re
from collections.abc import Callable, Container, Iterable, Mapping
from datetime import date
from functools import cache, partial
from importlib import metadata
from itertools import count
from typing import TYPE_CHECKING, Any, NamedTuple

from gearcad.core import symbols
from gearcad.core.output import source_date
from gearcad.core.quantities import symbols_of
from gearcad.core.records import is_assumed
from gearcad.core.runtime import templates
from gearcad.core.symbols import Symbol
from gearcad.geometry import Gear, GearPair, Rack, RackPair
from gearcad.load import Load
from gearcad.material import Material, Materials, by_gear
from gearcad.mounting import Mounting
from gearcad.plots.gears import pair_inches, plot_pair, plot_rack_pair, rack_pair_inches
from gearcad.plots.paper import FIGURE_INCHES, new_figure, short
from gearcad.version import __version__

if TYPE_CHECKING:
    from jinja2 import Environment
    from markupsafe import Markup
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from gearcad.check.result import CheckResult
    from gearcad.drawing.options import DrawingOptions


_KNOWN = {
    key.rpartition(".")[2]: of.symbol
    for table in (symbols.SCUFFING, symbols.GEAR_RATING, symbols.RATING, symbols.STRENGTH)
    for key, of in table.items()
    if "_" in key and of.symbol
} | {
    "K_Bgamma": "K_Bγ",
    "F_beta_y": "F_βy",
    "q_prime": "q'",
    "epsilon_alpha": "ε_α",
    "beta_b": "β_b",
    "theta_f": "θ_f",
}
"""Symbols by the names that documents have."""

_NAME = re.compile(r"(?<!\w)[A-Za-z]+(?:_[A-Za-z0-9]+)+(?!\w)")

_KEY_OR_INDEX = re.compile(rf"(?<![\w.])((?:[a-z]+\.)*[a-z]{{2,}}[a-z0-9]*(?:_[a-z0-9]+)+)(?!\w)|{symbols.INDEX}")


def written(text: str) -> str:
    """A text in which symbols stand under the names of documents, such as sigma_Hlim, with their letters: σ_Hlim."""
    return _NAME.sub(lambda name: _KNOWN.get(name[0], name[0]), text)


def indexed(text: str) -> Markup:
    """Symbols with their indices lowered: Y_F, F_t K_A/b; names of more than one letter before "_" are keys, set as code."""
    from markupsafe import Markup, escape

    def set_off(found: re.Match[str]) -> str:
        return f"<code>{found[1]}</code>" if found[1] else f"<sub>{found[2]}</sub>"

    return Markup(_KEY_OR_INDEX.sub(set_off, str(escape(text))))


@cache
def _indexed_symbols() -> re.Pattern[str]:
    """Return the pattern of all symbols that have an index, such as K_γ and σ_H0."""
    every = {*_KNOWN.values(), "m_n"}
    tables = [each for each in vars(symbols).values() if isinstance(each, dict)]
    while tables:
        for each in tables.pop().values():
            if isinstance(each, Symbol):
                every.add(each.symbol)
            elif isinstance(each, dict):
                tables.append(each)
    known = {name.rstrip("*") for symbol in every for name in re.split(r"[ /]", symbol) if "_" in name}
    return re.compile(rf"(?<![\w.])({'|'.join(map(re.escape, sorted(known, key=len, reverse=True)))})(?![\w])")


def symbolic(text: str) -> Markup:
    """Set the known symbols of a text with their indices lowered, and nothing else: it may hold names that a user gave."""
    from markupsafe import Markup, escape

    def lowered(found: re.Match[str]) -> str:
        body, _, index = found[1].partition("_")
        return f"{body}<sub>{index}</sub>"

    return Markup(_indexed_symbols().sub(lowered, str(escape(written(text)))))


def listed(names: Iterable[str]) -> str:
    """Symbols that documents list, those of one gear under its name: planet.Y_M, ring.formula."""
    return ", ".join(map(_of_gear, dict.fromkeys(names)))


def _of_gear(name: str) -> str:
    gear, dot, symbol = name.rpartition(".")
    words = "the formulas of the root" if symbol == "formula" else written(symbol)
    return f"{words} of the {gear}" if dot else words


def sentences(template: str, macro: str, *values: object) -> str:
    """Return the text that a macro of a template makes of values: plain text with its lines joined by spaces."""
    said = str(getattr(_plain().get_template(template).module, macro)(*values))
    return re.sub(r"[ \n]*\n[ \n]*", " ", said).strip(" ")


@cache
def _plain() -> Environment:
    """Return the environment of text templates. Nothing is escaped in them: the page does that where it shows them."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    loader = FileSystemLoader(templates())
    environment = Environment(loader=loader, trim_blocks=True, lstrip_blocks=True, undefined=StrictUndefined)
    environment.filters |= {"short": _short, "to": format, "beyond": _beyond, "listed": listed}
    return environment


def _short(value: float | None) -> str:
    """A figure, or that there is none."""
    return "none" if value is None else short(value)


def _beyond(value: float, reference: float, digits: int = 1) -> str:
    """Return the percentage by which a value is above its reference, with a sign; negative if below."""
    return f"{100 * (value / reference - 1):+.{digits}f}"


_LIBRARIES = ("numpy", "scipy", "scikit-fem", "gmsh", "matplotlib")
"""Libraries on which the figures of a report rest, besides gearcad."""

_HEADING = re.compile(r"<h2>(.*?)</h2>")


_HEADING_FIELDS = (
    ("company", "owner"),
    ("department", "department"),
    ("project", "technical_reference"),
    ("number", "number"),
    ("author", "creator"),
    ("approved by", "approver"),
    ("revision", "index"),
)
"""Words of the heading and the attributes of [drawing] that they show."""


def heading(drawing: DrawingOptions | None) -> dict[str, str]:
    """Return company, project, author, revision and date of a design's [drawing] by their words, without empty ones.

    A design without [drawing] has none.
    """
    if drawing is None:
        return {}
    found = {words: str(getattr(drawing, name)) for words, name in _HEADING_FIELDS}
    return {words: value for words, value in found.items() if value} | {"date": drawing.issued}


def page_html(template: str, design_name: str, head: Mapping[str, str] | None = None, **values: Any) -> str:
    """The page without links to elsewhere: pictures and styles are inside. Its date is that of `source_date`, or today.

    `head` is the `heading` of the design; it stands above the title.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    loader = FileSystemLoader(templates())
    environment = Environment(loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=StrictUndefined)
    environment.filters |= {"short": short, "finished": _finished}
    environment.filters |= {"written": written, "indexed": indexed, "symbolic": symbolic, "listed": listed}
    fixed = source_date()
    made = {"version": __version__, "versions": _versions(), "date": (fixed.date() if fixed else date.today()).isoformat()}
    return environment.get_template(template).render(name=design_name, head=head or {}, **made, **values)


def _versions() -> list[str]:
    libraries = (f"{name} {metadata.version(name)}" for name in _LIBRARIES)
    return [f"gearcad {__version__}", f"Python {platform.python_version()}", *libraries]


def _finished(content: Markup) -> Markup:
    """The content with a name for each section, a list of them before the first, and tables that scroll by themselves."""
    from markupsafe import Markup

    sections: dict[str, str] = {}

    def named(heading: re.Match[str]) -> str:
        anchor = _anchor(heading[1], sections)
        sections[anchor] = heading[1]
        return f'<h2 id="{anchor}">{heading[1]}</h2>'

    text = _HEADING.sub(named, str(content))
    text = text.replace("<table>", '<div class="scroll"><table>').replace("</table>", "</table></div>")
    entries = "".join(f'<li><a href="#{anchor}">{title}</a></li>\n' for anchor, title in sections.items())
    before, first, rest = text.partition("<h2 id=")
    return Markup(f'{before}<nav aria-label="Contents">\n<ul>\n{entries}</ul>\n</nav>\n{first}{rest}')


def _anchor(title: str, taken: Container[str]) -> str:
    """A name for a section, made of the words of its title."""
    plain = html.unescape(re.sub(r"<[^>]*>", "", title)).lower()
    words = "-".join(re.findall(r"[a-z0-9]+", plain)) or "section"
    return next(name for number in count(1) if (name := f"section-{words}" + f"-{number}" * (number > 1)) not in taken)


_DOTS_PER_INCH = 160
"""Resolution of pictures of fields, in dots per inch; the others are lines."""

_PACKED = 4
"""Level at which zlib packs them: half the time of the usual 6, and 6 % more bytes."""


class ReportFigure(NamedTuple):
    """A figure: its title, its address (the picture itself), and what it shows in sentences."""

    title: str
    address: str
    caption: str


def pair_picture(pair: GearPair | RackPair) -> ReportFigure:
    """Return a picture of both gears, or of a pinion and a rack, in mesh."""
    if isinstance(pair, RackPair):
        address = picture_address(partial(plot_rack_pair, pair), "svg", rack_pair_inches(pair))
        return ReportFigure("The pair in mesh", address, sentences("captions_check.txt", "rack_pair", pair))
    address = picture_address(partial(plot_pair, pair), "svg", pair_inches(pair))
    return ReportFigure("The pair in mesh", address, sentences("captions_check.txt", "pair", pair))


def picture_address(draw: Callable[[Axes], Axes], kind: str, inches: tuple[float, float] = FIGURE_INCHES) -> str:
    """Return a drawing on axes as a data: URL of an "svg" or "png"."""
    return figure_address(lambda figure: draw(figure.subplots()), kind, inches)


def figure_address(draw: Callable[[Figure], object], kind: str, inches: tuple[float, float] = FIGURE_INCHES) -> str:
    """Return a drawing on a figure as a data: URL of an "svg" or "png"."""
    from matplotlib import style

    with style.context(["default", {"svg.hashsalt": "gearcad"}]):
        figure, stream = new_figure(inches), io.BytesIO()
        draw(figure)
        nothing = {"Date": None} if kind == "svg" else {"Software": None}
        packed: dict[str, Any] = {"pil_kwargs": {"compress_level": _PACKED}} if kind == "png" else {}
        figure.savefig(stream, format=kind, dpi=_DOTS_PER_INCH, metadata=nothing, **packed)
    media = {"svg": "image/svg+xml", "png": "image/png"}[kind]
    return f"data:{media};base64,{base64.b64encode(stream.getvalue()).decode('ascii')}"


_GEAR = (
    "teeth normal_module helix_angle profile_shift tip_alteration tooth_thinning face_width rack.pressure_angle rack.addendum"
    " rack.dedendum rack.root_radius reference_diameter base_diameter tip_diameter root_diameter form_diameter body.bore"
)
_PAIR = (
    "centre_distance working_transverse_pressure_angle profile_shift_sum transverse_contact_ratio common_width.width"
    " circumferential_backlash"
)

_OF_RACK = ("length", "height", "tip_height", "root_depth", "transverse_pitch")
"""Keys of what a rack has beside them."""

_RACK_PAIR = (
    "mounting_distance travel_per_revolution working_transverse_pressure_angle transverse_contact_ratio common_width.width"
    " circumferential_backlash"
)

_ROUNDING = 1e-9
"""Value below which a length or number is rounding."""


class ReportRow(NamedTuple):
    """One line of a table; `values` are those of pinion and wheel, or one for both."""

    words: str
    symbol: str
    values: tuple[str, ...]
    unit: str
    source: str


def names_of_pair(pair: GearPair | RackPair) -> list[str]:
    """Return the names of both gears: pinion and wheel, or pinion and rack."""
    return ["pinion", "rack" if isinstance(pair, RackPair) else "wheel"]


def gear_rows(pair: GearPair | RackPair, keys: str = _GEAR) -> list[ReportRow]:
    """Return the rows of both gears: their fields `keys`, and the modifications of their flanks.

    Those of a rack are its height and what it has in common with gears.
    """
    if isinstance(pair, RackPair):
        return _rack_pair_rows(pair, keys)
    gears = (pair.pinion, pair.wheel)
    values = [_flat(gear.to_dict() | {"modification": gear.flank_form.in_use}) for gear in gears]
    written = symbols_of(Gear) | symbols.GEAR
    present = [key for key in written if key.startswith("modification.") and any(key in gear for gear in values)]
    return [_row(written[key], *(gear.get(key) for gear in values)) for key in (*keys.split(), *present)]


def _rack_pair_rows(pair: RackPair, keys: str) -> list[ReportRow]:
    pinion = _flat(pair.pinion.to_dict() | {"modification": pair.pinion.flank_form.in_use})
    rack, of_rack = _flat(pair.rack.to_dict()), symbols_of(Rack) | symbols.RACK
    written = symbols_of(Gear) | symbols.GEAR | of_rack
    modified = [key for key in written if key.startswith("modification.") and key in pinion]
    every = dict.fromkeys([*keys.split(), *modified, *_OF_RACK])
    return [_row(written[key], pinion.get(key), rack.get(key)) for key in every]


def pair_rows(pair: GearPair | RackPair) -> list[ReportRow]:
    """Return the rows of the pair."""
    if isinstance(pair, RackPair):
        values, written = _flat(pair.to_dict()), symbols_of(RackPair) | symbols.PAIR | symbols.RACK_PAIR
        return [_row(written[key], values[key]) for key in _RACK_PAIR.split()]
    values = _flat(pair.to_dict())
    written = symbols_of(GearPair) | symbols.PAIR
    return [_row(written[key], values[key]) for key in _PAIR.split()]


def load_rows(material: Materials, load: Load, mounting: Mounting) -> list[ReportRow]:
    """Material and load, and the mounting where it is not that of the drawing."""
    words = symbols_of(Material)
    rows: list[tuple[Symbol, Any]] = [
        (words[key]._replace(words=f"{words[key].words}{f', {gear}' if gear else ''}"), value)
        for gear, each in by_gear(material).items()
        for key, value in vars(each).items()
    ]
    rows += [(symbols_of(Load)[key], value) for key, value in vars(load).items()]
    rows += [(symbols_of(Mounting)[key], value) for key, value in vars(mounting).items() if value]
    return [_row(symbol, value) for symbol, value in rows if value is not None]


def rating_rows(result: CheckResult) -> list[ReportRow]:
    """The rating by symbols: values of the pair, then those of each gear, then what the formulas say of a ring."""
    values = result.rating.to_dict()
    rows = [_row(symbol, values[key]) for key, symbol in symbols.RATING.items()]
    gears = [values[name] for name in result.names]
    # A rack lacks what the standard has of circles.
    rows += [_row(symbol, *(gear.get(key) for gear in gears)) for key, symbol in symbols.GEAR_RATING.items()]
    if formula := gears[1].get("formula"):
        rows += [_row(symbol, None, formula[key]) for key, symbol in symbols.RING_FORMULA.items()]
    return rows


def _row(symbol: symbols.Symbol, *values: Any) -> ReportRow:
    unit = {"deg": "°"}.get(symbol.unit, symbol.unit)
    return ReportRow(symbol.words, symbol.symbol, tuple(_text(value) for value in values), unit, symbol.source)


def _text(value: Any) -> str:
    if isinstance(value, tuple | list):
        return " to ".join(_text(each) for each in value)
    if isinstance(value, bool) or not isinstance(value, int | float):
        text = "-" if value is None else str(value)
    else:
        text = _plain_number(value) if abs(value) > _ROUNDING else "0"
    return f"{text} (assumed)" if is_assumed(value) else text


def _plain_number(value: float) -> str:
    """Return a number with six significant digits; great and small ones as `short` has them."""
    return f"{value:.6g}" if 1e-4 <= abs(value) < 1e4 else short(value, 6)


def _flat(document: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key, value in document.items():
        found |= _flat(value, f"{prefix}{key}.") if isinstance(value, Mapping) else {prefix + key: value}
    return found
