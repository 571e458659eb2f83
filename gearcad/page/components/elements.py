"""Elements of the page, one for each script of this folder: they draw in the browser and compute no gear."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from nicegui import ui
from nicegui.element import Element
from nicegui.events import GenericEventArguments

from gearcad.page.words import PageWords


class BarView(Element, component="gear_bar.js"):
    """Bar with the list of keys and a switch for light or dark. The browser remembers the choice, else the system decides."""

    def __init__(self, words: PageWords) -> None:
        super().__init__()
        self._props["keys"] = list(_keys(words).items())
        own = {"dark": words["light or dark"], "keys": words["keys"], "close": words["close"]}
        self._props["words"] = own | {"print": words["print what is on the right as a report"]}


def _keys(words: PageWords) -> dict[str, str]:
    """Return the effect of each key of the keyboard, in the language of the page."""
    return {
        "/": words["find a key"],
        "Enter": words["next field, with Shift the one before; on a row of data: put on top"],
        "↑ ↓": words["step a number, with Shift by ten; walk rows of data"],
        "Esc": words["leave a field or a menu; Tab then leaves the text, too"],
        "Ctrl+S": words["save to the file that is open"],
        "Ctrl+Z": words["undo"],
        "Ctrl+Y": words["redo"],
        "Tab": words["from part to part of the page"],
        "?": words["these keys"],
    }


THREE = ui.scene
"""Element whose package of three.js the script of this element imports."""


class BodiesView(
    Element, component="gear_bodies.js", esm={"gear-surfaces": "surfaces", "gear-colours": "colours", "gear-units": "units"}
):
    """Bodies, whose surfaces are sent once as long as they are seen; `label` says to those who cannot see it what it is."""

    def __init__(self, label: str, words: dict[str, str]) -> None:
        super().__init__()
        self._props["label"], self._props["words"] = label, words

    def show(
        self, number: int, bodies: Sequence[dict[str, Any]], surfaces: Mapping[str, bytes], error: float, why_not: str
    ) -> None:
        """Show bodies, or say why there are none; `number` is higher each time, `error` that of the surfaces (mm).

        `surfaces` are those that the bodies before have not had. They are sent as they are, and not as text of a script.
        """
        sent = {"number": number, "bodies": bodies, "surfaces": surfaces, "error": error, "whyNot": why_not}
        self.client.outbox.enqueue_message("gear_bodies", sent, self.client.id)

    def colour(self, kinds: Sequence[Mapping[str, Any]]) -> None:
        """Colour teeth by kinds of stress, of which the browser chooses one; by none of them bodies have no colours."""
        self.client.outbox.enqueue_message("gear_colours", {"kinds": list(kinds)}, self.client.id)


CHARTS = ui.echart
"""Element whose package of ECharts the script of the results imports, once there is a chart to draw."""


class ResultsView(Element, component="gear_results.js", esm={"gear-colours": "colours", "gear-units": "units"}):
    """Curves and patterns of a run: calls `choose(number)` with the run to show; `words` are the page's own."""

    def __init__(self, choose: Callable[[int], None], words: dict[str, str]) -> None:
        super().__init__()
        self._props["words"] = words
        self.on("choose", lambda event: choose(int(event.args.get("number", -1))))

    def show(self, **state: Any) -> None:
        """Show `choices` of runs, the number of the `chosen` one and whether it is `stale`; its `views` and its `result`."""
        self.run_method("show", state)


class LegendView(Element, component="gear_legend.js", esm={"gear-colours": "colours"}):
    """Colour bars over a `place`, "section" or "bodies": the browser tells it which."""

    def __init__(self, place: str, words: dict[str, str]) -> None:
        super().__init__()
        self._props["place"], self._props["words"] = place, words


