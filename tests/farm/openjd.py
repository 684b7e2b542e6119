"""A small engine for templates of Open Job Description, by the rules of its schema 2023-09 that ours needs.

    openjd.py TEMPLATE.json NAME=VALUE...

It refuses what the schema does not know, expands each step to a task per value of its parameter space, and runs the command line of
every task with a shell. A step waits for those that it depends on, and is left out when a task of one has failed. It prints a line per
task, and ends with 1 if one has failed.
"""
from __future__ import annotations

import itertools
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
from typing import Any, Dict, Iterator, List, Set, Tuple

NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]{0,63}\Z")
CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f]")
REFERENCE = re.compile(r"\{\{\s*([A-Za-z0-9_.]+)\s*\}\}")

# The members of each object; those with an asterisk must be there.
MEMBERS = {
    "template": "*specificationVersion *name *steps description parameterDefinitions",
    "STRING": "*name *type description default allowedValues minLength maxLength",
    "PATH": "*name *type description default allowedValues minLength maxLength objectType dataFlow",
    "INT": "*name *type description default allowedValues minValue maxValue",
    "step": "*name *script description dependencies parameterSpace",
    "dependency": "*dependsOn",
    "space": "*taskParameterDefinitions",
    "task parameter": "*name *type *range",
    "script": "*actions",
    "actions": "*onRun",
    "action": "*command args timeout",
}


class Wrong(Exception):
    """The template breaks the schema."""


def demand(holds: Any, what: str) -> None:
    if not holds:
        raise Wrong(what)


def object_of(value: Any, kind: str) -> Dict[str, Any]:
    """The object, which has what this kind must have, and nothing that it cannot have."""
    demand(isinstance(value, dict), f"{kind}: not an object")
    known = MEMBERS[kind].split()
    strange = set(value) - {word.lstrip("*") for word in known}
    missing = {word[1:] for word in known if word[0] == "*"} - set(value)
    demand(not strange and not missing, f"{kind}: unknown {sorted(strange)}, missing {sorted(missing)}")
    demand(1 <= len(value.get("description", " ")) <= 2048, f"{kind}: length of its description")
    return dict(value)


def list_of(value: Any, kind: str, most: int) -> List[Dict[str, Any]]:
    demand(isinstance(value, list) and 1 <= len(value) <= most, f"{kind}: not a list of 1 to {most}")
    objects = [object_of(item, kind) for item in value]
    names = [item["name"] for item in objects if "name" in item]
    demand(len(names) == len(set(names)), f"{kind}: two of one name")
    return objects


def resolve(text: Any, values: Dict[str, str]) -> str:
    """A format string, which may name these values only."""
    demand(isinstance(text, str) and not CONTROL.search(text), f"{text!r}: not a string, or control characters")
    for name in REFERENCE.findall(text):
        demand(name in values, f"{text!r}: {name} is unknown here")
    demand("{{" not in REFERENCE.sub("", text), f"{text!r}: an expression that is none")
    return REFERENCE.sub(lambda match: values[match.group(1)], text)


def job_values(definitions: List[Any], given: Dict[str, str]) -> Tuple[Dict[str, str], Dict[str, str]]:
    """The values of the job's parameters by their references: those before a worker has the job, which has no paths yet, and on it."""
    early: Dict[str, str] = {}
    late: Dict[str, str] = {}
    for definition in definitions:
        kind = definition.get("type")
        demand(kind in ("STRING", "PATH", "INT"), f"parameter of type {kind}")
        object_of(definition, kind)
        name = definition["name"]
        demand(NAME.match(name), f"{name!r}: not a name")
        demand(name in given or "default" in definition, f"{name} is not given")
        value = str(given.get(name, definition.get("default")))
        demand(len(value) <= 1024, f"{name}: longer than 1024 characters")
        if kind == "PATH":
            value = os.path.join(os.getcwd(), value)
            demand(definition.get("objectType", "DIRECTORY") in ("FILE", "DIRECTORY"), f"{name}: objectType")
            demand(definition.get("dataFlow", "NONE") in ("NONE", "IN", "OUT", "INOUT"), f"{name}: dataFlow")
        if kind == "INT":
            demand(definition.get("minValue", int(value)) <= int(value), f"{name}: less than its least value")
        demand(value in map(str, definition.get("allowedValues", [value])), f"{name}: {value} is not allowed")
        early[f"RawParam.{name}"] = value
        late[f"Param.{name}"] = value
        if kind != "PATH":
            early[f"Param.{name}"] = value
    demand(set(given) <= {definition["name"] for definition in definitions}, "a parameter that the template has not")
    return early, {**early, **late}


