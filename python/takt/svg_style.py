"""Resolves the properties of an SVG element: presentation attributes, style sheets, the style attribute, inheritance.

Selectors of type, class, id, *, compounds of them, and descendant and child combinators are supported. Other selectors,
at-rules and nested rules are errors if they set a property that affects visibility or position.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple
from xml.etree import ElementTree

from takt.svg_values import NUMBER, TreeError

INHERITED = (
    "visibility", "fill", "stroke", "fill-opacity", "stroke-opacity", "stroke-width", "color", "font-size",
    "marker-start", "marker-mid", "marker-end",
)  # fmt: skip
# Not inherited.
OWN = (
    "display", "opacity", "transform", "transform-origin", "transform-box", "clip-path", "mask", "filter", "overflow",
    "d", "x", "y", "width", "height", "cx", "cy", "r", "rx", "ry",
)  # fmt: skip
# Not available as attributes.
_STYLE_ONLY = ("rotate", "translate", "scale", "offset-path", "marker")
_READ = frozenset((*INHERITED, *OWN, *_STYLE_ONLY))
# Unsupported rules for these are errors at once if they hide; if they show, at an element that would be left out.
_SHOWN = ("fill", "stroke", "fill-opacity", "stroke-opacity", "stroke-width")
_HARMLESS = ("filter", "overflow", "color", "font-size", "marker", "marker-start", "marker-mid", "marker-end")
_WITHOUT_EFFECT = ("@font-face", "@charset", "@namespace", "@page", "@counter-style")
Key = tuple[str, str, tuple[str, ...]]  # tag, id, classes
_COMPOUND = re.compile(r"(\*|[\w-]+)?((?:[.#][\w-]+)*)")
_BRACE = re.compile("[{};]")
# Pseudo-classes of interaction; none of them applies to a drawing.
_INTERACTIVE = re.compile(r":(hover|active|focus|focus-within|focus-visible|target|visited)\b")
_MOST_RULES = 10_000  # in all sheets; beyond: TreeError
_MOST_NESTED = 20  # rules within rules
_MOST_LOOKS = 10_000_000  # comparisons of rules with elements; beyond: TreeError


_Part = tuple[str, str, str, tuple[str, ...]]  # combinator before, tag, id, classes


class _Rule(NamedTuple):
    parts: tuple[_Part, ...]  # from the last
    weight: tuple[int, int, int, int]  # specificity (ids, classes, types), then the order in the sheets
    names: list[tuple[str, str, bool]]  # declarations: name, value, whether it is important


def is_paint(value: str, opacity: str) -> bool:
    """Returns whether a fill or stroke with this opacity is visible."""
    value = value.strip().lower()
    if value in ("none", "transparent") or is_zero(opacity):
        return False
    if re.fullmatch("#[0-9a-f]{3}0|#[0-9a-f]{6}00", value):
        return False
    match = re.fullmatch(r"(?:rgb|hsl)a?\(\s*([^()]*)\)", value)
    words = re.split(r"[\s,/]+", match[1].strip()) if match else []
    return not (len(words) == 4 and is_zero(words[3]))


def is_zero(text: str) -> bool:
    """Returns whether the text is a number, percentage or length of 0 or below."""
    match = re.fullmatch(rf"\s*({NUMBER})\s*(?:%|[a-zA-Z]*)\s*", text)
    return match is not None and float(match[1]) <= 0


class Styles:
    """The style sheets of a drawing. Raises TreeError if unsupported rules matter."""

    def __init__(self, sheets: Sequence[str]) -> None:
        self._rules: dict[str, list[_Rule]] = {}
        self._count = self._looks = 0
        self.imported = 0
        self.are_nested = False  # whether rules depend on ancestors of elements
        self.unread = ""  # the first unsupported rule that would show an element, as sentences name it
        for sheet in sheets:
            text = _without_comments(sheet).replace("<!--", " ").replace("-->", " ")
            for head, body in _blocks(text):
                if head.startswith("@"):
                    self._at_rule(head, body)
                else:
                    if "{" in body:
                        body = self._nested(head, body)
                    for selector in _parts(head, ","):
                        self._add(selector.strip(), _declarations(body))

    def _at_rule(self, head: str, body: str, depth: int = 1) -> None:
        if head.startswith("@import"):
            self.imported += 1
        elif not head.startswith(_WITHOUT_EFFECT):
            self._check_unread(head, _declarations(self._nested(head, body, depth)))

    def _nested(self, head: str, body: str, depth: int = 1) -> str:
        """Checks the rules within a rule; returns its own declarations."""
        if depth > _MOST_NESTED:
            raise TreeError(f"<style>: rules are nested more than {_MOST_NESTED} deep")
        own = []
        for inner, text in _blocks(body + ";"):
            if text or inner.startswith("@"):
                self._at_rule(f"{head} {inner}", text, depth + 1)
            else:
                own.append(inner)
        return ";".join(own)

    def _add(self, selector: str, names: list[tuple[str, str, bool]]) -> None:
        parts: list[_Part] = []
        weight = [0, 0, 0]
        combinator = " "
        for word in reversed(selector.replace(">", " > ").split()):
            if word == ">" and parts and combinator == " ":
                combinator = ">"
                _, tag, identity, classes = parts[-1]
                parts[-1] = (combinator, tag, identity, classes)
                continue
            match = _COMPOUND.fullmatch(word)
            combinator = " "
            marks = re.findall(r"[.#][\w-]+", match[2]) if match else []
            ids = [mark[1:] for mark in marks if mark[0] == "#"]
            if not match or len(ids) > 1:
                self._check_unread(selector, names)
                return
            classes = tuple(mark[1:] for mark in marks if mark[0] == ".")
            tag = "" if match[1] in (None, "*") else match[1]
            parts.append((" ", tag, ids[0] if ids else "", classes))
            weight = [weight[0] + len(ids), weight[1] + len(classes), weight[2] + bool(tag)]
        if parts:
            self._count += 1
            if self._count > _MOST_RULES:
                raise TreeError(f"<style>: more than {_MOST_RULES:,} rules")
            self.are_nested = self.are_nested or len(parts) > 1
            _, tag, identity, classes = parts[0]
            key = f"#{identity}" if identity else f".{classes[0]}" if classes else tag or "*"
            rule = _Rule(tuple(parts), (weight[0], weight[1], weight[2], self._count), names)
            self._rules.setdefault(key, []).append(rule)

    def _check_unread(self, selector: str, names: list[tuple[str, str, bool]]) -> None:
        """Raises TreeError if an unsupported rule hides or moves elements; notes the first one that shows them."""
        for name, value, _ in names:
            shows = name in _SHOWN and not is_zero(value) and is_paint(value, "1")
            if name in _READ and name not in _HARMLESS and not shows:
                raise TreeError(f"<style>: '{name}' for '{selector}' is not read; expected it at the elements")
            if shows and not self.unread and not _INTERACTIVE.search(selector):
                self.unread = f"'{name}' for '{selector}'"

    def of(
        self, one: ElementTree.Element, key: Key, around: Sequence[Key], inherited: dict[str, str]
    ) -> dict[str, str]:
        """Returns the specified values of the properties of an element.

        around: keys of its ancestors, the outermost first.
        inherited: values inherited from its parent.

        Raises TreeError for var(), for `inherit` of a property that is not inherited, and beyond _MOST_LOOKS."""
        found = {name: one.attrib[name] for name in (*INHERITED, *OWN) if name in one.attrib}
        tag, identity, classes = key
        keys = ["*", tag, *(f".{name}" for name in classes), *([f"#{identity}"] if identity else [])]
        near = [rule for name in keys for rule in self._rules.get(name, ())]
        self._looks += sum(len(rule.parts) + len(rule.names) for rule in near)
        if self._looks > _MOST_LOOKS:
            raise TreeError("<style>: too many rules for so many elements")
        rules = [rule for rule in near if _matches(rule, key, around)]
        rules.sort(key=lambda rule: rule.weight)
        own = _declarations(one.attrib.get("style", ""))
        for important in (False, True):
            for names in [*(rule.names for rule in rules), own]:
                for name, value, is_important in names:
                    if is_important == important and name in _READ:
                        found[name] = value
        result = dict(inherited)
        for name, value in found.items():
            word = value.strip().lower()
            if "var(" in word:
                raise TreeError(f"<{tag}>: '{name}: {value[:40]}' is not read; expected a value")
            if word in ("inherit", "unset", "revert"):
                if word == "inherit" and name not in INHERITED:
                    raise TreeError(f"<{tag}>: '{name}: inherit' is not read; expected a value")
            elif word == "initial":
                result.pop(name, None)
            elif name == "marker":
                result.update({f"marker-{where}": value for where in ("start", "mid", "end")})
            else:
                result[name] = value.strip()
        return result


def key_of(one: ElementTree.Element, name: str) -> Key:
    return (name, one.attrib.get("id", ""), tuple(one.attrib.get("class", "").split()))


def _matches(rule: _Rule, key: Key, around: Sequence[Key]) -> bool:
    if not _fits(rule.parts[0], key):
        return False
    reached = {len(around)}  # indices of elements that the previous part can match
    for part, before in pairwise(rule.parts):
        near = {i - 1 for i in reached} if part[0] == ">" else range(max(reached))
        reached = {i for i in near if i >= 0 and _fits(before, around[i])}
        if not reached:
            return False
    return True


def _fits(part: _Part, key: Key) -> bool:
    _, tag, identity, classes = part
    return tag in ("", key[0]) and identity in ("", key[1]) and all(name in key[2] for name in classes)


def _blocks(text: str) -> Iterator[tuple[str, str]]:
    """Yields the text before braces and the text in them; a statement without braces with an empty second text."""
    at = 0
    while at < len(text):
        found = _BRACE.search(text, at)
        end = found.start() if found else len(text)
        head = text[at:end].strip()
        at = end + 1
        if end == len(text) or text[end] == "}":
            continue
        if text[end] == ";":
            yield head, ""
            continue
        depth = 1
        while at < len(text) and depth:
            depth += {"{": 1, "}": -1}.get(text[at], 0)
            at += 1
        yield head, text[end + 1 : at - 1 if depth == 0 else at]


def _declarations(text: str) -> list[tuple[str, str, bool]]:
    """Returns name, value and whether it is important, of each declaration."""
    found = []
    for part in _parts(_without_comments(text)):
        name, colon, value = part.partition(":")
        plain, mark, important = value.partition("!")
        if colon:
            found.append((name.strip().lower(), plain.strip(), bool(mark) and important.strip().lower() == "important"))
    return found


def _parts(text: str, separator: str = ";") -> Iterator[str]:
    """Yields the parts between separators that are neither quoted nor in brackets."""
    begin = depth = 0
    quote = ""
    for i, letter in enumerate(text):
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "\"'":
            quote = letter
        elif letter in "()":
            depth = max(depth + (1 if letter == "(" else -1), 0)
        elif letter == separator and not depth:
            yield text[begin:i]
            begin = i + 1
    yield text[begin:]


def _without_comments(text: str) -> str:
    first, *others = text.split("/*")
    kept = [first]
    for other in others:
        _, end, behind = other.partition("*/")
        kept += [behind] if end else []
    return " ".join(kept)