class ModificationsView(Element, component="gear_modifications.js", esm={"gear-units": "units"}):
    """Diagrams of flanks with handles: calls `drawn` with role, values, step and whether a handle moves, and `released`."""

    def __init__(self, drawn: Callable[[Mapping[str, Any]], None], released: Callable[[], None], words: dict[str, str]) -> None:
        super().__init__()
        self._props["words"] = words
        self.on("drawn", lambda event: self._take(event, drawn))
        self.on("released", lambda _: released())

    def _take(self, event: GenericEventArguments, drawn: Callable[[Mapping[str, Any]], None]) -> None:
        """Take what was drawn, and tell the browser that the next may come."""
        if isinstance(event.args, dict):
            drawn(event.args)
        self.run_method("heard")

    def show(self, content: dict[str, Any] | None, before: dict[str, Any] | None) -> None:
        """Show the flanks of both gears and the transmission error, with that `before` the last step."""
        self.run_method("show", content, before)


class FilesView(Element, component="gear_files.js"):
    """Calls `asked(what, told)`; files that are opened go to `address`. `words` are the page's own.

    The address of the page has `tab`, by which the server finds the steps of a page that is loaded again.
    """

    def __init__(self, asked: Callable[[str, Mapping[str, Any]], None], address: str, tab: str, words: dict[str, str]) -> None:
        super().__init__()
        self._props["words"], self._props["address"], self._props["tab"] = words, address, tab
        self.on("asked", lambda event: asked(str(event.args.get("what")), event.args))

    def show(self, **state: Any) -> None:
        """Show a state of the menu.

        Keys of the state are `specs`, `tables`, `starters` and `makes`; `making`, `saved` or `taken`; and `line`, the message
        of a fault. `file` is the name of the file that is open, `unsaved` whether it has another text.
        """
        self.run_method("show", state)

    def open(self) -> None:
        """Open the menu, because it has a question or says what is wrong."""
        self.run_method("open")

    def leave_for(self, address: str) -> None:
        """Open another page of this server in place of this one, without a question."""
        self.run_method("leaveFor", address)

    def close(self) -> None:
        """Close the menu, so that the chosen content is visible."""
        self.run_method("close")

    def follow(self, link: str) -> None:
        """Put the link of the design into the address; "" if there can be none."""
        self.run_method("follow", link)


CHART = ui.echart
"""Element whose package of ECharts a browser fetches when the first chart is drawn."""

EDITOR = ui.codemirror
"""The element whose package of CodeMirror the script of the text imports."""


class _Typed(Element):
    """An element whose changes come with numbers: each is taken once and in order, and answered with the last number."""

    def __init__(self, typed: Callable[[dict[str, Any]], None], step: Callable[[bool], None]) -> None:
        super().__init__()
        self._heard = 0
        self.on("typed", lambda event: self._hear(event, typed))
        self.on("step", lambda event: self._hear(event, lambda change: step(bool(change["forth"]))))

    def _hear(self, event: GenericEventArguments, take: Callable[[dict[str, Any]], None]) -> None:
        """Accept the change if its number is the next one; the browser sends a change again until it is answered."""
        if int(event.args["number"]) == self._heard + 1:
            self._heard += 1
            take(event.args)
        self.run_method("hear", self._heard)

    def show(self, state: dict[str, Any]) -> None:
        """Show a state in which all changes are that have come."""
        self.run_method("show", state | {"heard": self._heard})


class TextView(_Typed, component="spec_text.js", esm={"gear-changes": "changes"}):
    """The text of a spec: calls `written(text, step)` with the text after typing, and `step(forth)` for keys that undo or redo.

    `show` takes a `text`, and the number of the `line` that is wrong, if there is one.
    """

    def __init__(self, written: Callable[[str, int], None], step: Callable[[bool], None], label: str) -> None:
        super().__init__(lambda change: written(str(change["text"]), int(change["step"])), step)
        self._props["label"] = label


