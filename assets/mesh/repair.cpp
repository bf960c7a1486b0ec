// SPDX-License-Identifier: Apache-2.0
#include "assets/mesh/repair.hpp"

#include "assets/mesh/mesh.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

namespace tactus::mesh {

namespace {

using Triangle = std::array<int, 3>;
constexpr double largest_hole_share = 0.05;

// A side of a triangle, with its points in ascending order.
struct Side {
    int low = 0, high = 0;
    bool forward = false;  // traversed from low to high
    int triangle = 0;
    std::pair<int, int> edge() const { return {low, high}; }
};

std::vector<Side> sides_of(const std::vector<Triangle>& triangles) {
    std::vector<Side> sides;
    sides.reserve(3 * triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (std::size_t c = 0; c < 3; ++c) {
            const int a = triangles[t][c], b = triangles[t][(c + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), a < b, static_cast<int>(t)});
        }
    leave_if_stopped();
    unsigned compared = 0;
    std::stable_sort(sides.begin(), sides.end(), [&compared](const Side& a, const Side& b) {
        if (++compared % (1 << 16) == 0) leave_if_stopped();
        return a.edge() < b.edge();
    });
    return sides;
}

// Calls visit(first, last) for the sides of each edge.
template <typename Visit>
void for_each_edge(const std::vector<Side>& sides, Visit visit) {
    for (std::size_t n = 0, m = 0; n < sides.size(); n = m) {
        while (m < sides.size() && sides[m].edge() == sides[n].edge()) ++m;
        visit(n, m);
    }
}

// Of duplicate triangles one is kept; none when both orientations are equally frequent.
std::size_t drop_duplicates(std::vector<Triangle>& triangles) {
    std::map<Triangle, std::vector<int>> groups;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (t % 4096 == 0) leave_if_stopped();
        Triangle key = triangles[t];
        std::sort(key.begin(), key.end());
        groups[key].push_back(static_cast<int>(t));
    }
    std::vector<bool> dropped(triangles.size(), false);
    leave_if_stopped();
    for (const auto& [key, members] : groups) {
        if (members.size() == 1) continue;
        int net = 0;
        const auto is_even = [&](int t) {
            const Triangle& v = triangles[static_cast<std::size_t>(t)];
            return (v[0] == key[0] && v[1] == key[1]) || (v[1] == key[0] && v[2] == key[1]) ||
                   (v[2] == key[0] && v[0] == key[1]);
        };
        for (const int t : members) net += is_even(t) ? 1 : -1;
        bool kept = net == 0;
        for (const int t : members) {
            const bool keep = !kept && is_even(t) == (net > 0);
            kept = kept || keep;
            dropped[static_cast<std::size_t>(t)] = !keep;
        }
    }
    std::size_t n = 0;
    return std::erase_if(triangles, [&](const Triangle&) { return dropped[n++]; });
}

// Orients triangles consistently: neighbours over a manifold edge traverse it in opposite directions. In each connected
// patch the smaller part is flipped.
std::size_t orient(std::vector<Triangle>& triangles) {
    struct Link {
        int to;
        bool differs;
    };
    std::vector<std::vector<Link>> links(triangles.size());
    const std::vector<Side> sides = sides_of(triangles);
    for_each_edge(sides, [&](std::size_t n, std::size_t m) {
        if (m - n != 2) return;
        const Side &a = sides[n], &b = sides[n + 1];
        links[static_cast<std::size_t>(a.triangle)].push_back({b.triangle, a.forward == b.forward});
        links[static_cast<std::size_t>(b.triangle)].push_back({a.triangle, a.forward == b.forward});
    });
    leave_if_stopped();
    std::vector<signed char> turn(triangles.size(), -1);
    std::size_t turned = 0;
    for (std::size_t start = 0; start < triangles.size(); ++start) {
        if (turn[start] >= 0) continue;
        std::vector<int> patch{static_cast<int>(start)};
        turn[start] = 0;
        std::size_t others = 0;
        for (std::size_t n = 0; n < patch.size(); ++n)
            for (const Link& link : links[static_cast<std::size_t>(patch[n])]) {
                signed char& to = turn[static_cast<std::size_t>(link.to)];
                if (to >= 0) continue;
                to = static_cast<signed char>(turn[static_cast<std::size_t>(patch[n])] != (link.differs ? 1 : 0));
                others += to == 1;
                patch.push_back(link.to);
            }
        const signed char wrong = 2 * others > patch.size() ? 0 : 1;
        for (const int t : patch)
            if (turn[static_cast<std::size_t>(t)] == wrong) {
                std::swap(triangles[static_cast<std::size_t>(t)][1], triangles[static_cast<std::size_t>(t)][2]);
                ++turned;
            }
    }
    return turned;
}

using Loop = std::vector<int>;

// Directed edges that close the boundary, as simple loops. Every point has equal in- and out-degree, so each walk
// returns to its start.
std::vector<Loop> loops_of(std::map<int, std::vector<int>> next) {
    std::vector<Loop> loops;
    while (!next.empty()) {
        Loop walk{next.begin()->first};
        std::map<int, std::size_t> place{{walk.front(), 0}};
        while (!walk.empty()) {
            const auto out = next.find(walk.back());
            if (out == next.end()) break;
            const int to = out->second.back();
            out->second.pop_back();
            if (out->second.empty()) next.erase(out);
            if (const auto seen = place.find(to); seen != place.end()) {
                const std::size_t start = seen->second;
                loops.emplace_back(walk.begin() + static_cast<std::ptrdiff_t>(start), walk.end());
                for (std::size_t n = start + 1; n < walk.size(); ++n) place.erase(walk[n]);
                walk.resize(start + 1);
                continue;
            }
            place[to] = walk.size();
            walk.push_back(to);
        }
    }
    return loops;
}

void close_loop(const Loop& loop, geometry::TriangleSurface& mesh) {
    if (loop.size() == 3) {
        mesh.triangles.push_back({loop[0], loop[1], loop[2]});
        return;
    }
    Vec3 middle(0.0);
    for (const int v : loop) middle += mesh.vertices[static_cast<std::size_t>(v)] / static_cast<double>(loop.size());
    const int centre = static_cast<int>(mesh.vertices.size());
    mesh.vertices.push_back(middle);
    for (std::size_t n = 0; n < loop.size(); ++n)
        mesh.triangles.push_back({loop[n], loop[(n + 1) % loop.size()], centre});
}

}  // namespace

