"""PY-21: the schema of machine files, as editors use it."""

from __future__ import annotations

import copy
import json
import random
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any, ClassVar

import pytest
import takt
import yaml
from every_kind import FULL, MINIMAL, left_out, text_of
from jsonschema import Draft202012Validator
from takt import _core

ROOT = Path(__file__).resolve().parents[2]
SCHEMA: dict[str, Any] = json.loads(_core.schema())
VALIDATOR = Draft202012Validator(SCHEMA)
RANDOM = 1000


class Words(yaml.SafeLoader):
    """Plain words as YAML 1.2 and the engine read them: 1e5 is a number, `on` is a text."""

    yaml_implicit_resolvers: ClassVar[dict[str, list[Any]]] = {}


for tag, pattern in (
    ("bool", "true|false"),
    ("int", r"[-+]?\d+"),
    ("float", r"[-+]?(?:\.\d+|\d+\.?\d*)(?:[eE][-+]?\d+)?"),
    ("null", r"~|null|"),
):
    Words.add_implicit_resolver(f"tag:yaml.org,2002:{tag}", re.compile(f"^(?:{pattern})$"), None)


def is_machine(text: str, file: Path = ROOT / "machine.yaml") -> bool:
    """Whether `takt check` takes it."""
    try:
        _core.check_machine(text.encode(), str(file))
    except takt.ConfigError:
        return False
    return True


def wrong(machine: Any) -> str:
    """What the schema has against it."""
    return "; ".join(f"{error.json_path}: {error.message}" for error in VALIDATOR.iter_errors(machine))


