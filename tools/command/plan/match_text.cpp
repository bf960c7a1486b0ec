// SPDX-License-Identifier: Apache-2.0
#include "tools/command/plan/match_text.hpp"

#include "tools/counted.hpp"

#include <fmt/format.h>

namespace tactus::command {

void print_match(const plan::CasePlan& plan, const analysis::PlanMatch& found, const std::string& reason) {
    const fit::FragmentMatch& match = found.match;
    const auto name = [&plan](int n) { return plan.fragments[static_cast<std::size_t>(n)].name; };
    if (match.partner == fit::Arrangement::none) fmt::print("{} stays where it is: {}\n", name(match.moving), reason);
    else {
        fmt::print("{} to {}: {}, {}, score {:.2f}, margin {:.2f}, {:.0f} mm² on each other, {:.3f} mm rms{}\n",
                   name(match.moving), name(match.partner), fit::name_of(match.verdict), counted(match.faces, "face"),
                   match.quality.score, match.margin, match.quality.overlap * 1e6, match.quality.rms * 1e3,
                   has_bound(match.verdict) ? "" : "; it stays where it was");
        if (has_bound(match.verdict)) fmt::print("{}\n", bound_words(match.verdict, match.bound));
        if (!reason.empty()) fmt::print("{}\n", reason);
    }
    if (found.is_apart)
        fmt::print("'{}' is not connected to what stands, and nothing of that fits '{}'; see 'tactus plan check'\n",
                   name(match.partner), name(match.moving));
    if (found.as_scanned) fmt::print("{}\n", as_scanned_note);
}

void print_left_out(const plan::CasePlan& plan, const analysis::PlanMatching& matching, const fit::Arrangement& shown) {
    for (int n = 0; n < static_cast<int>(shown.size()); ++n)
        if (const double area = matching.as_scanned_area(n); area > 0.0 && !shown.is_hidden(n))
            fmt::print("{}\n", left_out_words(plan.fragments[static_cast<std::size_t>(n)].name, area));
}

}  // namespace tactus::command