class InputsView(_Typed, component="spec_inputs.js", esm={"gear-changes": "changes", "gear-symbols": "symbols"}):
    """Fields of a spec: calls `changed(key, text, step)` with what is typed, `hold(what)` for a switch, and `step(forth)` for
    keys that undo or redo.

    `words` are those of the fields, in the language of the page. `show` takes what is `given` and `used` under which key, which
    keys have `changed`, and the `faults`; with `reveal` what has changed comes into sight, and drafts go. `ranked` are the rows
    that come first, `holds` the switches with a `note`, and `why` the reasons of what follows from other inputs.
    """

    def __init__(
        self,
        changed: Callable[[str, str, int], None],
        hold: Callable[[str], None],
        step: Callable[[bool], None],
        words: dict[str, str],
    ) -> None:
        super().__init__(lambda change: changed(str(change["key"]), str(change["text"]), int(change["step"])), step)
        self.on("hold", lambda event: hold(str(event.args.get("what"))))
        self._props["words"], self._props["tables"] = words, []

    def have(self, tables: list[dict[str, Any]]) -> None:
        """Make input fields of the tables of a kind of design, as `gearcad.page.fields` describes them."""
        self._props["tables"] = tables
        self.update()


class LimitsView(Element, component="gear_limits.js"):
    """Calls `moved` with new values by the places of their variables. `words` are its own, in the language of the page."""

    def __init__(self, moved: Callable[[Mapping[int, float]], None], words: dict[str, str]) -> None:
        super().__init__()
        self._props["words"] = words
        self.on("moved", lambda event: moved(_numbers(event.args)))

    def show(self, state: dict[str, Any]) -> None:
        """The `variables`, those across and up first; and `limits`, where they are other than before."""
        self.run_method("show", state)


def _numbers(said: Mapping[str, Any]) -> dict[int, float]:
    """Return the finite numbers that the browser sent, by their integer keys."""
    found = {int(at): float(value) for at, value in said.items() if str(at).isdigit() and isinstance(value, int | float)}
    return {at: value for at, value in found.items() if math.isfinite(value)}


class RollView(Element, component="gear_roll.js"):
    """A slider of the roll angle over some pitches, and a button that lets the gears turn.

    Views on the window hear the event `gear-turn`, whose `detail.turn` is how far the first gear is turned (rad).
    """

    def __init__(self, words: dict[str, str]) -> None:
        super().__init__()
        self._props["words"] = words

    def show(self, pitch: float) -> None:
        """Roll by pitches of so many radians of the first gear; by none nothing turns."""
        self.run_method("show", pitch)


class RunsView(Element, component="gear_runs.js", esm={"gear-symbols": "symbols"}):
    """Calls `start(kind)` and `cancel(number)`; `words` are the page's own."""

    def __init__(self, start: Callable[[str], None], cancel: Callable[[int], None], words: dict[str, str], limits: str) -> None:
        super().__init__()
        self._props["words"], self._props["limits"] = words, limits
        self.on("start", lambda event: start(str(event.args.get("kind"))))
        self.on("cancel", lambda event: cancel(int(event.args.get("number", -1))))

    def show(self, **state: Any) -> None:
        """`kinds` that can be started, `runs` in their order, `stale` numbers, `tables` of figures, a fault's `line`."""
        self.run_method("show", state)

    def tell(self, number: int, told: dict[str, Any]) -> None:
        """Report the progress of a run to the browser."""
        self.run_method("tell", number, told)


class DrawingView(Element, component="gear_drawing.js"):
    """Sheets of a drawing as pictures; calls `make` for a file with all of them, and `speak` with the code of the language that
    is chosen for them. `words` are its own.
    """

    def __init__(self, make: Callable[[], None], speak: Callable[[str], None], words: dict[str, Any]) -> None:
        super().__init__()
        self._props["words"] = words
        self.on("pdf", make)
        self.on("language", lambda event: speak(str(event.args.get("code", ""))))

    def show(self, sheets: Sequence[Mapping[str, Any]], why_not: str, language: str) -> None:
        """Show sheets, each with its `name`, `title`, `paper` and `svg`, in a language, or say why there are none."""
        self.run_method("show", list(sheets), why_not, language)

    def wait(self) -> None:
        """Tell that what is shown is of an older design."""
        self.run_method("wait")


