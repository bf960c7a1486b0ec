// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/plan_words.hpp"

#include "dsp/fit/arrangement/assemblies.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <numbers>

namespace tactus::analysis {

std::string fit_words(const plan::PlanState& state, int fragment) {
    const auto& fit = state.fits[static_cast<std::size_t>(fragment)];
    if (!fit) return "";
    if (state.holds(fragment) && is_accepted(*fit))
        return fmt::format("{}, {:.2f} mm residual, beside {}", fit->verdict, fit->rms * 1e3, fit->partner);
    if (state.holds(fragment))
        return fmt::format("{} to {} ({:.2f} mm rms)", fit->verdict, fit->partner, fit->rms * 1e3);
    const fit::Arrangement::Departure away = state.arrangement.departure(fragment);
    return fmt::format("fit to {} is void: moved {:.2f} mm and {:.2f}° from it since", fit->partner,
                       away.distance * 1e3, away.angle * 180.0 / std::numbers::pi);
}

bool is_accepted(const plan::PlanFit& fit) { return fit.verdict.starts_with("accepted"); }

bool is_in_one_part(const plan::PlanState& state) { return fit::assemblies(state.arrangement).size() <= 1; }

std::vector<std::vector<std::string>> assembly_names(const plan::CasePlan& plan, const plan::PlanState& state) {
    std::vector<std::vector<std::string>> all;
    for (const auto& part : fit::assemblies(state.arrangement)) {
        all.emplace_back();
        for (const int n : part) all.back().push_back(plan.fragments[static_cast<std::size_t>(n)].name);
    }
    return all;
}

std::vector<std::string> connection_words(const plan::CasePlan& plan, const plan::PlanState& state) {
    std::vector<std::string> lines, alone;
    const auto parts = assembly_names(plan, state);
    for (const auto& names : parts)
        if (names.size() == 1) alone.push_back(names.front());
        else lines.push_back(fmt::format("connected by fits: {}", fmt::join(names, ", ")));
    if (!alone.empty() && parts.size() > 1)
        lines.push_back(fmt::format("connected to nothing: {}", fmt::join(alone, ", ")));
    return lines;
}

}  // namespace tactus::analysis
