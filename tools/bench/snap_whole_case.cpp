// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/snap_whole_case.hpp"

#include "assets/library/broken_mandible.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/fit/fragment_matcher.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdint>
#include <numbers>

namespace tactus::bench {

namespace {

constexpr double max_error = 0.3e-3, max_angle = 0.5;

void put_together_once(const library::BrokenMandible& broken, WholeCaseResult& result) {
    std::vector<fit::FragmentSurface> surfaces;
    for (const bone::Bone& bone : broken.fragments) surfaces.push_back({bone.points, &bone.distance});
    fit::FragmentMatcher matcher(surfaces);
    std::vector<Pose> poses = broken.beside;
    std::vector<char> stands(poses.size(), 0);
    std::vector<fit::FragmentMatch> last(poses.size());
    const auto stand = [&](std::size_t n) {
        poses[n] = broken.truth[n];
        stands[n] = 1;
    };
    stand(0);
    // A part that lost pieces disconnect has no reference: its base piece is placed at the truth.
    std::vector<std::size_t> order = broken.order;
    for (const auto& island : broken.islands) {
        stand(island.front());
        order.insert(order.end(), island.begin() + 1, island.end());
        result.alone += island.size() == 1;
        result.islands += island.size() > 1;
    }
    const auto look = [&](std::size_t n) {
        const std::int64_t begin = thread_ns();
        last[n] = matcher.near(static_cast<int>(n), poses, stands);
        result.seconds.push_back(1e-9 * static_cast<double>(thread_ns() - begin));
        if (last[n].verdict != fit::FitVerdict::fit) return;
        poses[n] = last[n].pose;
        stands[n] = 1;
    };
    for (const std::size_t n : order) {
        look(n);
        if (stands[n]) look(n);
    }
    for (int pass = 0; pass < 2; ++pass)
        for (const std::size_t n : order) look(n);
    for (const std::size_t n : order) {
        Vec3 middle(0.0);
        const auto& points = broken.fragments[n].points;
        for (const contact::SurfacePoint& p : points) middle += p.position / static_cast<double>(points.size());
        const double error = glm::length(poses[n].apply(middle) - broken.truth[n].apply(middle));
        const double angle =
            glm::length(rotation_between(broken.truth[n].orientation, poses[n].orientation)) * 180.0 / std::numbers::pi;
        result.error.push_back(error);
        result.angle.push_back(angle);
        result.gap.push_back(last[n].quality.gap);
        const bool fits = last[n].verdict == fit::FitVerdict::fit;
        result.fitted += fits;
        result.within += fits && error < max_error && angle < max_angle;
    }
}

double greatest(const std::vector<double>& all) { return all.empty() ? 0.0 : *std::ranges::max_element(all); }

}  // namespace

const std::vector<WholeCase>& whole_cases() {
    static const std::vector<WholeCase> cases{
        {"twelve", 0.0, 0}, {"twelve-kerf", 0.3e-3, 0}, {"twelve-missing", 0.0, 2}};
    return cases;
}

double WholeCaseResult::worst_error() const { return greatest(error); }
double WholeCaseResult::worst_angle() const { return greatest(angle); }

WholeCaseResult put_together(const bone::Bone& bone, const WholeCase& kind, std::uint64_t seed, int seeds) {
    WholeCaseResult result;
    for (int n = 0; n < seeds; ++n)
        put_together_once(
            library::break_mandible(
                bone, {.seed = seed + static_cast<std::uint64_t>(n), .kerf = kind.kerf, .missing = kind.missing}),
            result);
    return result;
}

}  // namespace tactus::bench
