// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/cut.hpp"

#include "dsp/core/error.hpp"
#include "dsp/reconstruction/bodies.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace tactus::reconstruction {

namespace {

/// The middles of the caps on the two sides of a cut.
struct Caps {
    std::vector<int> below, above;
};

/// Opens the surface along the section and closes both sides. Vertices keep their numbers. Throws
/// Error when the section passes through the caps of an earlier cut.
Caps open_at(geometry::TriangleSurface& surface, const Plane& plane, const Caps& earlier = {}) {
    const Section section = section_of(surface, plane, &plane.origin);
    if (section.pieces.empty()) throw Error("a plane of the cut misses the bone");
    if (section.away > farthest_from_limb)
        throw Error(
            fmt::format("the origin of a plane lies {:.1f} mm outside the bone, which does not tell which limb it "
                        "cuts; place it within {:.0f} mm of the limb",
                        section.away * 1e3, farthest_from_limb * 1e3));
    for (const std::size_t triangle : section.triangle)
        for (const int corner : surface.triangles[triangle])
            if (std::ranges::count(earlier.below, corner) + std::ranges::count(earlier.above, corner) > 0)
                throw Error("the planes cross inside the bone; move them apart or tilt them less");
    const auto index = [](std::size_t n) { return static_cast<int>(n); };
    const int below = index(surface.vertices.size()), above = below + index(section.points.size());
    for (int side = 0; side < 2; ++side)
        surface.vertices.insert(surface.vertices.end(), section.points.begin(), section.points.end());
    // A middle per outline and side.
    std::map<std::size_t, std::array<int, 2>> middle;
    Caps caps;
    for (const auto& [first, second] : section.pieces) {
        const std::size_t outline = section.outline[first];
        if (middle.contains(outline)) continue;
        Vec3 sum(0.0);
        double count = 0.0;
        for (std::size_t n = 0; n < section.points.size(); ++n)
            if (section.outline[n] == outline) sum += section.points[n], count += 1.0;
        const int at = index(surface.vertices.size());
        middle[outline] = {at, at + 1};
        caps.below.push_back(at);
        caps.above.push_back(at + 1);
        surface.vertices.insert(surface.vertices.end(), 2, sum / count);
    }
    const auto is_above = [&](int n) {
        return glm::dot(plane.normal, surface.vertices[static_cast<std::size_t>(n)] - plane.origin) >= 0.0;
    };
    for (std::size_t piece = 0; piece < section.pieces.size(); ++piece) {
        auto& triangle = surface.triangles[section.triangle[piece]];
        // The corner that is alone on its side comes first.
        std::array<int, 3> t = triangle;
        while (is_above(t[1]) != is_above(t[2])) std::ranges::rotate(t, t.begin() + 1);
        const auto point_on = [&](int a, int b) {
            const auto& [one, other] = section.pieces[piece];
            const auto edge = std::minmax(a, b);
            return index(section.edge[one] == std::array<int, 2>{edge.first, edge.second} ? one : other);
        };
        const int p = point_on(t[0], t[1]), q = point_on(t[0], t[2]);
        const bool alone_above = is_above(t[0]);
        const int alone = alone_above ? above : below, others = alone_above ? below : above;
        const std::array<int, 2>& ends = middle[section.outline[section.pieces[piece][0]]];
        triangle = {t[0], alone + p, alone + q};
        surface.triangles.push_back({others + p, t[1], t[2]});
        surface.triangles.push_back({others + p, t[2], others + q});
        surface.triangles.push_back({alone + q, alone + p, ends[alone_above ? 1 : 0]});
        surface.triangles.push_back({others + p, others + q, ends[alone_above ? 0 : 1]});
    }
    return caps;
}

}  // namespace

CutPieces cut_between(const geometry::TriangleSurface& surface, const Plane& first, const std::optional<Plane>& last) {
    geometry::TriangleSurface open = surface;
    const Caps low = open_at(open, first);
    const Caps high = last ? open_at(open, *last, low) : Caps{};
    std::vector<Plane> cuts{first};
    if (last) cuts.push_back(*last);
    const std::vector<std::size_t> body = bodies_of(open, cuts);
    const auto body_at = [&](int corner) { return body[static_cast<std::size_t>(corner)]; };
    std::vector<bool> is_between(body.size(), false);
    for (const auto* side : {&low.above, &high.below})
        for (const int middle : *side) is_between[body_at(middle)] = true;
    std::vector<CutBy> cut_by(body.size(), CutBy::none);
    for (const auto& [side, plane] : {std::pair{&high.above, CutBy::last}, std::pair{&low.below, CutBy::first}})
        for (const int middle : *side) {
            if (is_between[body_at(middle)])
                throw Error(
                    "the planes do not separate the bone: a part reaches from one side of a plane to the other; move "
                    "the planes or add one");
            CutBy& by = cut_by[body_at(middle)];
            by = by == CutBy::none || by == plane ? plane : CutBy::both;
        }
    CutPieces pieces;
    std::map<std::size_t, std::size_t> number;  // of a body in the rest
    std::vector<int> moved(body.size(), -1);
    for (const auto& t : open.triangles) {
        const std::size_t of = body_at(t[0]);
        if (!is_between[of] && !number.contains(of)) {
            number[of] = pieces.rest.size();
            pieces.rest.push_back({{}, cut_by[of]});
        }
        geometry::TriangleSurface& to = is_between[of] ? pieces.between : pieces.rest[number[of]].surface;
        std::array<int, 3> copied{};
        for (std::size_t c = 0; c < 3; ++c) {
            int& at = moved[static_cast<std::size_t>(t[c])];
            if (at < 0) {
                at = static_cast<int>(to.vertices.size());
                to.vertices.push_back(open.vertices[static_cast<std::size_t>(t[c])]);
            }
            copied[c] = at;
        }
        to.triangles.push_back(copied);
    }
    std::vector<std::pair<double, std::size_t>> by_size;
    for (const RestPiece& piece : pieces.rest)
        by_size.emplace_back(-std::abs(signed_volume(piece.surface)), by_size.size());
    std::ranges::sort(by_size);
    std::vector<RestPiece> sorted;
    for (const auto& [size, n] : by_size) sorted.push_back(std::move(pieces.rest[n]));
    pieces.rest = std::move(sorted);
    return pieces;
}

}  // namespace tactus::reconstruction
