#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Turns `tactus nodes --json` (standard input) into reference/value-types.md (standard output): the types of value that each
node accepts and produces. The argument is nodes/catalogue.cpp, which lists the family of each type."""
import json
import re
import sys

from nodes_page import NOTE, families_of

TYPES = ["number", "bool", "signal", "vector", "pose", "twist", "wrench"]


def words(text):
    return set(re.findall(r"[a-z]+", text))


def cells(node):
    """For each type: 'in', 'out', 'in, out' or nothing; others by name."""
    ins, outs, several, others = set(), set(), set(), set()
    for port in node["inputs"]:
        kinds = set(TYPES) if port["type"] == "any" else words(port["type"]) & set(TYPES)
        if len(kinds) > 1:
            several |= kinds
        ins |= kinds
        if not kinds:
            others.add(port["type"])
    for port in node["outputs"]:
        if port["type"] == "type of the input":
            outs |= several
        elif port["type"] in TYPES:
            outs.add(port["type"])
        else:
            others.add(port["type"])
    row = [", ".join(word for word, kinds in (("in", ins), ("out", outs)) if kind in kinds) for kind in TYPES]
    return row + [", ".join(sorted(others))]


def main():
    nodes = {node["type"]: node for node in json.load(sys.stdin)["rows"]}
    print(f"""{NOTE}

# Types of nodes and of values

The types of value that each node accepts (*in*) and produces (*out*). If a node accepts several types, its wires determine the type, and
its output has the same type. A wire to a parameter carries a number, for every node. [Nodes](nodes.md) lists the ports and units of each.""")
    for family, types in sorted(families_of(sys.argv[1], nodes).items()):
        print(f"\n## {family}\n")
        print("| node | " + " | ".join(TYPES) + " | other |")
        print("|---" * (len(TYPES) + 2) + "|")
        for name in sorted(types):
            print(f"| [`{name}`](nodes.md#{name}) | " + " | ".join(cells(nodes[name])) + " |")


main()
