// SPDX-License-Identifier: Apache-2.0
#include "tools/window/plan/plan_comparison.hpp"

#include "tools/analysis/plan/case_warnings.hpp"
#include "tools/analysis/plan/plan_matching.hpp"
#include "tools/analysis/plan/plan_words.hpp"
#include "tools/counted.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>

namespace tactus::window {

namespace {

plan::CasePlan as_alternative(plan::CasePlan plan, int alternative) {
    plan.current = alternative;
    return plan;
}

}  // namespace

AlternativeNumbers numbers_of_alternative(const plan::CasePlan& plan, int alternative,
                                          const std::filesystem::path& folder) {
    const plan::CasePlan other = as_alternative(plan, alternative);
    const plan::PlanState state = plan::state_of(other);
    AlternativeNumbers numbers;
    numbers.name = other.alternatives[static_cast<std::size_t>(alternative)].name;
    numbers.steps = fit::steps_to(other.before(), other.place().head).size();
    for (int n = 0; n < static_cast<int>(other.fragments.size()); ++n) {
        if (state.arrangement.is_hidden(n)) continue;
        ++numbers.shown;
        numbers.fits += state.holds(n) ? 1 : 0;
    }
    std::vector<double> gaps;
    for (const analysis::PlanGap& pair : analysis::plan_gaps(other, folder, {})) {
        if (pair.gap.facing > 0.0) gaps.push_back(pair.gap.median);
        numbers.deepest = std::max(numbers.deepest, pair.gap.deepest);
        numbers.overlap += pair.overlap;
    }
    std::ranges::sort(gaps);
    numbers.facing = gaps.size();
    if (!gaps.empty()) numbers.gap = 0.5 * (gaps[(gaps.size() - 1) / 2] + gaps[gaps.size() / 2]);
    if (state.reconstruction) numbers.warnings = analysis::case_warnings(other, folder).all.size();
    return numbers;
}

std::string words_of(const AlternativeNumbers& n) {
    std::string words = fmt::format("{}: {}, {} shown, {} that hold", n.name, counted(n.steps, "step"), n.shown,
                                    counted(n.fits, "fit"));
    if (n.facing > 0)
        words += fmt::format("; {} of fragments facing each other, median gap {:.2f} mm", counted(n.facing, "pair"),
                             analysis::shown_mm(n.gap * 1e3));
    words += fmt::format("; overlap {:.1f} mm³, {:.2f} mm deep", n.overlap * 1e9, n.deepest * 1e3);
    if (n.warnings) words += "; " + counted(*n.warnings, "warning");
    return words;
}

std::vector<std::optional<Pose>> poses_of_alternative(const plan::CasePlan& plan, int alternative) {
    const plan::PlanState state = plan::state_of(as_alternative(plan, alternative));
    std::vector<std::optional<Pose>> poses(plan.fragments.size());
    for (std::size_t n = 0; n < poses.size(); ++n)
        if (!state.arrangement.is_hidden(static_cast<int>(n))) poses[n] = state.arrangement.pose(static_cast<int>(n));
    return poses;
}

std::vector<std::string> differences(const plan::CasePlan& plan, int first, int second, std::span<const Vec3> middles) {
    const auto here = poses_of_alternative(plan, first), there = poses_of_alternative(plan, second);
    std::vector<std::string> lines;
    for (std::size_t n = 0; n < here.size(); ++n) {
        const std::string& name = plan.fragments[n].name;
        if (here[n].has_value() != there[n].has_value()) {
            const int shown = here[n] ? first : second;
            lines.push_back(
                fmt::format("{}: only in {}", name, plan.alternatives[static_cast<std::size_t>(shown)].name));
            continue;
        }
        if (!here[n]) continue;
        const Vec3 middle = n < middles.size() ? middles[n] : Vec3(0.0);
        const double moved = glm::length(here[n]->apply(middle) - there[n]->apply(middle)),
                     turned = analysis::angle_deg(here[n]->inverse() * *there[n]);
        if (moved > 5e-6 || turned > 5e-3)
            lines.push_back(fmt::format("{}: {:.2f} mm, {:.2f}°", name, moved * 1e3, turned));
    }
    return lines;
}

}  // namespace tactus::window
