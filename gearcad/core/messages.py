"""Messages in another language: each is English where it is made, and is matched with its template where a person reads it.

The catalogue of a language has a line for each template of a message, with {} for each value: `"must be at least {} mm" =
"muss mindestens {} mm sein"`. A value can be a message, a list, a number or a key; it is translated in the same way.
"""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache, lru_cache
from itertools import chain, count, pairwise, repeat
from typing import Any, NamedTuple

from gearcad.core.runtime import templates

LANGUAGES = ("en", "de")
"""Codes of the languages of messages; English needs no catalogue."""

HOLE = "{}"
"""Place of a value in a template."""

_NUMBERED = re.compile(r"\{(\d*)\}")
_WORD = re.compile(r"[^\W_]+")
_NUMBER = re.compile(r"(?<![\w.,/:\-\"'])([-+±−]?\d+)\.(\d+(?:e[-+]?\d+)?)(?![\w\"]|\.\d)")
_UNITS = {"mm", "deg", "rpm", "kg", "min", "mmol", "rad", "inch", "kilo", "ccx"}
_ENGLISH = re.compile(r"[A-Za-z][a-z]+(?:['’]s)?")
_EDGES = "\"'`.,;:!?()[]{}…"

_STRONG = ("; ", ": ")
_EQUALS = " = "
_SEPARATORS = (" – ", ", ", " and ", " or ", " (", _EQUALS, " / ")
"""Signs between the parts of a text that no template matches: between sentences, and within them."""

_RICH = 16
"""Characters of a template that is taken before a text is divided into sentences."""

_SUFFIX = re.compile(r"[ ,;:]")
"""Begin of a template that stands behind another text."""

_MOST_STEPS = 400
"""Parts of one message that are looked at; what is left then stays as it is."""


class Translation(NamedTuple):
    """A text, and the number of words in it that stayed English."""

    text: str
    left: int


class _Template:
    """An English template with its translation; its patterns are compiled when they are first needed."""

    def __init__(self, english: str, translated: str) -> None:
        before = HOLE if _SUFFIX.match(english) else ""
        after = HOLE if english.endswith(" ") else ""
        self.translated = f"{before}{_shifted(translated, len(before) // 2)}{after}"
        self.pieces = tuple(f"{before}{english}{after}".split(HOLE))
        self.length = sum(map(len, self.pieces))
        remarks = sum(not piece for piece in self.pieces[1:-1])
        self.weight = self.length + remarks - _HOLE_WEIGHT * (len(self.pieces) - 1 - remarks)
        self._patterns: tuple[re.Pattern[str], ...] = ()

    def words(self) -> set[str]:
        """Return the whole words that every text of this template has."""
        last = len(self.pieces) - 1
        found = set()
        for place, piece in enumerate(self.pieces):
            of_piece = _WORD.findall(piece)
            if place and of_piece and piece[:1].isalnum() and not _FIRST_WORD.match(piece):
                del of_piece[0]
            if place < last and of_piece and piece[-1:].isalnum() and not _LAST_WORD.search(piece):
                del of_piece[-1]
            found |= set(of_piece)
        return found

    def values(self, text: str) -> tuple[str, ...] | None:
        """Return what stands in the holes of a text; None for a text of another template."""
        if not self._has_pieces(text):
            return None
        if not self._patterns:
            ways = (_FURTHER, _ANY) if "" in self.pieces[1:-1] else (_ANY,)
            self._patterns = tuple(re.compile(self._pattern(way), re.DOTALL) for way in ways)
        found = next((match for each in self._patterns if (match := each.fullmatch(text))), None)
        return found.groups() if found else None

    def _has_pieces(self, text: str) -> bool:
        """Return whether a text has the pieces between the holes, in their order: few others need the patterns."""
        if not (text.startswith(self.pieces[0]) and text.endswith(self.pieces[-1])):
            return False
        at = 0
        for piece in self.pieces:
            if (found := text.find(piece, at)) < 0:
                return False
            at = found + len(piece)
        return True

    def _pattern(self, beside: str) -> str:
        """Return the regular expression of the template; `beside` is that of a hole right behind another."""
        made = re.escape(self.pieces[0])
        for before, after in pairwise(self.pieces):
            hole = beside if made.endswith(")") and not before else _ANY
            end, begin = _END if _LAST_WORD.search(before) else "", _BEGIN if _FIRST_WORD.match(after) else ""
            made += f"{end}({hole}){begin}{re.escape(after)}"
        return made

    def is_typed(self, place: int, value: str) -> bool:
        """Return whether the hole at this place holds a key, or words as a spec has them, which are alike in every language."""
        before, after = next(filter(None, reversed(self.pieces[: place + 1])), ""), self.pieces[place + 1]
        if before.endswith(_BEFORE_WORDS) and _WORDS_OF_SPECS.fullmatch(value):
            return True
        return " " not in value and (before.endswith(_BEFORE_KEYS) or after.startswith(_AFTER_KEYS))

    def filled(self, values: Iterable[str]) -> str:
        """Return the translation with these values in its holes, in order or as they are numbered."""
        given, following = tuple(values), count()
        return _NUMBERED.sub(lambda hole: given[int(hole[1]) if hole[1] else next(following)], self.translated)


