#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Checks fibula plans by brute force over the triangles of the donor; shares no code with the program.

usage: check_plans.py FILE
The first line of FILE is the donor (JSON, mm), each further line one plan: its inputs and what the program answered.
Pieces are cut by clipping triangles. Prints each disagreement; the exit code is 1 when there is one.
"""
import collections
import json
import sys

import numpy as np

NEAR = 20.0  # mm: the donor's other bones are farther from the line


def unit(v):
    return np.asarray(v, float) / np.linalg.norm(v)


def angle(a, b):
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b)), np.dot(a, b)))


def check(plan, vertices, triangles):
    given, said = plan["inputs"], plan["plan"]
    point, line = np.array(given["point"]), unit(given["direction"])
    around = vertices[triangles].mean(axis=1) - point
    near = np.linalg.norm(around - np.outer(around @ line, line), axis=1) < NEAR
    bone = triangles[near]
    edges = np.unique(np.sort(np.concatenate([bone[:, [0, 1]], bone[:, [1, 2]], bone[:, [2, 0]]]), axis=1), axis=0)
    used = np.unique(bone)
    along = (vertices - point) @ line

    origins = [np.array(p["origin"]) for p in given["planes"]]
    axes = [unit(b - a) for a, b in zip(origins, origins[1:])]
    count = len(axes)
    normals, off = [], []
    for n, p in enumerate(given["planes"]):
        bisector = unit(axes[max(n - 1, 0)] + axes[min(n, count - 1)])
        normal = unit(p["normal"]) if p["normal"] else bisector
        normals.append(normal if normal @ bisector > 0 else -normal)
        if 0 < n < count:
            off.append(angle(normals[-1], bisector))

    wrong, cuts = [], []
    shortest, longest, extents = [], [], []
    for n in range(count):
        m = np.array(said["segments"][n]["donor_to_target"])
        turn, shift = m[:3, :3], m[:3, 3]
        if abs(turn @ turn.T - np.eye(3)).max() > 1e-9 or np.linalg.det(turn) < 0:
            wrong.append(f"segment {n}: not rigid")
        if angle(turn @ line, -axes[n] if given["reversed"] else axes[n]) > 1e-6:
            wrong.append(f"segment {n}: the line does not lie on the axis")
        ends = []
        for end in range(2):
            o = turn.T @ (origins[n + end] - shift)
            ends.append((o, turn.T @ normals[n + end]))
            if np.linalg.norm(o - point - ((o - point) @ line) * line) > 1e-6:
                wrong.append(f"segment {n}: an origin is off the line")
        cuts.append(ends)
        # The piece: where the first plane is behind and the second ahead.
        heights = [(vertices - o) @ normal for o, normal in ends]
        inside = used[(heights[0][used] >= 0) & (heights[1][used] <= 0)]
        reach = [along[inside]]
        lengths = []
        for h in heights:
            crossing = edges[(h[edges[:, 0]] < 0) != (h[edges[:, 1]] < 0)]
            t = h[crossing[:, 0]] / (h[crossing[:, 0]] - h[crossing[:, 1]])
            rim = vertices[crossing[:, 0]] + t[:, None] * (vertices[crossing[:, 1]] - vertices[crossing[:, 0]])
            reach.append((rim - point) @ line)
            to = [((o - rim) @ normal) / (normal @ line) for o, normal in ends]
            lengths.append((to[1] - to[0]) * (-1 if given["reversed"] else 1))
        lengths = np.concatenate(lengths)
        shortest.append(lengths.min())
        longest.append(lengths.max())
        reach = np.concatenate(reach)
        extents.append((reach.min(), reach.max()))

    def close(name, mine, theirs, tolerance=2e-3):
        if len(mine) != len(theirs) or any(abs(a - b) > tolerance for a, b in zip(mine, theirs)):
            wrong.append(f"{name}: {mine} here, {theirs} there")

    order = range(count - 1, -1, -1) if given["reversed"] else range(count)
    gaps, top = [], None
    for n in order:
        if top is not None:
            gaps.append(extents[n][0] - top)
        top = extents[n][1] if top is None else max(top, extents[n][1])
    if given["reversed"]:
        gaps.reverse()
    distal = min(e[0] for e in extents) - along[used].min()
    proximal = along[used].max() - max(e[1] for e in extents)
    close("shortest", shortest, [s["shortest"] for s in said["segments"]])
    close("longest", longest, [s["longest"] for s in said["segments"]])
    close("clearances", gaps, said["clearances"])
    close("off bisector", off, said["off_bisector"], 1e-6)
    close("wedges", [angle(a[1][1], b[0][1]) for a, b in zip(cuts, cuts[1:])], said["wedges"], 1e-5)
    close("margins", [distal, proximal], said["left"])

    # A value at its limit may fall to either side.
    expected, unsure = set(), set()

    def rule(code, segment, value, limit, margin):
        if abs(value - limit) < margin:
            unsure.add((code, segment))
        elif value < limit:
            expected.add((code, segment))

    for n in range(count):
        if abs(shortest[n] - 15.0) < 2e-3 or abs(shortest[n] - 20.0) < 2e-3:
            unsure |= {("short-segment", n), ("very-short-segment", n)}
        elif shortest[n] < 20.0:
            expected.add(("very-short-segment" if shortest[n] < 15.0 else "short-segment", n))
    for n in range(count - 1):
        # Placed segments keep the wanted space to a millionth of a metre.
        rule("close-osteotomies", n, gaps[n], given["between"] - 1e-3, 2e-3)
        if gaps[n] > -2e-3:
            rule("wide-kerf", n, gaps[n], 2.0 * given["kerf"] - 1e-3, 2e-3)
        if abs(gaps[n]) < 2e-3:
            unsure.add(("wide-kerf", n))
        rule("section-mismatch", n, -off[n], -1.0, 1e-6)
    rule("distal-margin", order[0], distal, given["distal_margin"] - 1e-3, 2e-3)
    rule("proximal-margin", order[-1], proximal, given["proximal_margin"] - 1e-3, 2e-3)
    if line[2] < 0:
        expected.add(("line-downwards", -1))
    warned = [tuple(w) for w in said["warnings"]]
    if len(set(warned)) != len(warned):
        wrong.append("a warning is given twice")
    if expected - set(warned) - unsure or set(warned) - expected - unsure:
        wrong.append(f"warnings: {sorted(expected)} here, {sorted(warned)} there")
    return wrong, [code for code, _ in warned]


def main(path):
    with open(path) as file:
        donor = json.loads(file.readline())
        vertices, triangles = np.array(donor["vertices"], float), np.array(donor["triangles"])
        plans = failures = 0
        seen = collections.Counter()
        for number, text in enumerate(file):
            wrong, codes = check(json.loads(text), vertices, triangles)
            plans += 1
            seen.update(codes)
            failures += bool(wrong)
            for line in wrong[:3] if failures < 10 else []:
                print(f"plan {number}: {line}")
    print(f"{plans} plans, {failures} wrong; warnings: {dict(sorted(seen.items()))}")
    few = [code for code in ("short-segment", "very-short-segment", "close-osteotomies", "wide-kerf", "section-mismatch",
                             "distal-margin", "proximal-margin", "line-downwards") if seen[code] < plans / 50]
    if few:
        print("too few to tell:", few)
    return 1 if failures or few else 0


sys.exit(main(sys.argv[1]))