def shipped() -> list[Any]:
    """Machines of examples and pages: where, and the text. Pages have some with mistakes, too."""
    files = [*(ROOT / "python" / "examples").glob("*/machine.yaml"), *(ROOT / "docs").rglob("*.yaml")]
    found = [(file, "", file.read_text(encoding="utf-8")) for file in sorted(files)]
    for page in sorted([*(ROOT / "docs").rglob("*.md"), ROOT / "README.md"]):
        blocks = re.findall(r"^```yaml[^\n]*\n(.*?)^```", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
        found += [(page, f" {number}", block) for number, block in enumerate(blocks)]
    machines = [(file, number, text) for file, number, text in found if is_machine(text, file)]
    return [pytest.param(text, id=f"{f.relative_to(ROOT)}{number}") for f, number, text in machines]


SHIPPED = shipped()


def test_it_is_a_schema() -> None:
    Draft202012Validator.check_schema(SCHEMA)


@pytest.mark.parametrize("text", SHIPPED)
def test_it_takes_the_machines_of_examples_and_pages(text: str) -> None:
    assert wrong(yaml.load(text, Words)) == ""


def test_examples_and_pages_have_machines() -> None:
    places = [str(machine.id) for machine in SHIPPED]
    assert sum(place.startswith("python/examples/") for place in places) >= 7
    assert sum(place.startswith("docs/") for place in places) >= 12


@pytest.mark.parametrize("name", MINIMAL)
def test_it_takes_as_little_as_each_kind_needs(name: str) -> None:
    text = text_of(MINIMAL[name])
    assert wrong(json.loads(text)) == ""
    assert wrong(json.loads(_core.load_machine(text.encode(), "machine"))) == ""  # with the defaults


def test_it_takes_all_that_is_taken_with_anything_left_out() -> None:
    machines = {where: text for where, machine in left_out(FULL) if is_machine(text := text_of(machine))}
    assert len(machines) > 100
    refused = {where: said for where, text in machines.items() if (said := wrong(json.loads(text)))}
    refused |= {
        f"{where}, with defaults": said
        for where, text in machines.items()
        if (said := wrong(json.loads(_core.load_machine(text.encode(), "machine"))))
    }
    assert refused == {}


def test_it_takes_what_is_taken_of_random_machines() -> None:
    """Numbers are changed, keys left out, values swapped or made something else, one after the other: whatever the
    engine still takes, the schema takes, too."""
    chance = random.Random(20)
    known = [FULL, *MINIMAL.values()]
    taken = 0
    for _ in range(20 * RANDOM):
        machine = copy.deepcopy(chance.choice(known))
        change(machine, chance)
        text = text_of(machine)
        if is_machine(text):
            assert wrong(json.loads(text)) == "", text
            known.append(machine)
            taken += 1
            if taken == RANDOM:
                return
    pytest.fail(f"only {taken} machines of {20 * RANDOM} were taken")


ODD = [None, True, 0, 1, -1, 2.0, 0.5, 1e-7, 1e15, "", "x", "line", "position", [], {}, [0, 0], {"x": 1, "y": 2}]


def change(machine: Any, chance: random.Random) -> None:
    """One thing in it."""
    places = list(leaves(machine))
    holder, key = chance.choice(places)
    numbers = [(h, k) for h, k in places if type(h[k]) in (int, float)]
    match chance.choice("nnnnndoos"):
        case "n" if numbers:
            holder, key = chance.choice(numbers)
            holder[key] *= chance.choice([0.5, 2, 10, -1, 1.0])
        case "o":
            holder[key] = copy.deepcopy(chance.choice(ODD))
        case "s":
            other, its = chance.choice(places)
            holder[key] = copy.deepcopy(other[its])
        case _:
            del holder[key]


def leaves(value: Any) -> Iterator[tuple[Any, Any]]:
    """Every place in it: what holds it, and its key there."""
    for key in list(value) if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ():
        yield value, key
        yield from leaves(value[key])


def test_no_name_means_two_things() -> None:
    """Each definition is of one type: what the reference says of a type of that name, it says once, and each place in
    the machine file leads to the type that the reference has there."""
    reference = json.loads(_core.reference())["machine"]
    meanings: dict[str, set[str]] = {}

    def walk(shown: dict[str, Any], schema: dict[str, Any]) -> None:
        schema = next((one for one in schema.get("anyOf", ()) if one.get("type") != "null"), schema)
        if shown["kind"] == "optional":
            walk(shown["element"], schema)
        elif shown["kind"] == "list":
            walk(shown["element"], schema["items"])
        elif shown["kind"] in ("struct", "enum"):
            name = schema.get("$ref", "#/$defs/").removeprefix("#/$defs/")
            definition = SCHEMA["$defs"][name] if name else schema
            meanings.setdefault(name, set()).add(json.dumps(shown, sort_keys=True))
            assert definition["description"] == shown["about"], name
            if shown["kind"] == "enum":
                assert [v["const"] for v in definition["oneOf"]] == [v["name"] for v in shown["values"]], name
            else:
                fields = [f for f in shown["fields"] if f["presence"] != "internal"]
                assert list(definition["properties"]) == [f["name"] for f in fields], name
                for field in fields:
                    walk(field["type"], definition["properties"][field["name"]])

    walk(reference, SCHEMA)
    assert meanings.keys() - {""} == SCHEMA["$defs"].keys()
    assert {name: len(of) for name, of in meanings.items() if len(of) > 1} == {}
    titles = Counter(definition["title"] for definition in SCHEMA["$defs"].values() if "title" in definition)
    assert [title for title, count in titles.items() if count > 1] == []


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"axis": []}, "axis"),
        ({"axes": [{"name": "x"}]}, "limits"),
        ({"cycle": {"period_s": 1}}, "maximum"),
        ({"tracks": [{"name": "t", "elements": [{"shape": "spline", "to": {"x": 1, "y": 1}}]}]}, "spline"),
    ],
)
def test_it_refuses_mistakes(change: dict[str, Any], said: str) -> None:
    machine = {"name": "small", **MINIMAL["axis"], **change}
    assert not is_machine(json.dumps(machine))
    assert said in wrong(machine)