std::string MeshRepair::describe() const {
    std::string text;
    const auto add = [&text](std::string part) { text += (text.empty() ? "" : "; ") + part; };
    if (duplicates > 0) add(fmt::format("{} duplicate triangles removed", duplicates));
    if (turned > 0) add(fmt::format("{} triangles flipped", turned));
    if (holes > 0)
        add(fmt::format("{} hole{} closed ({} boundary edges, {:.2g} % of the surface)", holes, holes == 1 ? "" : "s",
                        boundary_edges, 100.0 * hole_share));
    if (non_manifold_edges > 0) add(fmt::format("{} edges with more than two triangles kept", non_manifold_edges));
    return text;
}

MeshRepair repair(geometry::TriangleSurface& mesh, const std::string& file) {
    MeshRepair done;
    done.duplicates = drop_duplicates(mesh.triangles);
    done.turned = orient(mesh.triangles);
    std::map<int, std::vector<int>> missing;
    std::size_t one_sided = 0;
    const std::vector<Side> sides = sides_of(mesh.triangles);
    for_each_edge(sides, [&](std::size_t n, std::size_t m) {
        int net = 0;
        for (std::size_t s = n; s < m; ++s) net += sides[s].forward ? 1 : -1;
        done.boundary_edges += m - n == 1;
        done.non_manifold_edges += m - n > 2;
        one_sided += m - n == 2 && net != 0;
        for (; net > 0; --net) missing[sides[n].high].push_back(sides[n].low);
        for (; net < 0; ++net) missing[sides[n].low].push_back(sides[n].high);
    });
    if (one_sided * 1000 > sides.size())  // a few folds are closed like holes
        throw Error(fmt::format(
            "{}: the surface is not orientable: {} edges join triangles of opposite orientation; repair the mesh first",
            file, one_sided));
    const double area = area_of(mesh);
    const std::vector<Loop> loops = loops_of(std::move(missing));
    for (const Loop& loop : loops) close_loop(loop, mesh);
    done.holes = loops.size();
    done.hole_share = area > 0.0 ? area_of(mesh) / area - 1.0 : 1.0;
    if (!(done.hole_share <= largest_hole_share))
        throw Error(
            fmt::format("{}: the mesh is open: {} boundary edges around {} hole{}, {:.0f} % of its surface; close "
                        "them first",
                        file, done.boundary_edges, done.holes, done.holes == 1 ? "" : "s", 100.0 * done.hole_share));
    return done;
}

}  // namespace tactus::mesh
