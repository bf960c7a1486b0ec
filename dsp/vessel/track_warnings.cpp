// SPDX-License-Identifier: Apache-2.0
#include "dsp/vessel/track_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::vessel {

namespace {

/// A vessel this wide does not end by getting thin: most of its radii are certain. Shorter side branches are seen too
/// little.
bool is_well_seen(const Branch& branch) {
    std::vector<double> radii;
    std::size_t certain = 0;
    for (const Node& node : branch.nodes) {
        if (node.is_lost) continue;
        radii.push_back(node.radius);
        certain += !node.is_radius_uncertain;
    }
    if (radii.empty() || 2 * certain < radii.size()) return false;
    std::ranges::nth_element(radii, radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2));
    return branch.parent < 0 || branch.length() >= 6.0 * radii[radii.size() / 2];
}

bool is_open(End end) { return end == End::contrast || end == End::noise; }

std::string text_of_end(std::size_t index, const Node& node, End end) {
    const Vec3 at = node.position * 1e3;
    return fmt::format(
        "branch {} ends at {:.1f}, {:.1f}, {:.1f}, where {}: it may go on, or be narrowed or closed there", index, at.x,
        at.y, at.z, reason_of(end));
}

}  // namespace

std::vector<TrackWarning> warnings_of(const Track& track) {
    constexpr double min_percent = 50.0;
    std::vector<TrackWarning> warnings;
    for (std::size_t b = 0; b < track.branches.size(); ++b) {
        const Branch& branch = track.branches[b];
        if (branch.stenosis && branch.stenosis->percent >= min_percent)
            warnings.push_back(
                {b, branch.stenosis->node, fmt::format("branch {} is {}", b, text_of(branch, *branch.stenosis))});
        for (const LostStretch& stretch : branch.lost()) {
            std::size_t node = 0;
            while (branch.nodes[node].along < stretch.from) ++node;
            warnings.push_back(
                {b, node,
                 fmt::format("branch {} has no contrast from {:.1f} to {:.1f} mm along it, which is bridged: it may be "
                             "closed there, or be another vessel",
                             b, stretch.from * 1e3, stretch.to * 1e3)});
        }
        if (!is_well_seen(branch)) continue;
        if (branch.parent < 0 && is_open(branch.start))
            warnings.push_back({b, 0, text_of_end(b, branch.nodes.front(), branch.start)});
        if (is_open(branch.end))
            warnings.push_back({b, branch.nodes.size() - 1, text_of_end(b, branch.nodes.back(), branch.end)});
    }
    return warnings;
}

std::string text_of(const Branch& branch, const Stenosis& stenosis) {
    const Vec3 at = branch.nodes[stenosis.node].position * 1e3;
    return fmt::format("narrowed by {:.0f}{} % against {:.2f} mm at {:.1f}, {:.1f}, {:.1f}{}", stenosis.percent,
                       stenosis.error_percent > 0.0 ? fmt::format(" ± {:.0f}", stenosis.error_percent) : "",
                       stenosis.reference_radius * 1e3, at.x, at.y, at.z, stenosis.is_uncertain ? ", uncertain" : "");
}

}  // namespace tactus::vessel