def range_of(text: str) -> List[int]:
    """The whole numbers of "1-4,7-9:2", ascending."""
    numbers: List[int] = []
    for element in text.split(","):
        match = re.fullmatch(r"\s*(-?\d+)(?:\s*-\s*(-?\d+)(?::([1-9]\d*))?)?\s*", element)
        demand(match, f"{text!r}: not a range")
        assert match is not None
        first = int(match.group(1))
        numbers.extend(range(first, int(match.group(2) or first) + 1, int(match.group(3) or 1)))
    demand(numbers and len(numbers) == len(set(numbers)), f"{text!r}: empty, or ranges overlap")
    return sorted(numbers)


def tasks_of(step: Dict[str, Any], early: Dict[str, str]) -> Iterator[Dict[str, str]]:
    """The values of each task's own parameters: all combinations."""
    if "parameterSpace" not in step:
        return iter([{}])
    space = object_of(step["parameterSpace"], "space")
    axes = []
    for definition in list_of(space["taskParameterDefinitions"], "task parameter", 16):
        demand(definition["type"] == "INT" and NAME.match(definition["name"]), "task parameter: not an INT with a name")
        numbers = range_of(resolve(definition["range"], early))
        axes.append([{f"Task.{raw}Param.{definition['name']}": str(n) for raw in ("", "Raw")} for n in numbers])
    return ({name: value for part in parts for name, value in part.items()} for parts in itertools.product(*axes))


def command_line(step: Dict[str, Any], values: Dict[str, str]) -> str:
    script = object_of(step["script"], "script")
    action = object_of(object_of(script["actions"], "actions")["onRun"], "action")
    demand(action["command"], "an empty command")
    return shlex.join(resolve(word, values) for word in [action["command"], *action.get("args", [])])


def in_order(needs: Dict[str, Set[str]]) -> List[str]:
    """The steps, each behind those that it depends on."""
    order: List[str] = []
    while len(order) < len(needs):
        ready = [name for name, need in needs.items() if name not in order and need <= set(order)]
        demand(ready, "a step depends on none that there is, or steps on each other in a circle")
        order.append(ready[0])
    return order


def run(template: Any, given: Dict[str, str]) -> bool:
    object_of(template, "template")
    demand(template["specificationVersion"] == "jobtemplate-2023-09", "specificationVersion")
    early, late = job_values(template.get("parameterDefinitions", []), given)
    demand(1 <= len(resolve(template["name"], early)) <= 128, "length of the name")
    steps = list_of(template["steps"], "step", 1000)
    lines = {step["name"]: [command_line(step, {**late, **own}) for own in tasks_of(step, early)] for step in steps}
    needs = {step["name"]: {need["dependsOn"] for need in list_of(step["dependencies"], "dependency", 1000)}
             if "dependencies" in step else set() for step in steps}
    done: Dict[str, bool] = {}
    for name in in_order(needs):
        if not all(done[need] for need in needs[name]):
            print(f"{name}: left out")
            done[name] = False
            continue
        with tempfile.TemporaryDirectory() as session:
            codes = [subprocess.run(line, shell=True, check=False, cwd=session).returncode for line in lines[name]]
        print("\n".join(f"{name}: {code}" for code in codes))
        done[name] = not any(codes)
    return all(done.values())


def main() -> int:
    with open(sys.argv[1], encoding="utf-8") as file:
        template = json.load(file)
    try:
        return 0 if run(template, dict(word.split("=", 1) for word in sys.argv[2:])) else 1
    except Wrong as wrong:
        print(f"{sys.argv[1]}: {wrong}")
        return 2


if __name__ == "__main__":
    sys.exit(main())
