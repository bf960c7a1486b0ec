#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the measures and warnings of flaps by brute force; shares no code with the program.

usage: check_flaps.py FILE
The first line of FILE has the bones (JSON, m), each further line one flap: what was given and what the program said.
Vessels are walked along in steps, bodies are sampled, the donor's triangles are cut plane by plane. Of the ways to the
sites it checks the ends, the length, and that they keep off the bone; of every tenth flap also that no way over a grid
is shorter. Prints each disagreement; the exit code is 1 when there is one.
"""
import collections
import json
import sys

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

MM = 1e-3
FREE = 0.89  # of the length in the leg
STIFFNESS = 3.6e-6 * 62e3 / 0.12  # N: 62 kPa at 12 % on 3.6 mm²
LIMB = 15 * MM  # a cut of the jaw counts as at least so wide
FAR = 1.0


def unit(v):
    v = np.asarray(v, float)
    return v / np.linalg.norm(v)


def lengths(line):
    return np.linalg.norm(np.diff(line, axis=0), axis=1)


def walked(line, step):
    """Points along a polyline, its own included, at most `step` apart; with the place of each along it."""
    points, at, s = [line[:1]], [np.zeros(1)], 0.0
    for a, b, length in zip(line[:-1], line[1:], lengths(line)):
        count = max(int(np.ceil(length / step)), 1)
        t = np.arange(1, count + 1)[:, None] / count
        points.append(a + t * (b - a))
        at.append(s + t[:, 0] * length)
        s += length
    return np.concatenate(points), np.concatenate(at)


def thinned(a, b, every=20):
    return np.append(np.arange(a, b - 1, every), b - 1)


def resampled(line, count):
    at = np.concatenate([[0.0], np.cumsum(lengths(line))])
    wanted = np.linspace(0.0, at[-1], count)
    return np.stack([np.interp(wanted, at, line[:, k]) for k in range(3)], axis=1)


def surface_points(mesh, spacing):
    """Points on all triangles, at most about `spacing` apart."""
    v, t = np.array(mesh["vertices"]), np.array(mesh["triangles"])
    corners = v[t]
    longest = np.max([np.linalg.norm(corners[:, k] - corners[:, (k + 1) % 3], axis=1) for k in range(3)], axis=0)
    parts, made = np.ceil(longest / spacing).astype(int), [v]
    for n in np.unique(parts):
        some = corners[parts == n]
        for i in range(n + 1):
            for j in range(n + 1 - i):
                w = np.array([i, j, n - i - j]) / n
                made.append(np.einsum("k,tkx->tx", w, some))
    return np.concatenate(made)


class Bone:
    """How far a point is from a closed surface; negative inside. The points of a donor may be cut by planes."""

    def __init__(self, mesh):
        self.v, self.t = np.array(mesh["vertices"]), np.array(mesh["triangles"])
        self.tree = cKDTree(surface_points(mesh, 0.5 * MM))
        corners = self.v[self.t]
        self.middle = cKDTree(corners.mean(axis=1))
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        self.normal = normal / np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
        self.edges = np.unique(np.sort(np.concatenate([self.t[:, [0, 1]], self.t[:, [1, 2]], self.t[:, [2, 0]]]),
                                       axis=1), axis=0)

    def distance(self, p, most=20 * MM, is_sure=False):
        away = np.minimum(self.tree.query(p, distance_upper_bound=most)[0], most)
        near = self.middle.query(p)[1]
        behind = np.einsum("px,px->p", p - self.v[self.t[near]].mean(axis=1), self.normal[near]) < 0
        # Beside an edge or a large triangle the nearest middle may be of another side: the solid angle does not err.
        if is_sure:
            doubt = np.flatnonzero(behind & (away < most))
            behind[doubt] = self.encloses(p[doubt])
        return np.where(behind & (away < most), -away, away)

    def encloses(self, p):
        """By the solid angle under which the surface is seen (van Oosterom and Strackee 1983)."""
        inside = np.zeros(len(p), bool)
        for n, point in enumerate(p):
            a, b, c = ((self.v - point)[self.t[:, k]] for k in range(3))
            la, lb, lc = (np.sqrt(np.einsum("tx,tx->t", x, x)) for x in (a, b, c))
            over = np.einsum("tx,tx->t", a, np.cross(b, c))
            under = (la * lb * lc + np.einsum("tx,tx->t", a, b) * lc + np.einsum("tx,tx->t", b, c) * la
                     + np.einsum("tx,tx->t", c, a) * lb)
            inside[n] = abs(2.0 * np.arctan2(over, under).sum()) > 2.0 * np.pi
        return inside

    def rim(self, origin, normal):
        h = (self.v - origin) @ normal
        crossing = self.edges[(h[self.edges[:, 0]] < 0) != (h[self.edges[:, 1]] < 0)]
        t = h[crossing[:, 0]] / (h[crossing[:, 0]] - h[crossing[:, 1]])
        return self.v[crossing[:, 0]] + t[:, None] * (self.v[crossing[:, 1]] - self.v[crossing[:, 0]])


# Bodies: a list of (kind, numbers) with the points of their axis or box, and distances of points from them.
def from_axis(p, a, b):
    d = b - a
    t = np.clip((p - a) @ d / max(d @ d, 1e-300), 0, 1)
    return np.linalg.norm(p - a - t[:, None] * d, axis=1)


def from_box(p, centre, axes, half):
    local = (p - centre) @ axes
    return np.linalg.norm(np.maximum(np.abs(local) - half, 0), axis=1)


def from_disc(p, centre, normal, radius):
    h = (p - centre) @ normal
    out = np.linalg.norm(p - centre - h[:, None] * normal, axis=1) - radius
    return np.hypot(h, np.maximum(out, 0))


def boxes_apart(a, b):
    """Between two boxes, by projecting back and forth until nothing moves."""
    p, least_a, least_b = a[0], -a[2], -b[2]
    for _ in range(3000):
        q = b[0] + b[1] @ np.minimum(np.maximum((p - b[0]) @ b[1], least_b), b[2])
        before, p = p, a[0] + a[1] @ np.minimum(np.maximum((q - a[0]) @ a[1], least_a), a[2])
        if np.abs(p - before).max() < 1e-11:
            break
    return np.linalg.norm(p - q)


def boxes_of(plate):
    points, outward = np.array(plate["points_m"]), np.array(plate["outward"])
    boxes = []
    for n in range(len(points) - 1):
        along = points[n + 1] - points[n]
        length = np.linalg.norm(along)
        if length < 1e-9:
            continue
        along = along / length
        out = outward[n] + outward[n + 1]
        out = unit(out - (out @ along) * along)
        axes = np.stack([along, np.cross(out, along), out], axis=1)
        boxes.append((0.5 * (points[n] + points[n + 1]) + 0.5 * plate["thickness_m"] * out, axes,
                      0.5 * np.array([length, plate["width_m"], plate["thickness_m"]])))
    return boxes


def bodies_of(given):
    """name, plate, is_plate, rods (a, b, radius), boxes"""
    all_of = []
    for n, plate in enumerate(given["plates"]):
        all_of.append((f"plate '{plate['name']}'", n, True, [], boxes_of(plate)))
        for k, s in enumerate(plate["screws"]):
            head, axis = np.array(s["head_m"]), np.array(s["axis"])
            all_of.append((f"screw {k + 1} of plate '{plate['name']}'", n, False,
                           [(head, head + s["length_m"] * axis, 0.5 * s["diameter_m"])], []))
    for i in given["implants"]:
        head, axis = np.array(i["head_m"]), np.array(i["axis"])
        all_of.append((f"implant '{i['name']}'", None, False,
                       [(head, head + i["length_m"] * axis, 0.5 * i["diameter_m"])], []))
    return all_of


def from_body(p, body):
    away = [from_axis(p, a, b) - r for a, b, r in body[3]] + [from_box(p, *box) for box in body[4]]
    return np.min(away, axis=0)


def bodies_apart(a, b):
    if a[3]:
        start, end, radius = a[3][0]
        return from_body(walked(np.array([start, end]), 0.02 * MM)[0], b).min() - radius
    if b[3]:
        return bodies_apart(b, a)
    least = np.inf
    for one in a[4]:
        for other in b[4]:
            if np.linalg.norm(one[0] - other[0]) - np.linalg.norm(one[2]) - np.linalg.norm(other[2]) < least:
                least = min(least, boxes_apart(one, other))
    return least


class Flap:
    def __init__(self, item, donor, stumps):
        self.given, self.said, self.donor, self.stumps = item["given"], item["said"], donor, stumps
        self.tumour = np.array(item["tumour"]).reshape(-1, 3)
        self.wrong = []
        given = self.given
        self.poses = [(np.array(m)[:, :3], np.array(m)[:, 3]) for m in item["poses"]]
        self.origins = [np.array(p["origin_m"]) for p in given["planes"]]
        axes = [unit(b - a) for a, b in zip(self.origins, self.origins[1:])]
        self.count = len(axes)
        self.normals = []
        for n, p in enumerate(given["planes"]):
            bisector = unit(axes[max(n - 1, 0)] + axes[min(n, self.count - 1)])
            normal = unit(p["normal"]) if "normal" in p else bisector
            self.normals.append(normal if normal @ bisector > 0 else -normal)
        self.point, self.line = np.array(given["line"]["point_m"]), unit(given["line"]["direction"])
        # Each segment's planes in the donor, the lower one first, both normals upwards.
        self.cuts = []
        for n, (turn, shift) in enumerate(self.poses):
            ends = [(turn.T @ (self.origins[n + e] - shift), turn.T @ self.normals[n + e]) for e in (0, 1)]
            if (ends[1][0] - ends[0][0]) @ self.line < 0:
                ends.reverse()
            self.cuts.append([(o, v if v @ self.line > 0 else -v) for o, v in ends])

    def expect(self, name, mine, theirs, tolerance):
        if (mine is None) != (theirs is None) or (mine is not None and abs(mine - theirs) > tolerance):
            self.wrong.append(f"{name}: {mine} here, {theirs} there")

    def on(self, p):
        """The segment on which each point of the donor lies; -1: none."""
        found = np.full(len(p), -1)
        for n in reversed(range(self.count)):
            (o0, n0), (o1, n1) = self.cuts[n]
            found[((p - o0) @ n0 >= 0) & ((p - o1) @ n1 <= 0)] = n
        return found

    def to_jaw(self, segment, p):
        turn, shift = self.poses[segment]
        return p @ turn.T + shift

    def parts(self, vessel):
        """Pedicle length and where it leaves; runs on segments in the jaw's frame; spans (from, to, length, path)."""
        line = np.array(vessel["points_m"])
        if (line[-1] - line[0]) @ self.line > 0:
            line = line[::-1]
        p, at = walked(line, 0.005 * MM)
        on = self.on(p)
        change = np.flatnonzero(np.diff(on)) + 1
        runs = [(on[a], a, b) for a, b in zip(np.concatenate([[0], change]), np.concatenate([change, [len(p)]]))]
        attached = [(n, a, b) for n, a, b in runs if n >= 0]
        pedicle, spans = None, []
        if attached and runs[0][0] < 0:
            n, a, b = attached[0]
            pedicle = (at[a], self.to_jaw(n, p[a]), self.to_jaw(n, p[a:b]), at[a:b] - at[a])
        for (n, a, b), (m, c, d) in zip(attached, attached[1:]):
            if c > b:
                spans.append((n, m, at[c] - at[b - 1], np.linalg.norm(self.to_jaw(n, p[b - 1]) - self.to_jaw(m, p[c]))))
        return pedicle, [self.to_jaw(n, p[thinned(a, b)]) for n, a, b in attached], spans

    def bone_distance(self, p, near=20 * MM, is_sure=False):
        """Of points in the jaw's frame from stumps and segments; of segments beside their cuts a lower bound."""
        least = np.full(len(p), near)
        for stump in self.stumps:
            least = np.minimum(least, stump.distance(p, near, is_sure))
        for n, (turn, shift) in enumerate(self.poses):
            at = (p - shift) @ turn
            (o0, n0), (o1, n1) = self.cuts[n]
            beyond = np.maximum((o0 - at) @ n0, (at - o1) @ n1)
            some = beyond < least
            if some.any():
                inside = self.donor.distance(at[some], near, is_sure)
                least[some] = np.minimum(least[some], np.maximum(beyond[some], inside))
        return least

    def check_vessels(self):
        self.lines, self.radius, self.expected_reaches = {}, {}, {}
        spans = []
        for vessel in self.given["vessels"]:
            name = vessel["name"]
            self.radius[name] = vessel["radius_m"]
            pedicle, on_bone, between = self.parts(vessel)
            # What is on the bone, and straight spans between.
            self.lines[name] = [np.concatenate(on_bone)] if on_bone else []
            spans += [(name, *s) for s in between]
            said = [r for r in self.said["reaches"] if r["vessel"] == name]
            sites = [s for s in self.given["sites"] if s["kind"] == vessel["kind"]] if pedicle else []
            if [r["site"] for r in said] != [s["name"] for s in sites]:
                self.wrong.append(f"{name}: sites {[s['name'] for s in sites]} here, {[r['site'] for r in said]} there")
                continue
            for r, site in zip(said, sites):
                self.check_reach(vessel, pedicle, r, np.array(site["at_m"]))
        theirs = self.said["spans"]
        if [s[:3] for s in spans] != [tuple(s[:3]) for s in theirs]:
            self.wrong.append(f"spans {spans} here, {theirs} there")
        self.spans = spans
        for mine, other in zip(spans, theirs):
            self.expect("span in situ", mine[3], other[3], 0.03 * MM)
            self.expect("span path", mine[4], other[4], 0.03 * MM)

    def check_reach(self, vessel, pedicle, r, site):
        what = f"{r['vessel']} to {r['site']}"
        length, leaves, lead, lead_at = pedicle
        points = np.array(r["points"])
        self.expect(what + " in situ", length, r["in_situ"], 0.02 * MM)
        self.expect(what + " free", FREE * length, r["free"], 0.02 * MM)
        if np.linalg.norm(points[0] - leaves) > 0.02 * MM or np.linalg.norm(points[-1] - site) > 1e-9:
            self.wrong.append(f"{what}: the way has other ends")
        path = lengths(points).sum()
        # Between the points it lies round bone, not on the chord: at most a little longer.
        self.expect(what + " path", path, r["path"], 2e-3 * path)
        if r["path"] < np.linalg.norm(site - leaves) - 0.03 * MM:
            self.wrong.append(f"{what}: shorter than straight")
        radius = vessel["radius_m"]
        ends = np.minimum(np.linalg.norm(points - points[0], axis=1), np.linalg.norm(points - points[-1], axis=1))
        inner = points[ends > 3 * radius]
        if len(inner) and r["settled"]:
            away = self.bone_distance(inner) - radius
            deep = away.min()
            if deep < -0.6 * MM:
                deep = (self.bone_distance(inner[away < -0.6 * MM], is_sure=True) - radius).min()
            if deep < -0.6 * MM:
                self.wrong.append(f"{what}: the way runs {-deep / MM:.2f} mm too deep in bone")
        strain = max(r["path"] / (FREE * r["in_situ"]) - 1, 0) if r["in_situ"] > 0 else np.inf
        self.expect(what + " strain", strain, r["strain"], 1e-6)
        self.expect(what + " slack", max(FREE * r["in_situ"] - r["path"], 0), r["slack"], 1e-9)
        self.expect(what + " tension", STIFFNESS * strain if vessel["kind"] == "artery" else None, r["tension"], 1e-6)
        # With the last 10 mm on the bone.
        line = np.concatenate([lead[lead_at <= 10 * MM][::-1], points])
        whole = lengths(line).sum()
        fine = resampled(line, int(np.ceil(whole / (0.25 * MM))) + 1)
        k = int(round(5 * MM / (whole / (len(fine) - 1))))
        bend = None
        if len(fine) > 2 * k:
            a, b = fine[k:-k] - fine[:-2 * k], fine[2 * k:] - fine[k:-k]
            turn = np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), np.einsum("px,px->p", a, b))
            # The arc that begins and ends in the middle of both pieces.
            half = 0.25 * (np.linalg.norm(a, axis=1) + np.linalg.norm(b, axis=1))
            bend = (half / np.tan(np.maximum(turn, 1e-9) / 2)).min()
        r["my_bend"] = bend
        for key, pick in (("to_plate", lambda b: b[2]), ("to_screw", lambda b: b[1] is not None and not b[2])):
            bodies = [b for b in bodies_of(self.given) if pick(b)]
            mine = None
            if bodies:
                p = walked(points, 0.1 * MM)[0]
                away = np.min([from_body(p, b) for b in bodies], axis=0)
                # Past a corner the nearest point lies between two samples.
                k = int(np.argmin(away))
                fine = walked(p[max(k - 1, 0):k + 2], 1e-3 * MM)[0]
                mine = min(from_body(fine, b).min() for b in bodies)
            self.expect(f"{what} {key}", None if mine is None else mine - radius, r[key], 6e-3 * MM)

    def check_twists(self):
        reaches = self.said["reaches"]
        kind = {v["name"]: v["kind"] for v in self.given["vessels"]}
        veins = [r for r in reaches if kind[r["vessel"]] == "vein"]
        for r in reaches:
            mine = None
            if veins and kind[r["vessel"]] == "artery":
                vein = min(veins, key=lambda v: v["strain"])
                p = np.array(r["points"])
                sites = [np.array(s["at_m"]) for s in self.given["sites"] if s["kind"] == "vein"]
                to = min(sites, key=lambda s: np.linalg.norm(s - p[-1])) - p[-1]
                side = np.array(vein["points"][0]) - p[0]
                d = np.diff(p, axis=0)
                first, last = unit(d[0]), unit(d[-1])
                side, to = side - (side @ first) * first, to - (to @ last) * last
                if np.linalg.norm(side) >= 0.5 * MM and np.linalg.norm(to) >= 0.5 * MM:
                    for a, b in zip(d, d[1:]):
                        # Two mirrors make the least turn from one direction to the next.
                        a, b = unit(a), unit(b)
                        for mirror in (a, a + b):
                            side = side - 2 * (side @ mirror) / (mirror @ mirror) * mirror
                    side = side - (side @ last) * last
                    mine = np.arctan2(np.cross(side, to) @ last, side @ to)
            r["my_twist"] = mine
            if mine is not None and r["twist"] is not None and abs(abs(mine) - np.pi) < 1e-3:
                continue
            self.expect(f"{r['vessel']} to {r['site']} twist", mine, r["twist"], 1e-3)

    def best(self, name):
        all_of = [r for r in self.said["reaches"] if r["vessel"] == name]
        return min(all_of, key=lambda r: (r["strain"], -r["slack"])) if all_of else None

    def discs(self):
        found = []
        for n, (origin, normal) in enumerate(zip(self.origins, self.normals)):
            radius = 0.0
            for k in (n - 1, n):
                if not 0 <= k < self.count:
                    continue
                turn, shift = self.poses[k]
                at, v = turn.T @ (origin - shift), turn.T @ normal
                rim = self.donor.rim(at, v)
                if len(rim):
                    radius = max(radius, np.linalg.norm(rim - at, axis=1).max())
            if n in (0, self.count):
                radius = max(radius, LIMB)
            found.append((origin, normal, radius))
        return found

    def check_clearances(self):
        bodies, discs, mine = bodies_of(self.given), self.discs(), {}
        kind = {v["name"]: v["kind"] for v in self.given["vessels"]}
        courses = {}
        for name, lines in self.lines.items():
            lines = list(lines)
            if best := self.best(name):
                lines.append(np.array(best["points"]))
            courses[name] = [walked(line, 0.1 * MM)[0] for line in lines if len(line) > 1]
        for n, body in enumerate(bodies):
            found = []
            if not body[2]:
                start, end, radius = body[3][0]
                p = walked(np.array([start, end]), 0.02 * MM)[0]
                found += [("cut", f"cut {k + 1}", from_disc(p, *d).min() - radius) for k, d in enumerate(discs)]
            for name, lines in courses.items():
                for line in lines:
                    found.append(("vessel", f"{kind[name]} '{name}'", from_body(line, body).min() - self.radius[name]))
            for k, other in enumerate(bodies):
                one_plate = body[1] is not None and body[1] == other[1] and (body[2] or other[2])
                if k != n and not one_plate:
                    found.append(("hardware", other[0], bodies_apart(body, other)))
            for sort in ("cut", "vessel", "hardware"):
                some = [f for f in found if f[0] == sort]
                if some:
                    mine[body[0], sort] = min(some, key=lambda f: f[2])[1:]
        theirs = {(c[0], c[1]): (c[2], c[3]) for c in self.said["clearances"]}
        if set(mine) != set(theirs):
            self.wrong.append(f"clearances of {sorted(set(mine) ^ set(theirs))} are on one side only")
        for key in set(mine) & set(theirs):
            # Overlapping rods are measured by their axes in both.
            self.expect(f"{key} {mine[key][0]} {theirs[key][0]}", mine[key][1], theirs[key][1], 0.03 * MM)
        self.clear = mine

    def check_warnings(self):
        given, said = self.given, self.said
        limits = given["limits"]
        expected, unsure = set(), set()

        def rule(code, who, is_so, margin):
            """`margin`: how far the number is from its limit, over what may differ."""
            if margin < 1:
                unsure.add((code, who))
            elif is_so:
                expected.add((code, who))

        for (who, sort), (_, away) in self.clear.items():
            rule("near-" + sort, who, away < limits["clearance_m"], abs(away - limits["clearance_m"]) / (0.03 * MM))
        along = [(o - self.point) @ self.line for pair in self.cuts for o, _ in pair]
        kept = []
        for p in given["perforators"]:
            at, who = np.array(p["at_m"]), f"perforator '{p['name']}'"
            away = min(abs((at - o) @ n) for pair in self.cuts for o, n in pair)
            on = self.on(at[None])[0]
            if on >= 0:
                kept.append(at)
            s = (at - self.point) @ self.line
            if on < 0:
                if min(along) < s < max(along):
                    expected.add(("perforator-lost", who))
            else:
                rule("perforator-on-cut", who, away < limits["perforator_to_cut_m"],
                     abs(away - limits["perforator_to_cut_m"]) / 1e-8)
        if "paddle" in given:
            at = np.array(given["paddle"]["at_m"])
            near = min((abs((p - at) @ self.line) for p in kept), default=np.inf)
            half = 0.5 * given["paddle"]["length_m"]
            rule("paddle-without-perforator", "paddle", near > half, abs(near - half) / 1e-8)
        taken = given["resection"]
        planes = [(o, n) for o, n, there in
                  ((self.origins[0], self.normals[0], taken in ("between", "after-first")),
                   (self.origins[-1], -self.normals[-1], taken in ("between", "before-last"))) if there]
        margin = min(((self.tumour - o) @ n).min() for o, n in planes) if planes and len(self.tumour) else None
        self.expect("tumour margin", margin, said["tumour_margin"], 1e-9)
        if margin is not None:
            rule("tumour-margin", "tumour", margin < given["margin_m"], abs(margin - given["margin_m"]) / 1e-8)
        kinds = [v["kind"] for v in given["vessels"]]
        site_kinds = [s["kind"] for s in given["sites"]]
        for kind in ("artery", "vein"):
            if kinds and kind not in kinds:
                expected.add(("no-" + kind, kind))
        for v in given["vessels"]:
            who, r = f"{v['kind']} '{v['name']}'", self.best(v["name"])
            if r is None:
                if v["kind"] in site_kinds:
                    expected.add(("no-pedicle", who))
                elif site_kinds:
                    expected.add(("no-site", who))
                continue
            in_leg, most = 1 / FREE - 1, (1 + limits["over_in_situ"]) / FREE - 1
            rule("too-short", who, r["strain"] > most, abs(r["strain"] - most) / 1e-6)
            rule("stretched", who, in_leg < r["strain"] <= most,
                 min(abs(r["strain"] - most), abs(r["strain"] - in_leg)) / 1e-6)
            # The worst place is found to a step of each.
            least, bend = limits["kink_radii"] * v["radius_m"], r["my_bend"]
            if bend is not None:
                rule("kinked", who, bend < least and r["slack"] < np.pi * least,
                     min(abs(bend / least - 1) / 0.02, abs(r["slack"] - np.pi * least) / 1e-8)
                     if bend < 1.02 * least else 2)
            if r["my_twist"] is not None:
                rule("twisted", who, abs(r["my_twist"]) > limits["twist_rad"],
                     abs(abs(r["my_twist"]) - limits["twist_rad"]) / 2e-3)
        for name, _, _, in_situ, path in self.spans:
            strain = path / (FREE * in_situ) - 1
            rule("span-stretched", name, strain > 1 / FREE - 1, abs(path / in_situ - 1) * in_situ / (0.05 * MM))
        warned = [(w[0], w[1]) for w in said["warnings"]]
        if expected - set(warned) - unsure or set(warned) - expected - unsure:
            self.wrong.append(f"warnings: only here {sorted(expected - set(warned) - unsure)}, only there "
                              f"{sorted(set(warned) - expected - unsure)}")
        return [code for code, _ in warned]

    def check_shortest(self):
        """No way over a grid of 2 mm, straightened, is shorter than the one that was found."""
        step = 2 * MM
        for r in self.said["reaches"]:
            points = np.array(r["points"])
            straight = np.linalg.norm(points[-1] - points[0])
            radius = self.radius[r["vessel"]]
            # Two radii round each end are open to the grid: of a short way that is most.
            if not r["settled"] or r["path"] < max(1.01 * straight, 10 * radius):
                continue
            low, high = points.min(axis=0) - 25 * MM, points.max(axis=0) + 25 * MM
            shape = np.ceil((high - low) / step).astype(int) + 1
            grid = np.stack(np.meshgrid(*[np.arange(k) for k in shape], indexing="ij"), axis=-1).reshape(-1, 3)
            place = low + step * grid
            ends = np.minimum(np.linalg.norm(place - points[0], axis=1), np.linalg.norm(place - points[-1], axis=1))
            is_open = (self.bone_distance(place, 6 * MM) > radius) | (ends < 2 * radius)
            number = np.arange(len(place)).reshape(shape)
            rows, columns, costs = [], [], []
            for offset in np.ndindex(3, 3, 3):
                d = np.array(offset) - 1
                if tuple(d) <= (0, 0, 0):
                    continue
                here = tuple(slice(max(-k, 0), shape[a] - max(k, 0)) for a, k in enumerate(d))
                there = tuple(slice(max(k, 0), shape[a] - max(-k, 0)) for a, k in enumerate(d))
                a, b = number[here].ravel(), number[there].ravel()
                both = is_open[a] & is_open[b]
                rows.append(a[both])
                columns.append(b[both])
                costs.append(np.full(both.sum(), step * np.linalg.norm(d)))
            graph = coo_matrix((np.concatenate(costs), (np.concatenate(rows), np.concatenate(columns))),
                               (len(place), len(place))).tocsr()
            opened = np.flatnonzero(is_open)
            begin, end = (opened[np.argmin(np.linalg.norm(place[opened] - q, axis=1))] for q in (points[0], points[-1]))
            _, before = dijkstra(graph, directed=False, indices=begin, return_predecessors=True)
            if before[end] < 0:
                continue
            way = [end]
            while way[-1] != begin:
                way.append(before[way[-1]])
            line = np.concatenate([points[:1], place[way[::-1]], points[-1:]])
            # Each corner goes straight on to the farthest one that it sees.
            pulled, at = [line[0]], 0
            while at + 1 < len(line):
                to = len(line) - 1
                while to > at + 1:
                    p = walked(line[[at, to]], 0.7 * MM)[0]
                    off = np.minimum(np.linalg.norm(p - points[0], axis=1), np.linalg.norm(p - points[-1], axis=1))
                    p = p[off > 2 * radius]
                    if not len(p) or self.bone_distance(p, 6 * MM).min() > radius - 0.1 * MM:
                        break
                    to -= 1
                pulled.append(line[to])
                at = to
            mine = lengths(np.array(pulled)).sum()
            if r["path"] > 1.015 * mine + 0.5 * MM:
                self.wrong.append(f"{r['vessel']} to {r['site']}: {r['path'] / MM:.2f} mm, but {mine / MM:.2f} mm do")


