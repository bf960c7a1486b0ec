// SPDX-License-Identifier: Apache-2.0
#include "dsp/vessel/track_doubts.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/vessel/tube.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace tactus::vessel {

namespace {

/// The value below which `share` of the ring around a node lies; no value where the ring is outside of the scan.
std::optional<double> of_ring(const Scan& scan, const Node& node, double radii, double share) {
    constexpr int places = 16;
    const Across frame = across(node.direction);
    std::vector<double> values;
    for (int n = 0; n < places; ++n) {
        const double angle = 2.0 * pi * n / places, r = radii * node.radius;
        const Vec3 at = node.position + r * (std::cos(angle) * frame.first + std::sin(angle) * frame.second);
        if (scan.contains(at)) values.push_back(scan.any_value(at));
    }
    if (values.size() < places / 2) return {};
    const auto rank = values.begin() + static_cast<std::ptrdiff_t>(share * double(values.size() - 1));
    std::ranges::nth_element(values, rank);
    return *rank;
}

/// Shares of the length of a branch.
struct Shares {
    double seen = 0.0, at_limit = 0.0, jumps = 0.0, walls_judged = 0.0, without_wall = 0.0;  ///< m
};

Shares shares_of(const Scan& scan, const Branch& branch, double contrast, double max_radius) {
    Shares shares;
    const std::vector<Node>& nodes = branch.nodes;
    std::size_t behind = 0;  // about a radius before
    for (std::size_t n = 1; n < nodes.size(); ++n) {
        const Node& node = nodes[n];
        const double length = node.along - nodes[n - 1].along;
        if (node.is_lost || node.along < branch.free_from) continue;
        shares.seen += length;
        if (node.radius > 0.97 * max_radius) shares.at_limit += length;
        while (node.along - nodes[behind + 1].along > node.radius) ++behind;
        const Node& before = nodes[behind];
        // What blur decides changes without meaning.
        if (!before.is_lost && before.along >= branch.free_from && !node.is_radius_uncertain &&
            !before.is_radius_uncertain &&
            std::abs(std::log(std::max(node.radius, 1e-9) / std::max(before.radius, 1e-9))) > std::log(1.5))
            shares.jumps += length;
        const auto inside = of_ring(scan, node, 0.6, 0.5), outside = of_ring(scan, node, 1.5, 0.25);
        if (!inside || !outside || node.is_radius_uncertain) continue;
        shares.walls_judged += length;
        if (*inside - *outside < 0.3 * contrast) shares.without_wall += length;
    }
    return shares;
}

}  // namespace

std::vector<std::string> doubts_of(const Scan& scan, const Track& track, double max_radius) {
    std::vector<std::string> doubts;
    const auto add = [&](std::size_t branch, double share, const char* what) {
        doubts.push_back(fmt::format("branch {} {} on {:.0f} % of its length", branch, what, 100.0 * share));
    };
    for (std::size_t b = 0; b < track.branches.size(); ++b) {
        const Shares s = shares_of(scan, track.branches[b], track.contrast, max_radius);
        if (!(s.seen > 0.0)) continue;
        if (s.at_limit > 0.25 * s.seen)
            add(b, s.at_limit / s.seen,
                fmt::format("is as wide as --max-radius allows ({:.1f} mm): the vessel is wider, or it is none,",
                            max_radius / mm)
                    .c_str());
        if (s.jumps > 0.25 * s.seen) add(b, s.jumps / s.seen, "changes its radius by half within one radius");
        if (s.walls_judged > 0.0 && s.without_wall > 0.5 * s.walls_judged)
            add(b, s.without_wall / s.walls_judged, "has no wall: what is around it is as bright as what is in it,");
    }
    return doubts;
}

}  // namespace tactus::vessel
