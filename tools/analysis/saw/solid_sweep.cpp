// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/saw/solid_sweep.hpp"

#include "dsp/core/random.hpp"
#include "dsp/saw/burr.hpp"
#include "dsp/saw/saw_blade.hpp"
#include "dsp/volume/bricks.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace tactus::analysis {

namespace {

constexpr double sweep_tick = 1e-3, sweep_step = 0.1e-3;  // s, m
constexpr double way_length = 0.15;  // m from the goal to where a way begins
constexpr double slow_length = 12e-3;  // m of it in small steps

saw::SawShape shape_of(SolidTool tool) {
    saw::SawShape shape;
    if (tool != SolidTool::sagittal) return shape;
    shape.kind = saw::SawKind::sagittal;
    shape.length = 0.012;
    shape.height = 0.030;
    shape.thickness = 0.0008;
    return shape;
}

/// Of either tool.
struct Felt {
    Vec3 force{0.0, 0.0, 0.0};
    double magnitudes = 0.0;
};

class Tool {
public:
    Tool(SolidTool kind, double stiffness)
        : kind_(kind), shape_(shape_of(kind)), blade_(shape_, stiffness), burr_(ball_, stiffness) {
        if (kind == SolidTool::burr) {
            parts_.push_back({{0.0, 0.0, 0.0}, ball_.radius});
            for (double y = 0.5e-3; y <= ball_.shaft_length - ball_.shaft_radius; y += 0.5e-3)
                parts_.push_back({{0.0, -ball_.radius - y, 0.0}, ball_.shaft_radius});
            return;
        }
        for (int i = 0; i <= 60; ++i)
            for (int j = 0; j <= 20; ++j)
                for (const double z : {-0.5, 0.5}) {
                    const double x = shape_.length * (i / 60.0 - 0.5), front = shape_.behind(x);
                    parts_.push_back({{x, -front - (shape_.height - front) * j / 20.0, z * shape_.thickness}, 0.0});
                }
    }

    Felt move(const volume::BoneSnapshot& bone, const Pose& pose) {
        const saw::Drive still{false, 0.0, sweep_tick};
        if (kind_ == SolidTool::burr) {
            const saw::BurrContact now = burr_.step(bone, pose, still, {});
            return {now.wrench.force, now.magnitudes};
        }
        const saw::SawContact now = blade_.step(bone, pose, still, {});
        return {now.wrench.force, now.magnitudes};
    }
    /// Of the deepest part, m; negative: none is in bone.
    double depth(const volume::BoneSnapshot& bone, const Pose& pose) const {
        double deepest = -1.0;
        for (const Part& part : parts_) deepest = std::max(deepest, part.radius - bone.value(pose.apply(part.at)));
        return deepest;
    }
    Vec3 place(const Random& random, std::uint64_t n) const {
        if (kind_ == SolidTool::burr) return {0.0, -0.020 * random.uniform(n), 0.0};
        return {shape_.length * (random.uniform(n) - 0.5), -shape_.height * random.uniform(n + 1), 0.0};
    }

private:
    struct Part {
        Vec3 at;
        double radius;
    };
    SolidTool kind_;
    saw::SawShape shape_;
    saw::BurrShape ball_;
    saw::SawBlade blade_;
    saw::Burr burr_;
    std::vector<Part> parts_;
};

/// A place `below` the surface, m: from a random sample near the surface along the slope.
std::optional<Vec3> place_in(const volume::BoneSnapshot& bone, const volume::Grid& grid, const Random& random,
                             std::uint64_t n, double below) {
    for (std::uint64_t tries = 0; tries < 400; ++tries) {
        Vec3 p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = grid.origin[axis] + grid.spacing[axis] * (grid.size[static_cast<std::size_t>(axis)] - 1) *
                                              random.uniform(n + 3 * tries + static_cast<std::uint64_t>(axis));
        const volume::Sample here = bone.sample(p);
        const double slope = glm::length(here.gradient);
        if (!here.inside || !(slope > 0.5) || std::abs(here.value) > 2e-3) continue;
        return p - here.gradient * ((here.value + below) / (slope * slope));
    }
    return std::nullopt;
}

}  // namespace

SolidSweepResult run_solid_sweep(SolidTool kind, const bone::Bone& bone, int poses, const SolidSweep& sweep) {
    const Vec3& h = bone.distance.spacing;
    const volume::BoneEditor editor(bone.distance, bone.density, {.band = 4.0 * std::max({h.x, h.y, h.z}) + 2e-3});
    const volume::BoneSnapshot now = editor.current();
    const Random random{sweep.seed};
    SolidSweepResult result;
    std::vector<double> steps;
    for (std::uint64_t n = 0; result.poses < poses && n < 20 * static_cast<std::uint64_t>(poses); ++n) {
        const std::uint64_t k = 4096 * n;
        const std::optional<Vec3> goal = place_in(now, bone.distance, random, k + 100, 3e-3);
        if (!goal) continue;
        const Quat turn =
            glm::normalize(Quat(random.normal(k), random.normal(k + 1), random.normal(k + 2), random.normal(k + 3)));
        const Vec3 from = glm::normalize(Vec3(random.normal(k + 4), random.normal(k + 5), random.normal(k + 6)));
        Tool tool(kind, sweep.stiffness);
        const Vec3 end = *goal - turn * tool.place(random, k + 7);
        if (tool.depth(now, {end + way_length * from, turn}) > 0.0) continue;
        ++result.poses;
        Vec3 at = end + way_length * from, last(0.0);
        double work = 0.0, bound = 0.0;
        const auto go = [&](double away, bool approaches) {
            const Vec3 to = end + away * from, way = to - at;
            const Pose pose{to, turn};
            const Felt felt = tool.move(now, pose);
            work += glm::dot(last, way);
            // What one step of a hand may gain from a spring that is sampled.
            bound += 0.5 * std::min(std::abs(glm::dot(felt.force - last, way)), sweep.stiffness * glm::dot(way, way));
            if (approaches) {
                if (away < slow_length) {
                    const double change = glm::length(felt.force - last);
                    if (change > 0.0) steps.push_back(change);
                }
                const double depth = tool.depth(now, pose);
                if (depth > sweep.deep) {
                    ++result.pressed;
                    if (!(felt.magnitudes > 0.0)) {
                        ++result.silent;
                        result.greatest_silent = std::max(result.greatest_silent, depth);
                    }
                }
            }
            last = felt.force;
            at = to;
        };
        double away = way_length;
        for (; away > slow_length; away -= 2e-3) go(away, true);
        for (; away > 0.0; away -= sweep_step) go(away, true);
        for (; away < slow_length; away += sweep_step) go(away, false);
        for (; away < way_length; away += 2e-3) go(away, false);
        // What slid round the bone holds the hand back from behind, until it has been outside for 2 s.
        for (int wait = 0; wait < 2300 && last != Vec3(0.0); ++wait) go(way_length, false);
        result.active += work > 1.1 * bound + 1e-9;
        result.held += last != Vec3(0.0);
    }
    if (!steps.empty()) {
        std::ranges::sort(steps);
        result.greatest_step = steps.back();
        result.median_step = steps[steps.size() / 2];
    }
    return result;
}

}  // namespace tactus::analysis