def main(path):
    with open(path) as file:
        bones = json.loads(file.readline())
        donor, stumps = Bone(bones["donor"]), [Bone(s) for s in bones["stumps"]]
        flaps = failures = 0
        seen = collections.Counter()
        for number, text in enumerate(file):
            flap = Flap(json.loads(text), donor, stumps)
            flap.check_vessels()
            flap.check_twists()
            flap.check_clearances()
            seen.update(flap.check_warnings())
            if number % 10 == 0:
                flap.check_shortest()
            flaps += 1
            failures += bool(flap.wrong)
            for line in flap.wrong[:4] if failures < 15 else []:
                print(f"flap {number}: {line}")
    print(f"{flaps} flaps, {failures} wrong; warnings: {dict(sorted(seen.items()))}")
    few = [code for code in ("near-cut", "near-vessel", "near-hardware", "perforator-on-cut", "perforator-lost",
                             "paddle-without-perforator", "tumour-margin", "no-artery", "no-vein", "no-site",
                             "no-pedicle", "too-short", "stretched", "kinked", "twisted", "span-stretched")
           if seen[code] < 2]
    if few and flaps >= 100:
        print("too few to tell:", few)
    return 1 if failures or (few and flaps >= 100) else 0


sys.exit(main(sys.argv[1]))