class CompareView(Element, component="gear_compare.js", esm={"gear-symbols": "symbols"}):
    """A table of designs; calls `swap(place)` and `let_go(place)` for those that are kept. `words` are its own."""

    def __init__(self, swap: Callable[[int], None], let_go: Callable[[int], None], words: dict[str, str]) -> None:
        super().__init__()
        self._props["words"] = words
        self.on("swap", lambda event: swap(int(event.args.get("at", -1))))
        self.on("go", lambda event: let_go(int(event.args.get("at", -1))))

    def show(self, names: Sequence[str], rows: Sequence[Mapping[str, Any]]) -> None:
        """Show designs by their `names`, the edited one first, and `rows` of what differs, a cell for each of them."""
        self.run_method("show", list(names), list(rows))

    def wait(self) -> None:
        """Tell that what is shown is of an older design."""
        self.run_method("wait")


class SectionToolsView(Element, component="gear_handles.js", esm={"gear-units": "units"}):
    """Handles and measures in the section: calls `choose` with mode, body and size, `drawn` with key, value and step."""

    def __init__(
        self,
        choose: Callable[[Mapping[str, Any]], None],
        drawn: Callable[[Mapping[str, Any]], None],
        words: dict[str, str],
    ) -> None:
        super().__init__()
        self._props["words"] = words
        for name, take in (("choose", choose), ("drawn", drawn)):
            self.on(name, lambda event, take=take: take(event.args) if isinstance(event.args, dict) else None)

    def show(self, content: dict[str, Any]) -> None:
        """Show what the mode asks for."""
        self.run_method("show", content)


class SectionView(Element, component="gear_section.js", esm={"gear-units": "units"}):
    """Draws what `gearcad.page.panels.drawn_data` finds; `label` says to those who cannot see it what it is."""

    def __init__(self, label: str, words: dict[str, str]) -> None:
        super().__init__()
        self._props["label"], self._props["words"] = label, words

    def show(self, content: dict[str, Any] | None, kept: dict[str, Any] | None) -> None:
        self.run_method("show", content, kept)

    def clear_content(self) -> None:
        """Show neither a section nor the reason why there is none."""
        self.run_method("clear")


class SharesView(Element, component="gear_shares.js"):
    """Shows what `gearcad.page.panels.views` finds, and nothing where that is nothing."""

    def __init__(self, words: dict[str, str]) -> None:
        super().__init__()
        self._props["words"] = words

    def show(self, content: dict[str, Any] | None) -> None:
        self.run_method("show", content)

    def wait(self) -> None:
        """Tell that what is shown is of an older design."""
        self.run_method("wait")


class SheetView(Element, component="gear_sheet.js", esm={"gear-symbols": "symbols"}):
    """Shows what `gearcad.page.panels.sheet_content` makes; `words` are the page's own, in its language.

    `store` is the name under which the browser keeps what is folded and what is pinned.
    """

    def __init__(self, label: str, store: str, words: dict[str, str]) -> None:
        super().__init__()
        self._props["label"], self._props["store"], self._props["words"] = label, store, words

    def show(self, content: dict[str, Any]) -> None:
        self.run_method("show", content)

    def wait(self) -> None:
        """Tell that what is shown is of an older design."""
        self.run_method("wait")


class TableView(Element, component="gear_table.js"):
    """Calls `choose(columns by axis)` and `opened(row)`; `words` are the page's own."""

    def __init__(
        self, choose: Callable[[Mapping[str, Any]], None], opened: Callable[[int], None], words: dict[str, str]
    ) -> None:
        super().__init__()
        self._props["words"] = words
        self.on("choose", lambda event: choose(event.args))
        self.on("open", lambda event: opened(int(event.args.get("number", 0))))

    def show(self, **state: Any) -> None:
        """The table's `name`, what is `told` of it, `columns`, those `chosen`; `heads` and `rows` of the list; a `line`."""
        self.run_method("show", state)
