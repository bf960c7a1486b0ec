// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/training/measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::analysis {

namespace {

using Better = Measure::Better;

std::optional<double> injured(const Score& s) {
    if (s.spared.empty()) return std::nullopt;
    double sum = 0.0;
    for (const SparedScore& one : s.spared) sum += one.injured_mm3;
    return sum;
}

std::optional<double> closest(const Score& s) {
    if (s.spared.empty()) return std::nullopt;
    return std::ranges::min_element(s.spared, {}, &SparedScore::closest_mm)->closest_mm;
}

const std::array<Measure, 17> all{{
    {"plane.rms_mm", "rms distance from the plan, mm", Better::less, [](const Score& s) { return s.rms_mm; }},
    {"plane.max_mm", "greatest distance from the plan, mm", Better::less, [](const Score& s) { return s.max_mm; }},
    {"plane.angle_deg", "angle to the plan, °", Better::less, [](const Score& s) { return s.angle_deg; }},
    {"over_mm3", "cut beyond the plan, mm³", Better::less, [](const Score& s) { return std::optional(s.over_mm3); }},
    {"under_mm3", "left of the plan, mm³", Better::less, [](const Score& s) { return std::optional(s.under_mm3); }},
    {"spared.injured_mm3", "injured of structures to spare, mm³", Better::less, injured},
    {"spared.closest_mm", "nearest to a structure to spare, mm", Better::more, closest},
    {"force.mean_N", "mean force in contact, N", Better::unknown,
     [](const Score& s) { return std::optional(s.mean_N); }},
    {"force.over_limit_Ns", "impulse above the limit, N s", Better::less,
     [](const Score& s) { return std::optional(s.over_limit_Ns); }},
    {"force.shown", "share of the contact with force on the hand", Better::unknown,
     [](const Score& s) { return s.shown_share; }},
    {"force.jerk", "log dimensionless jerk of a stroke", Better::less, [](const Score& s) { return s.jerk; }},
    {"breakthrough.depth_mm", "plunge behind the bone, mm", Better::less,
     [](const Score& s) { return s.breakthrough_mm; }},
    {"breakthrough.speed_mm_per_s", "speed of the plunge, mm/s", Better::less,
     [](const Score& s) { return s.breakthrough_mm_per_s; }},
    {"strokes", "strokes", Better::unknown, [](const Score& s) { return std::optional<double>(s.strokes); }},
    {"seconds", "time, s", Better::less, [](const Score& s) { return std::optional(s.seconds); }},
    {"path_mm", "path, mm", Better::less, [](const Score& s) { return std::optional(s.path_mm); }},
    {"heat_s", "harmful heat, s", Better::less, [](const Score& s) { return s.heat_s; }},
}};

/// Slope of ln value over ln n.
std::optional<double> exponent_of(const std::vector<std::optional<double>>& values) {
    double count = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (std::size_t n = 0; n < values.size(); ++n) {
        if (!values[n]) continue;
        if (!(*values[n] > 0.0)) return std::nullopt;
        const double a = std::log(static_cast<double>(n + 1)), b = std::log(*values[n]);
        ++count;
        x += a;
        y += b;
        xx += a * a;
        xy += a * b;
    }
    const double spread = count * xx - x * x;
    if (count < 3.0 || !(spread > 1e-12)) return std::nullopt;
    return (count * xy - x * y) / spread;
}

}  // namespace

std::span<const Measure> measures() { return all; }

std::vector<LearningCurve> learning_curves(std::span<const ScoredRun> runs) {
    std::vector<std::string> tasks;
    for (const ScoredRun& run : runs)
        if (std::ranges::find(tasks, run.task.title) == tasks.end()) tasks.push_back(run.task.title);
    std::vector<LearningCurve> curves;
    for (const std::string& task : tasks)
        for (const Measure& measure : measures()) {
            LearningCurve curve{task, measure.name, {}, std::nullopt};
            for (const ScoredRun& run : runs)
                if (run.task.title == task) curve.values.push_back(measure.of(run.score));
            if (curve.values.size() < 2 ||
                std::ranges::none_of(curve.values, [](const auto& value) { return value.has_value(); }))
                continue;
            curve.exponent = exponent_of(curve.values);
            curves.push_back(std::move(curve));
        }
    return curves;
}

std::vector<ReferenceMeasure> reference_of(std::span<const ScoredRun> runs) {
    std::vector<ReferenceMeasure> group;
    for (const Measure& measure : measures()) {
        ReferenceMeasure one{measure.name, {}, 0.0, std::nullopt};
        for (const ScoredRun& run : runs)
            if (const auto value = measure.of(run.score)) one.values.push_back(*value);
        std::ranges::sort(one.values);
        const auto count = static_cast<double>(one.values.size());
        for (const double value : one.values) one.mean += value / count;
        if (one.values.size() > 1) {
            double sum = 0.0;
            for (const double value : one.values) sum += (value - one.mean) * (value - one.mean);
            one.deviation = std::sqrt(sum / (count - 1.0));
        }
        group.push_back(std::move(one));
    }
    return group;
}

std::optional<double> percentile(const Measure& measure, const std::optional<double>& value,
                                 const ReferenceMeasure& group) {
    if (!value || group.values.empty() || measure.better == Better::unknown) return std::nullopt;
    double worse = 0.0;
    for (const double other : group.values)
        worse += other == *value ? 0.5 : (other > *value) == (measure.better == Better::less) ? 1.0 : 0.0;
    return 100.0 * worse / static_cast<double>(group.values.size());
}

}  // namespace tactus::analysis
