#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Turns `tactus nodes --json` (standard input) into reference/nodes.md (standard output).

The argument is nodes/catalogue.cpp, which knows the family of each type."""
import json
import os
import re
import sys

NOTE = "<!-- Written by docs/generate.sh; edit the declarations in the source instead. -->"


def snake(name):
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()


def table(title, columns, rows):
    if not rows:
        return
    print(f"\n| {title} | " + " | ".join(columns) + " |")
    print("|---" * (len(columns) + 1) + "|")
    for row in rows:
        print("| " + " | ".join(str(value).replace("|", "\\|") for value in row) + " |")


def code(name):
    return f"`{name}`"


def values_of(param):
    """What a parameter may be."""
    if "options" in param:
        return ", ".join(param["options"])
    if "min" in param:
        return f'{param["min"]} … {param["max"]}'
    return param["kind"]


def print_node(node, family):
    print(f'\n## {node["type"]}\n\n*{family}.* {node["about"]}')
    picture = os.path.join(os.path.dirname(os.path.abspath(__file__)), "pictures/responses", node["type"] + ".svg")
    if os.path.exists(picture):
        print(f'\n![Response of {node["type"]}](../pictures/responses/{node["type"]}.svg)')
    inputs = [(code(p["name"]), p["type"], p["unit"], p["about"], "" if p["optional"] else "yes")
              for p in node["inputs"]]
    table("input", ["type", "unit", "what", "required"], inputs)
    outputs = [(code(p["name"]), p["type"], p["unit"], p["about"]) for p in node["outputs"]]
    table("output", ["type", "unit", "what"], outputs)
    params = [(code(p["name"]), p.get("default", ""), values_of(p), "yes" if p.get("live") else "", p["about"])
              for p in node["parameters"]]
    table("parameter", ["default", "values", "live", "what"], params)


def families_of(path, nodes):
    """The types of each family, from nodes/catalogue.cpp."""
    families = {}
    with open(path, encoding="utf-8") as catalogue:
        for name, family in re.findall(r"X\((\w+), (\w+)\)", catalogue.read()):
            if snake(name) in nodes:
                families.setdefault(family, []).append(snake(name))
    return families


def main():
    nodes = {node["type"]: node for node in json.load(sys.stdin)["rows"]}
    families = families_of(sys.argv[1], nodes)
    print(f"""{NOTE}

# Nodes

All node types by family. `tactus nodes` lists them, `tactus nodes TYPE` prints one, `--json` prints them for programs.

A wire ends at an input, or at a parameter that has a range. *Live*: `tactus set` or saving the patch changes the
parameter without making the node anew. No unit: any, or a
bare number; an input or output of several types has the unit that its wires bring.
""")
    for family, types in sorted(families.items()):
        print(f"- **{family}**: " + ", ".join(f"[{name}](#{name})" for name in sorted(types)))
    for family, types in sorted(families.items()):
        for name in sorted(types):
            print_node(nodes[name], family)


if __name__ == "__main__":
    main()
