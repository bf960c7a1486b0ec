// SPDX-License-Identifier: Apache-2.0
// Where vessels leave a tracked one.
#include "dsp/vessel/search.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

namespace tactus::vessel {

namespace {

/// The least brightness between two places, averaged over three samples along the way.
double min_between(const Scan& scan, const Vec3& from, const Vec3& to) {
    const double length = glm::length(to - from);
    const int parts = std::max(3, static_cast<int>(length / (0.5 * scan.voxel())));
    double least = std::numeric_limits<double>::infinity(), before = scan.any_value(from), last = before;
    for (int n = 1; n <= parts; ++n) {
        const double value = scan.any_value(from + (to - from) * (double(n) / parts));
        least = std::min(least, (before + last + value) / 3.0);
        before = last, last = value;
    }
    return least;
}

/// Share of the vessel's contrast that a branch of this radius shows at least: blur takes brightness from what is thin.
constexpr double faintest = 0.3;
double level_of(double radius_voxels) { return std::clamp(radius_voxels - 0.95, faintest, 0.5); }

bool is_taken(const std::vector<Taken>& taken, const Vec3& place, double margin) {
    return std::ranges::any_of(
        taken, [&](const Taken& other) { return glm::length(place - other.position) < other.radius + margin; });
}

}  // namespace

std::vector<SideBranch> side_branches(const Search& search, const Branch& branch, const std::vector<Taken>& taken) {
    const Scan& scan = search.scan;
    const double voxel = scan.voxel();
    const Window window = tracking_window(1.3, 2.0);
    std::vector<SideBranch> found, thin;
    double next = 0.0;
    for (std::size_t n = 0; n < branch.nodes.size(); ++n) {
        const Node& node = branch.nodes[n];
        if (node.is_lost || node.along < next) continue;
        next = node.along + std::max(0.5 * node.radius, 0.8 * voxel);
        const Across frame = across(node.direction);
        for (const double share : {1.0, 0.7, 0.5, 0.35}) {
            const double radius = share * node.radius;
            if (radius < std::max(search.settings.min_radius, 0.8 * voxel)) continue;
            for (int turn = 0; turn < 16; ++turn) {
                const double angle = 2.0 * std::numbers::pi * turn / 16.0;
                const Vec3 out = std::cos(angle) * frame.first + std::sin(angle) * frame.second;
                // Branches that leave at an acute angle are free of the vessel only further away.
                constexpr std::pair<double, double> places[] = {{-1.05, 1.2}, {-1.05, 2.2}, {-0.55, 1.2}, {0.0, 1.2},
                                                                {0.55, 1.2},  {1.05, 1.2},  {1.05, 2.2}};
                for (const auto& [tilt, off] : places) {
                    Tube tube;
                    tube.direction = std::cos(tilt) * out + std::sin(tilt) * node.direction;
                    tube.centre =
                        node.position + (node.radius + off * radius + 0.5 * voxel) / std::cos(tilt) * tube.direction;
                    tube.radius = radius;
                    float value;
                    if (!scan.value(tube.centre, value)) continue;
                    tube = measured(scan, window, search.sampling, tube);
                    if (tube.score < search.min_mean || tube.contrast < faintest * node.contrast || tube.valid < 0.6)
                        continue;
                    // Vessels thinner than the template appear faint.
                    const bool is_fitted = tube.contrast < level_of(tube.radius / voxel) * node.contrast;
                    if (is_fitted) {
                        tube = fitted(scan, window, search.sampling, tube, {0.5 * radius, radius, 0.5});
                        if (tube.score < search.min_mean || tube.valid < 0.6) continue;
                    }
                    const double level = level_of(tube.radius / voxel) * node.contrast;
                    if (tube.contrast < level) continue;
                    if (is_taken(taken, tube.centre, 0.3 * radius)) continue;
                    const double gap = std::min(level, 0.5 * tube.contrast);
                    if (min_between(scan, node.position, tube.centre) < tube.background + gap) continue;
                    (is_fitted ? thin : found).push_back({tube, static_cast<int>(n)});
                }
            }
        }
    }
    // A fit raises the score: what needed none comes first.
    for (std::vector<SideBranch>* const each : {&found, &thin})
        std::ranges::stable_sort(*each, std::greater{}, [](const SideBranch& side) { return side.tube.score; });
    found.insert(found.end(), thin.begin(), thin.end());
    std::vector<SideBranch> kept;
    for (const SideBranch& each : found) {
        const bool is_twin = std::ranges::any_of(kept, [&](const SideBranch& other) {
            return glm::length(other.tube.centre - each.tube.centre) <
                   1.2 * std::max(other.tube.radius, each.tube.radius);
        });
        if (!is_twin) kept.push_back(each);
        if (kept.size() == 30) break;
    }
    return kept;
}

}  // namespace tactus::vessel