_HOLE_WEIGHT = 3
"""Characters by which each hole makes a template less special; one right behind another is a remark, which does not."""

_ANY = ".*?"
_FURTHER = r"(?:[;:] .*|, (?:or|in|of|where|with|which|such|below|above|at|as|unless|no|not|that|the)\b.*| \(.*)?"
"""Patterns of a value, and of a value right behind another: a further remark, or nothing."""

_END, _BEGIN = r"(?!\w|[._]\w)", r"(?<!\w)(?<!\w[._])"
"""End and begin of a word beside a value, so that no key is taken for a word."""

_LAST_WORD, _FIRST_WORD = re.compile(r"(?:^|[ (])[A-Za-z]+$"), re.compile(r"[A-Za-z]+(?:[ ,;:.)]|$)")

_BEFORE_KEYS, _AFTER_KEYS = (
    ("[", '"', "`", ".", "_", " = ", "<", "--"),
    ("]", '"', "`", ".teeth", ".profile", ".tip", ".pair", "_", " =", ">", " is missing"),
)

_BEFORE_WORDS, _WORDS_OF_SPECS = ("must be ", " one of ", "permitted are "), re.compile(r"\w+(?:, \w+)+(?: or \w+)?")
"""Texts before a list of words that a spec can have, and such a list."""


def _shifted(translated: str, by: int) -> str:
    """Return a translation whose numbered holes count from `by`; holes without a number stay in order."""
    return _NUMBERED.sub(lambda hole: f"{{{int(hole[1]) + by}}}" if hole[1] else HOLE, translated)


def is_english(token: str) -> bool:
    """Return whether a token of a text is a word of a sentence, not a key, a unit, a symbol or a number."""
    bare = token.strip(_EDGES)
    return bool(_ENGLISH.fullmatch(bare)) and bare not in _UNITS


_QUOTED = re.compile(r"""(?<!\w)'[^']*'(?!\w)|"[^"]*"|`[^`]*`""")
"""Texts that a user typed, or may type: the same in every language."""


def english_words(text: str) -> int:
    """Return the number of words of sentences in a text, without those in quotation marks."""
    return sum(map(is_english, _QUOTED.sub("0", text).split()))


class Catalogue:
    """The messages of one language: `catalogue.text(english)`."""

    def __init__(self, sentences: Mapping[str, str], words: Mapping[str, str]) -> None:
        self._exact = {**words, **{english.strip(): text.strip() for english, text in sentences.items() if HOLE not in english}}
        entries = {**{key: text for key, text in words.items() if HOLE in key}, **sentences}
        made = [_Template(*entry) for entry in entries.items() if _is_open(entry[0])]
        made += [_Template(*other) for entry in entries.items() for other in _with_names(*entry)]
        counts = Counter(word for each in made for word in each.words())
        self._of_word: dict[str, list[_Template]] = {}
        for each in made:
            if words_of := each.words():
                rarest = min(words_of, key=lambda word: (counts[word], -len(word), word))
                self._of_word.setdefault(rarest, []).append(each)
        self.text = lru_cache(maxsize=4096)(self._text)
        self._best = lru_cache(maxsize=4096)(self._search)

    def _text(self, english: str) -> str:
        """Return a message in this language; a text that it does not know stays as it is."""
        return "\n".join(map(self._line, english.split("\n")))

    def _line(self, english: str) -> str:
        """Return a line in this language: of a long list of sentences each by itself, or with those that it needs behind it."""
        parts = english.split(_SENTENCES)
        if len(parts) <= _FEW:
            found = self._best(english)
            return found.text if found.left == 0 or 2 * found.left < english_words(english) else english
        group = _FEW if len(parts) <= _MANY else 1
        ways = [Translation("", 0)]
        for end in range(1, len(parts) + 1):
            way = self._onwards(ways[end - 1], parts[end - 1 : end], end > 1)
            for at in range(end - 2, max(end - group, 0) - 1, -1):
                if way.left > ways[at].left:
                    way = min(way, self._onwards(ways[at], parts[at:end], at > 0), key=lambda each: each.left)
            ways.append(way)
        return ways[-1].text

    def _onwards(self, before: Translation, parts: Sequence[str], is_further: bool) -> Translation:
        """Return a translation with that of the following sentences, which belong together."""
        found = self._best(_SENTENCES.join(parts))
        return Translation(f"{before.text}{_SENTENCES if is_further else ''}{found.text}", before.left + found.left)

    def _search(self, english: str) -> Translation:
        return _Search(self._exact, self._of_word).best(english)


