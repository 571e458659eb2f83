"""The data sheet of a feature as a spreadsheet, and its drawings as pages of TechDraw."""

import re
import tempfile
from enum import Enum
from pathlib import Path

import FreeCAD
from gearcad_features import design_of
from gearcad_packages import prepare

_LINK = "Of"
"""Property that links a spreadsheet or page to its feature."""

_UNITS = {"mm": "mm", "deg": "deg"}
"""Units of gearcad that FreeCAD's spreadsheets calculate with, by their names there."""

_TEMPLATES = Path("Mod", "TechDraw", "Templates")
_SVG_UNITS = 96 / 25.4
"""Units of an SVG in one mm of a page of TechDraw."""


def add_data_sheet(feature):
    """Return the spreadsheet with the data sheet of a feature; one that is there is filled again.

    Columns: quantity, symbol, unit, a text for each gear as `gearcad data` shows it, source; then the numbers with all digits.
    The numbers have aliases such as `pinion_tip_diameter` for expressions. Raises ValueError, one line, for wrong input.
    """
    prepare()
    from gearcad.sheet import sheet_of

    content = sheet_of(design_of(feature))
    sheet = next(iter(_linked(feature, "Spreadsheet::Sheet")), None)
    if sheet is None:
        sheet = feature.Document.addObject("Spreadsheet::Sheet", "DataSheet")
        sheet.Label = f"Data sheet of {feature.Label}"
    sheet.clearAll()  # takes added properties, too
    _link(sheet, feature)
    widest = max(len(section.columns) or 1 for section in content.sections)
    writer = _SheetWriter(sheet, widest)
    writer.fill(content)
    sheet.recompute()
    return sheet


class _SheetWriter:
    """Cells of a spreadsheet, written row by row; `widest` is the greatest number of columns with values."""

    def __init__(self, sheet, widest):
        self.sheet = sheet
        self.widest = widest
        self.row = 0
        self.aliases = set()

    def fill(self, content):
        """Write a data sheet of gearcad."""
        self._line(f"{content.name}: {content.title}")
        self._line("; ".join(filter(None, [content.units, content.clauses])))
        for section in content.sections:
            for block in section.blocks:
                self.row += 1
                blanks = [""] * (self.widest - len(section.columns))
                self._texts(block.title, "", "", *section.columns, *blanks, "", *section.columns, bold=True)
                for row in block.rows:
                    self._quantity(row, section.columns)
        if content.notices:
            self.row += 1
            self._texts("Notices", bold=True)
            for notice in content.notices:
                self._line(str(notice))
        widths = [300, 60, 60, *[100] * self.widest, 100, *[100] * self.widest]
        for number, width in enumerate(widths):
            self.sheet.setColumnWidth(_letter(number), width)

    def _texts(self, *texts, bold=False):
        """Write a row of texts."""
        self.row += 1
        for number, text in enumerate(texts):
            if text:
                self.sheet.set(f"{_letter(number)}{self.row}", f"'{text}")
        if bold:
            self.sheet.setStyle(self._whole_row(), "bold")

    def _line(self, text):
        """Write a text over all columns."""
        self._texts(text)
        self.sheet.mergeCells(self._whole_row())

    def _whole_row(self):
        return f"A{self.row}:{_letter(3 + 2 * self.widest)}{self.row}"

    def _quantity(self, row, columns):
        texts = [text.value if isinstance(text, Enum) else str(text) for text in row.texts]
        blanks = [""] * (self.widest - len(texts))
        self._texts(row.symbol.words, row.symbol.symbol, row.symbol.unit, *texts, *blanks, row.symbol.source)
        for number, value in enumerate(row.values):
            if isinstance(value, bool) or not isinstance(value, int | float):
                continue
            cell = f"{_letter(4 + self.widest + number)}{self.row}"
            unit = _UNITS.get(row.symbol.unit)
            value = value or 0  # -0.0
            self.sheet.set(cell, f"={value!r} {unit}" if unit else f"={value!r}")
            alias = self._alias(row.key, columns[number] if columns else "")
            if alias not in self.aliases:
                self.aliases.add(alias)
                self.sheet.setAlias(cell, alias)

    @staticmethod
    def _alias(key, column):
        """Return a name such as "pinion_tip_diameter" for a key such as "gear.tip_diameter"."""
        of, _, quantity = key.partition(".")
        words = f"{column or of}.{quantity}" if quantity else key
        return "".join(letter if letter.isascii() and letter.isalnum() else "_" for letter in words)


def add_drawing(feature):
    """Return the pages of TechDraw with the drawings of a feature, as `gearcad draw` makes them; they replace earlier ones.

    Raises ValueError, one line, for wrong input or without room, and ImportError where a package for drawings is missing.
    """
    prepare(drawings=True)
    from gearcad.core.errors import GearcadError
    from gearcad.jobs.draw import Draw, paper_of

    job = Draw(formats=("svg",))
    with tempfile.TemporaryDirectory() as folder:
        try:
            drawing = job.run(design_of(feature))
            files = [file for file in job.write(drawing, folder) if file.suffix == ".svg"]
        except GearcadError as error:
            raise ValueError(str(error)) from None
        texts = [file.read_text(encoding="utf-8") for file in files]
    document = feature.Document
    for page in _linked(feature, "TechDraw::DrawPage"):
        for each in [*page.Views, page.Template]:
            document.removeObject(each.Name)
        document.removeObject(page.Name)
    return [_page(feature, sheet, paper_of(sheet), text) for sheet, text in zip(drawing.sheets, texts, strict=True)]


def _page(feature, sheet, paper, text):
    """Return a new page with one sheet as a symbol; `paper` is the name of its size."""
    document = feature.Document
    page = document.addObject("TechDraw::DrawPage", "Drawing")
    _link(page, feature)
    page.Label = f"Drawing of {feature.Label}, {sheet.name}"
    template = document.addObject("TechDraw::DrawSVGTemplate", "Template")
    lies = "Portrait" if paper == "A4" else "Landscape"
    template.Template = str(Path(FreeCAD.getResourceDir()) / _TEMPLATES / f"{paper}_{lies}_blank.svg")
    page.Template = template
    symbol = document.addObject("TechDraw::DrawViewSymbol", "Sheet")
    symbol.Symbol = _in_svg_units(text, sheet.size)
    page.addView(symbol)
    symbol.ScaleType = "Custom"
    symbol.Scale = 1.0
    symbol.X, symbol.Y = (side / 2 for side in sheet.size)
    return page


def _in_svg_units(text, size):
    """Return an SVG whose width and height have no unit: what TechDraw makes of mm is up to the version of Qt."""
    for name, side in zip(("width", "height"), size, strict=True):
        text = re.sub(rf'(<svg[^>]* {name}=")[^"]*"', rf'\g<1>{side * _SVG_UNITS:.4f}"', text, count=1)
    return text


def _linked(feature, kind):
    """Return the objects of a kind of FreeCAD that belong to a feature."""
    return [each for each in feature.Document.Objects if each.TypeId == kind and getattr(each, _LINK, None) is feature]


def _link(made, feature):
    if not hasattr(made, _LINK):
        made.addProperty("App::PropertyLinkHidden", _LINK, "gearcad", "the feature that this describes")
    setattr(made, _LINK, feature)


def _letter(number):
    """Return the name of a column of a spreadsheet, counted from 0."""
    return (chr(64 + number // 26) if number >= 26 else "") + chr(65 + number % 26)
