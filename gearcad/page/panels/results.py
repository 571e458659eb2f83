"""Panel of results: curves, patterns and colours of a check or of the dynamics, from the run that made them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from gearcad.core.records import JsonObject, Role
from gearcad.designs.design import Design
from gearcad.designs.planetary_designs import PlanetaryDesign
from gearcad.page.components.elements import LegendView, ResultsView
from gearcad.page.panels.drawn_data import section_of
from gearcad.page.panels.sheet_content import called
from gearcad.page.run_process import ANALYSES
from gearcad.page.runs import Run, Runs, RunState
from gearcad.page.shown_results import read_shown
from gearcad.page.words import PageWords
from gearcad.page.workbench import Workbench

_MOST_CHOICES = 12
"""Runs among which the user can choose, the newest ones."""

_TEXT = {"fontSize": 13, "color": "var(--ink)", "fontFamily": "system-ui, sans-serif"}
_LINES = ("var(--accent)", "var(--pinion)", "var(--kept)", "var(--passed)", "var(--wrong)")


class ResultsPanel:
    """Follows the workbench and its runs: of the newest run of the present inputs, else of a former one, which is marked.

    Colours stand on section and bodies only as long as these are those of the run. `colour` takes the coloured teeth of bodies,
    `called_run` gives the name of a run.
    """

    def __init__(self, bench: Workbench, words: PageWords, colour: Callable[[Sequence[Mapping[str, Any]]], None]) -> None:
        self._bench, self._words, self._colour = bench, words, colour
        self._runs: Runs | None = None
        self._called_run: Callable[[Run], str] = lambda run: run.asked.kind
        self._picked: tuple[int, str] | None = None
        self._shown: int | None = None
        self._state: dict[str, Any] = {}
        self._coloured = False
        self._content: JsonObject | None = None
        self._view: ResultsView | None = None

    def place(self) -> None:
        """Make the curves and patterns here."""
        self._view = ResultsView(self._choose, _own(self._words))

    def use(self, runs: Runs, called_run: Callable[[Run], str]) -> None:
        """Show results of these runs from now on."""
        self._runs, self._called_run = runs, called_run
        self.follow()

    def legend(self, place: str) -> None:
        """Make the colour bars over the section or the bodies."""
        own = {"title": self._words["colours on the teeth"], "none": self._words["no colours"]}
        LegendView(place, own)

    def follow(self) -> None:
        """Show the result for the present inputs, or mark the one that is shown as that of earlier ones."""
        runs = self._candidates()
        chosen = self._chosen(runs)
        state: dict[str, Any] = {
            "choices": [
                {"number": run.number, "words": self._words_of(run), "stale": self._is_stale(run)}
                for run in runs[:_MOST_CHOICES]
            ],
            "chosen": -1 if chosen is None else chosen.number,
            "stale": chosen is not None and self._is_stale(chosen),
        }
        content: dict[str, Any] = {}
        if state["chosen"] != self._shown:
            self._shown = state["chosen"]
            self._content = None if chosen is None else read_shown(chosen.folder)
            content = {"views": views_of(self._content, self._words), "result": drawn_part(self._content)}
        if self._view is not None and (state != self._state or content):
            self._state = state
            self._view.show(**state, **content)
        self._colour_bodies(afresh=bool(content))

    def _candidates(self) -> list[Run]:
        """Runs of the file that is open whose results can be shown, the newest first."""
        if self._runs is None:
            return []
        shown = [run for run in self._runs.all if run.state is RunState.DONE and run.files and ANALYSES.get(run.asked.kind)]
        kept = [run for run in shown if ANALYSES[run.asked.kind].shown is not None]
        return [run for run in reversed(kept) if run.asked.name == self._bench.name]

    def _chosen(self, runs: Sequence[Run]) -> Run | None:
        """The run to show: the one that was picked for these inputs, else one of these inputs, else the newest."""
        number, text = self._picked or (-1, "")
        picked = [run for run in runs if run.number == number and text == self._bench.text]
        present = [run for run in runs if not self._is_stale(run)]
        return next(iter((*picked, *present, *runs)), None)

    def _choose(self, number: int) -> None:
        """Show a run that the user picked, if it can be shown."""
        if any(run.number == number for run in self._candidates()[:_MOST_CHOICES]):
            self._picked = number, self._bench.text
            self.follow()

    def _is_stale(self, run: Run) -> bool:
        return run.asked.text != self._bench.text

    def _words_of(self, run: Run) -> str:
        return f"{run.number + 1}: {self._called_run(run)}"

    def _colour_bodies(self, *, afresh: bool) -> None:
        """Give teeth of bodies their colours, or take them where bodies are of other inputs."""
        content, design = self._content, self._bench.shown_design
        wanted = bool(content and content.get("teeth")) and not self._state["stale"] and design is not None
        if wanted != self._coloured or (wanted and afresh):
            self._coloured = wanted
            self._colour(coloured_kinds(content, design, self._words) if wanted and content and design else ())


def _own(words: PageWords) -> dict[str, str]:
    """Return the words that the script of the results uses."""
    return {
        "title": words["Results"],
        "choose": words["result of which run"],
        "stale": words["of earlier inputs"],
        "pressure": words["contact pressure"],
        "root": words["root tension"],
    }


def drawn_part(content: JsonObject | None) -> JsonObject | None:
    """Return what the section draws of a result, with the greatest values at which its colours end (MPa)."""
    if content is None or content["kind"] != "check":
        return None
    keys = ("model", "mesh", "side", "base", "pitch_point", "base_pitch", "contacts", "flanks", "roots")
    angles = {"roll_angle": content["curves"]["roll_angle"]}
    return {**{key: content[key] for key in keys}, "curves": angles, "limits": limits_of(content)}


def limits_of(content: JsonObject) -> dict[str, float]:
    """Return the greatest contact pressure away from edges, and the greatest root tension of both gears (MPa)."""
    summary = content["summary"]
    pressures = [pressure for pressure in content["contacts"]["pressure"] if pressure is not None]
    roots = [summary[f"root_tension_{role.value}"] for role in Role]
    return {"pressure": summary["contact_pressure"] or max(pressures, default=1.0), "root": max(roots)}


def views_of(content: JsonObject | None, words: PageWords) -> list[dict[str, Any]]:
    """Return the views of a result: key, title, a line of figures, and options of ECharts."""
    if content is None:
        return []
    if content["kind"] == "dynamics":
        return [_speed_view(content, words)]
    return [_curves_view(content, words), _flank_view(content, words)]


def _told(content: JsonObject, words: PageWords) -> str:
    """The model of a check, and its greatest figures."""
    summary, limits = content["summary"], limits_of(content)
    model = words["plane model"] if content["model"] == "2d" else words["solid bodies"]
    stress = words.unit("MPa")
    roots = " / ".join(words.number(stress.text(summary[f"root_tension_{role.value}"], 1)) for role in Role)
    figures = [
        f"{words['contact pressure']} {words.measure(limits['pressure'], 1, 'MPa')}",
        f"{words['root tension']} {words['Pinion']} / {words['Wheel']} {roots} {stress.name}",
        f"{words['transmission error, peak to peak']} {_micrometres(summary['transmission_error_peak_to_peak'], words)}",
    ]
    return f"{model[:1].upper()}{model[1:]}, {content['name']}: {', '.join(figures)}"


def _micrometres(value: float, words: PageWords) -> str:
    unit = words.unit("µm")
    return f"{words.number(f'{unit.of(value):.3g}')} {unit.name}"


def _axis(name: str, /, **more: Any) -> dict[str, Any]:
    """A value axis with its name, in the colours of the page."""
    line = {"lineStyle": {"color": "var(--line)"}}
    return {
        "type": "value",
        "name": name,
        "nameTextStyle": {**_TEXT, "align": "left"},
        "axisLabel": {**_TEXT, "hideOverlap": True},
        "splitLine": line,
        "axisLine": line,
        **more,
    }


def _line(name: str, color: str, points: list[list[float | None]], **more: Any) -> dict[str, Any]:
    """A line without symbols."""
    style = {"color": color, "width": 2}
    return {
        "type": "line",
        "name": name,
        "data": points,
        "symbol": "none",
        "lineStyle": style,
        "itemStyle": {"color": color},
        **more,
    }


_STRIP, _GAP, _TOP = 44, 26, 22
"""Height of a curve's strip, of the room above it, and of the first one's, in pixels."""


def _curves_view(content: JsonObject, words: PageWords) -> dict[str, Any]:
    """Load share, transmission error and stiffness over the roll angle, in strips with one scale of angles."""
    curves = content["curves"]
    angles: list[float] = curves["roll_angle"]
    shares = [[100 * share for share in pairs] for pairs in zip(*curves["load_share"], strict=True)]
    length, stiffness = words.unit("µm"), words.unit("N/(mm·µm)")
    errors = list(map(length.of, curves["transmission_error"]))
    stiffnesses = list(map(stiffness.of, curves["mesh_stiffness"]))
    strips = [
        (f"{words['load share of each pair of teeth']} (%)", shares),
        (f"{words['transmission error']} ({length.name})", [errors]),
        (f"{words['mesh stiffness']} ({stiffness.name})", [stiffnesses]),
    ]
    ends: dict[str, Any] = {"min": angles[0], "max": angles[-1]}
    option: dict[str, Any] = {"animation": False, "title": [], "grid": [], "xAxis": [], "yAxis": [], "series": []}
    for n, (name, courses) in enumerate(strips):
        last = n == len(strips) - 1
        top = _TOP + n * (_STRIP + _GAP)
        option["grid"].append({"left": 58, "right": 18, "top": top, "height": _STRIP})
        option["title"].append({"text": name, "left": 58, "top": top - 22, "textStyle": {**_TEXT, "fontWeight": "normal"}})
        labels = {"axisLabel": {**_TEXT, "show": last, "showMinLabel": False, "showMaxLabel": False}}
        title = {"name": f"{words['roll angle']} (°)", "nameLocation": "middle", "nameGap": 22} if last else {}
        option["xAxis"].append(_axis("", **(ends | labels | {"gridIndex": n, "nameTextStyle": _TEXT} | title)))
        option["yAxis"].append(_axis("", gridIndex=n, scale=n > 0, splitNumber=2))
        for k, course in enumerate(courses):
            points = [[angle, value] for angle, value in zip(angles, course, strict=True)]
            option["series"].append(_line(name, _LINES[k % len(_LINES)], points, xAxisIndex=n, yAxisIndex=n))
    greatest = [max(pair) for pair in zip(*shares, strict=True)]
    return {
        "key": "curves",
        "words": words["curves"],
        "told": _told(content, words),
        "option": option,
        "height": _TOP + len(strips) * (_STRIP + _GAP) + 24,
        "curves": [
            {
                "words": words["load share"],
                "unit": "%",
                "course": greatest,
                "digits": 1,
            },
            {
                "words": words["transmission error"],
                "unit": length.name,
                "course": errors,
                "digits": max(2 + length.more_digits, 0),
            },
            {
                "words": words["mesh stiffness"],
                "unit": stiffness.name,
                "course": stiffnesses,
                "digits": max(2 + stiffness.more_digits, 0),
            },
        ],
    }


def _flank_view(content: JsonObject, words: PageWords) -> dict[str, Any]:
    """The greatest contact pressure on both flanks unrolled: face width across, roll length up."""
    pattern, limits = content["pattern"], limits_of(content)
    is_plane = content["model"] == "2d"
    length, stress = words.unit("mm"), words.unit("MPa")
    across = [words["whole face width"]] if is_plane else [_plain(each, words) for each in pattern["across"]]
    option: dict[str, Any] = {"animation": False, "title": [], "grid": [], "xAxis": [], "yAxis": [], "series": []}
    for n, role in enumerate(Role):
        rows = sorted(zip(pattern[role.value], pattern["pressure"], strict=True), key=lambda row: row[0])
        cells = [
            [i, j, stress.of(value)] for j, (_, row) in enumerate(rows) for i, value in enumerate(row) if value is not None
        ]
        beside = {"left": 64, "right": "58%"} if n == 0 else {"left": "52%", "right": 104}
        option["grid"].append({**beside, "top": 26, "bottom": 46})
        name = "" if is_plane else f"{words['across the face width']} ({length.name})"
        category = {"type": "category", "axisTick": {"show": False}, "splitLine": {"show": False}}
        under = {"nameLocation": "middle", "nameGap": 24, "nameTextStyle": _TEXT}
        option["xAxis"].append(_axis(name, gridIndex=n, **(category | under), data=across))
        rolls = [_plain(roll, words) for roll, _ in rows]
        title = f"{words[role.value.capitalize()]}: {words['roll length']} ({length.name})"
        option["title"].append(
            {"text": title, "left": beside["left"], "top": 2, "textStyle": {**_TEXT, "fontWeight": "normal"}}
        )
        few = {"axisLabel": {**_TEXT, "interval": len(rolls) // 6}}
        option["yAxis"].append(_axis("", gridIndex=n, **(category | few), data=rolls))
        option["series"].append({"type": "heatmap", "xAxisIndex": n, "yAxisIndex": n, "data": cells, "name": title})
    option["visualMap"] = {
        "min": 0,
        "max": stress.of(limits["pressure"]),
        "calculable": False,
        "orient": "vertical",
        "right": 4,
        "top": 30,
        "itemHeight": 110,
        "text": [words.measure(limits["pressure"], 0, "MPa"), "0"],
        "textStyle": _TEXT,
    }
    option["tooltip"] = {"position": "top", "textStyle": {"fontSize": 13}}
    places = [26 + 225 * n for n, _ in enumerate(Role)]
    stacked = {
        "grid": [{"left": 64, "right": 92, "top": top, "height": 150} for top in places],
        "title": [each | {"left": 64, "top": top - 24} for top, each in zip(places, option["title"], strict=True)],
    }
    return {
        "key": "flank",
        "words": words["pattern of contact"],
        "told": _told(content, words),
        "option": option,
        "height": 240,
        "narrow": {"height": 460, "option": stacked},
    }


def _plain(value: float, words: PageWords) -> str:
    return words.number(words.unit("mm").text(value, 1))


def _speed_view(content: JsonObject, words: PageWords) -> dict[str, Any]:
    """Dynamic factors over speed, and the operating point."""
    speeds = content["speed"]
    series, told = [], []
    for n, (mesh, factors) in enumerate(content["kv"].items()):
        name = "K_v" if len(content["kv"]) == 1 else f"K_v, {called(words, mesh)}"
        colour = _LINES[n % len(_LINES)]
        running_up = _line(name, colour, _over(speeds, factors))
        series.append(running_up)
        if (down := content["kv_down"].get(mesh)) and down != factors:
            dashed = {"color": colour, "type": "dashed", "width": 1.5}
            series.append(_line(f"{name}, {words['running down']}", colour, _over(speeds, down), lineStyle=dashed))
        speed, factor = content["operating"]["speed"], content["operating"]["kv"].get(mesh)
        if speed is not None and factor is not None:
            running_up["markPoint"] = {
                "data": [{"coord": [speed, factor]}],
                "symbol": "circle",
                "symbolSize": 11,
                "itemStyle": {"color": "var(--wrong)", "borderColor": "var(--paper)", "borderWidth": 2},
                "label": {"show": False},
            }
            told.append(f"{name} = {words.number(f'{factor:.4g}')}")
    if content["kv_iso6336"]:
        dotted = {"color": "var(--soft)", "type": "dotted", "width": 2}
        series.append(_line("ISO 6336", "var(--soft)", _over(speeds, content["kv_iso6336"]), lineStyle=dotted))
    at = content["operating"]["speed"]
    where = (
        f" {words['at']} {words.number(f'{at:g}')} {words['rpm']} ({words['operating point']})"
        if told and at is not None
        else ""
    )
    return {
        "key": "speed",
        "words": words["K_v over speed"],
        "told": f"{', '.join(told)}{where}",
        "option": {
            "animation": False,
            "grid": {"left": 58, "right": 24, "top": 34, "bottom": 44},
            "title": {"text": "K_v", "left": 58, "top": 6, "textStyle": {**_TEXT, "fontWeight": "normal"}},
            "legend": {"top": 0, "right": 8, "textStyle": _TEXT},
            "xAxis": _axis(f"{words['speed']} ({words['rpm']})", nameLocation="middle", nameGap=24) | {"nameTextStyle": _TEXT},
            "yAxis": _axis("", scale=True),
            "tooltip": {"trigger": "axis", "textStyle": {"fontSize": 13}},
            "series": series,
        },
        "height": 240,
    }


def _over(speeds: Sequence[float], factors: Sequence[float | None]) -> list[list[float | None]]:
    return [[speed, factor] for speed, factor in zip(speeds, factors, strict=False)]


def coloured_kinds(content: JsonObject, design: Design, words: PageWords) -> list[dict[str, Any]]:
    """Return coloured teeth by kinds of stress: a surface for each role, and the numbers of the bodies that have it."""
    teeth, limits = content["teeth"], limits_of(content)
    on = _bodies(content, design)
    ends = {"pressure": limits["pressure"], "stress": max(teeth[role.value]["stress"]["most"] for role in Role)}
    said = {"pressure": words["contact pressure"], "stress": words["von Mises stress, each tooth at its worst"]}
    return [
        {
            "key": key,
            "words": said[key],
            "most": most,
            "told": words.measure(most, 0, "MPa"),
            "surfaces": {role.value: teeth[role.value][key] for role in Role},
            "on": on,
        }
        for key, most in ends.items()
    ]


def _bodies(content: JsonObject, design: Design) -> list[dict[str, Any]]:
    """Numbers of the bodies in mesh, with role and number of teeth; of a train those of the mesh that was checked."""
    section = section_of(design)
    if section is None:
        return []
    number = content["mesh"] or 0
    meshes = [mesh for n, mesh in enumerate(section["meshes"]) if not isinstance(design, PlanetaryDesign) or n % 2 == number]
    found = {body: role.value for mesh in meshes for body, role in zip(mesh["of"], Role, strict=True)}
    return [{"body": body, "role": role, "teeth": abs(int(section["bodies"][body]["teeth"]))} for body, role in found.items()]