_SENTENCES, _FEW, _MANY = "; ", 3, 40
"""Text between sentences, as many as one template may have, and as many as are looked at together."""


_ROLE = re.compile(r"(?<![\w.])(?:the )?(?:(?P<role>pinion|wheel)\b(?![.\w])|(?<=the )\{\})|\{\}")
_ROLE_OF = {"pinion": "Ritzel", "wheel": "Rad"}


def _with_names(english: str, translated: str) -> Iterator[tuple[str, str]]:
    """Yield the entry for gears with names of their own: in a planetary train they stand where a pair has `the pinion`."""
    if not re.search(r"(?<![\w.])(pinion|wheel)\b(?![.\w])|\bthe \{\}", english):
        return
    holes, following = [], count()
    for found in _ROLE.finditer(english):
        holes.append(_ROLE_OF[found["role"]] if found["role"] else str(next(following)))
    if len({each for each in holes if not each.isdigit()}) < sum(not each.isdigit() for each in holes):
        return  # the same gear twice
    unnumbered = count()
    translated = _NUMBERED.sub(lambda hole: f"{{{hole[1] or next(unnumbered)}}}", translated)
    translated = _NUMBERED.sub(lambda hole: f"{{{holes.index(hole[1])}}}", translated)
    for place, role in enumerate(holes):
        if not role.isdigit():
            translated, times = re.subn(rf"\b(?:d(?:as|em|ie) )?{role}\b|\bde[rs] {role}e?s?\b", f"{{{place}}}", translated)
            if times != 1:
                return
    yield _ROLE.sub(HOLE, english), translated


def _is_open(english: str) -> bool:
    """Return whether an entry holds values, or stands behind or before another text."""
    return HOLE in english or bool(_SUFFIX.match(english)) or english.endswith(" ")


class _Search:
    """The translation of one line: of all ways to read it the one that leaves the fewest English words."""

    def __init__(self, exact: Mapping[str, str], of_word: Mapping[str, list[_Template]]) -> None:
        self._exact, self._of_word = exact, of_word
        self._found: dict[str, Translation] = {}

    def best(self, text: str) -> Translation:
        """Return the best translation of a text."""
        if (known := self._found.get(text)) is not None:
            return known
        bare = text.strip()
        if not bare or not any(map(str.isalpha, bare)):
            return Translation(_numbers(text), 0)
        if _QUOTED.fullmatch(bare):
            return Translation(text, 0)
        if (exact := self._lookup(bare)) is not None:
            before, after = text[: len(text) - len(text.lstrip())], text[len(text.rstrip()) :]
            return Translation(before + exact + after, 0)
        plain = Translation(_numbers(text), english_words(text))
        if plain.left == 0:
            return self._with_names(plain.text)
        self._found[text] = plain  # also the end of every circle
        if len(self._found) <= _MOST_STEPS:
            self._found[text] = self._read(text, plain)
        return self._found[text]

    def _read(self, text: str, plain: Translation) -> Translation:
        """Return the best reading of a text: by templates, those with most text first, by signs between its parts, by words."""
        there = dict.fromkeys(_WORD.findall(text))
        found = {id(each): each for word in there for each in self._of_word.get(word, ()) if each.length <= len(text)}
        templates = sorted(found.values(), key=lambda each: -each.weight)
        best = self._by_templates(text, (each for each in templates if each.weight >= _RICH), plain)
        best = self._by_signs(text, _STRONG, best)
        best = self._by_templates(text, (each for each in templates if each.weight < _RICH), best)
        best = self._by_signs(text, _SEPARATORS, best)
        if best.left and text[-1] in ").:":
            part = self.best(text[:-1])
            best = min(best, Translation(part.text + text[-1], part.left), key=lambda each: each.left)
        return self._word_by_word(text) or best if best.left else best

    def _lookup(self, text: str) -> str | None:
        """Return the translation of a text that is an entry as it stands, or begins with the other case."""
        exact = self._exact.get(text)
        if exact is None and text[0].islower():
            exact = self._exact.get(text[0].upper() + text[1:])
        elif exact is None and text[0].isupper() and (lower := self._exact.get(text[0].lower() + text[1:])):
            exact = lower[0].upper() + lower[1:]
        return exact

    def _with_names(self, text: str) -> Translation:
        """Return a text without English words with the names of gears in mesh, such as sun-planet, in this language."""
        return Translation(_MESH.sub(lambda found: self._name(found[0]), text) if "-" in text else text, 0)

    def _name(self, mesh: str) -> str:
        names = [self._lookup(each) for each in mesh.split("-")]
        return "-".join(filter(None, names)) if all(names) else mesh

    def _by_templates(self, text: str, templates: Iterable[_Template], best: Translation) -> Translation:
        """Return the translation by one of the templates if it leaves less than the best one so far."""
        for template in templates:
            if best.left == 0:
                break
            if (values := template.values(text)) is not None and text not in values:
                typed = (template.is_typed(place, each) for place, each in enumerate(values))
                if (parts := self._all(values, best.left, typed)) is not None:
                    best = Translation(template.filled(each.text for each in parts), sum(each.left for each in parts))
        return best

    def _by_signs(self, text: str, signs: Iterable[str], best: Translation) -> Translation:
        """Return the translation part by part if it leaves less than the best one so far."""
        for sign in signs:
            for divided in _divided(text, sign):
                if best.left == 0:
                    return best
                typed = chain([sign == _EQUALS and " " not in divided[0]], repeat(False))
                if (parts := self._all(divided, best.left, typed)) is not None:
                    told = _JOINED.get(sign, sign).join(each.text for each in parts)
                    best = Translation(told, sum(each.left for each in parts))
        return best

    def _all(self, texts: Sequence[str], most: int, typed: Iterable[bool]) -> list[Translation] | None:
        """Return the translations of all texts; None as soon as they leave `most` English words. Typed ones stay."""
        found, left = [], 0
        for each, is_typed in zip(texts, typed, strict=False):
            found.append(Translation(_numbers(each), 0) if is_typed else self.best(each))
            left += found[-1].left
            if left >= most:
                return None
        return found

    def _word_by_word(self, text: str) -> Translation | None:
        """Return the translation of a few words among names and numbers; None if there are more, or unknown ones."""
        words = [each for each in text.split(" ") if is_english(each)]
        known = {each: other for each in words if (other := self._lookup(each.strip(_EDGES))) is not None}
        if len(words) > _FEW_WORDS or len(known) < len(set(words)):
            return None
        told = (each.replace(each.strip(_EDGES), known[each]) if each in known else each for each in text.split(" "))
        return Translation(_numbers(" ".join(told)), 0)


_MESH = re.compile(r"(?<![\w.-])[a-z]+(?:_\d)?-[a-z]+(?:_\d)?(?![\w.-])")


def _divided(text: str, sign: str) -> Iterator[list[str]]:
    """Yield the ways to divide a text by a sign: at each of its first places, then at all."""
    parts = text.split(sign)
    if len(parts) > 1:
        for place in range(1, min(len(parts), _MOST_PLACES)):
            yield [sign.join(parts[:place]), sign.join(parts[place:])]
        if len(parts) > 2:
            yield parts


_FEW_WORDS = 3
"""Words among names and numbers that are translated one by one."""

_MOST_PLACES = 6
"""Places of one separator at which a text is divided in two."""

_JOINED = {" and ": " und ", " or ": " oder "}


def _numbers(text: str) -> str:
    """Return a text with decimal commas and the units of the language; what stands in quotation marks stays."""
    parts = _QUOTED_PARTS.split(text) if any(mark in text for mark in "\"'`") else [text]
    return "".join(part if place % 2 else _UNIT.sub(_unit, _NUMBER.sub(r"\1,\2", part)) for place, part in enumerate(parts))


def _unit(found: re.Match[str]) -> str:
    return "°" if found[1] == "deg" else " 1/min"


_UNIT = re.compile(r"(?<=\d) (deg|rpm)\b")
_QUOTED_PARTS = re.compile(f"({_QUOTED.pattern})")


@cache
def catalogue(language: str) -> Catalogue | None:
    """Return the catalogue of a language by its code; None for English."""
    if language == LANGUAGES[0]:
        return None
    tables = messages_of(language)
    page: dict[str, Any] = tomllib.loads((templates() / "page_words.toml").read_text(encoding="utf-8"))
    return Catalogue(tables["messages"], {**page.get(language, {}), **tables["words"]})


def messages_of(language: str) -> Mapping[str, Mapping[str, str]]:
    """Return the tables of the template of a language: its `messages` and single `words` in them."""
    return tomllib.loads((templates() / f"messages_{language}.toml").read_text(encoding="utf-8"))
