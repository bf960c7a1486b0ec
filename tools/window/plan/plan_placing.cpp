// SPDX-License-Identifier: Apache-2.0
// Puts the chosen fragment to where it fits, to where the scan has it or on the mirrored side, and records that it is at
// its place.
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"
#include "tools/analysis/bone/intact_side.hpp"
#include "tools/analysis/plan/plan_accept.hpp"
#include "tools/analysis/plan/plan_case.hpp"
#include "tools/window/plan/plan_button.hpp"
#include "tools/window/plan/plan_panel.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>

#include <exception>
#include <stop_token>
#include <utility>

namespace tactus::window {

void PlanPanel::follow_state() {
    if (!case_.plan() || std::exchange(state_version_, case_.version()) == case_.version()) return;
    const plan::PlanState state = plan::state_of(*case_.plan());
    has_mirror_ = state.mirror.has_value();
    arrangement_ = state.arrangement;
}

bool PlanPanel::can_place() {
    follow_state();
    const std::vector<int> chosen = scene_.chosen_places();
    return case_.can_give() && case_.plan() && chosen.size() == 1 &&
           chosen.front() < static_cast<int>(arrangement_->size()) && arrangement_->can_move(chosen.front()) &&
           !mover_.is_dragging() && !fits_.is_searching() && !placing_.is_busy();
}

bool PlanPanel::has_mirror() {
    follow_state();
    return case_.plan() && has_mirror_;
}

void PlanPanel::placing_buttons() {
    const bool can = can_place();
    if (plan_button("snap to fit", can, "finds where the fracture of the chosen fragment fits, and puts it there",
                    true))
        snap();
    if (plan_button("put back", can, "the chosen fragment to where the scan has it: a step of the plan")) put_back();
    if (plan_button("to the mirror", can && has_mirror(),
                    has_mirror() ? "the chosen fragment to its best pose on the mirrored healthy side"
                                 : "the plan has no healthy side; 'tactus plan mirror' lays it on the case"))
        put_on_mirror();
    if (plan_button("accept", can, "records your decision that the chosen fragment is at its place")) accept();
    candidates();
}

void PlanPanel::put_back() {
    end_candidates();
    case_.give(plan::PlaceFragment{scene_.chosen_places().front(), Pose{}});
}

void PlanPanel::snap() {
    end_candidates();
    placing_of_ = case_.newest();
    fits_.search(placing_of_, scene_.chosen_places().front());
}

void PlanPanel::put_on_mirror() {
    end_candidates();
    placing_of_ = case_.newest();
    placing_.begin(
        analysis::Lane::moves,
        [plan = placing_of_, fragment = scene_.chosen_places().front()](std::stop_token stop) -> Placing {
            const StopScope scope(std::move(stop));
            const plan::PlanState state = plan::state_of(*plan);
            const auto side = analysis::healthy_side(state, {});
            if (!side) throw Error("the plan has no healthy side; 'tactus plan mirror' lays it on the case");
            const plan::PlanFragment one = plan::fragments_of(*plan, state)[static_cast<std::size_t>(fragment)];
            fit::RegistrationSettings settings;
            settings.widest = 10e-3;
            const fit::Registration found = fit::register_surface(analysis::load_fragment(one, {}).bone.points, *side,
                                                                  state.arrangement.pose(fragment), settings);
            return {plan::PlaceFragment{fragment, found.pose},
                    fmt::format("{}: {:.2f} mm from the mirrored side (median), before {:.2f} mm", one.name,
                                found.median * 1e3, found.before * 1e3)};
        });
}

void PlanPanel::accept() {
    end_candidates();
    placing_of_ = case_.newest();
    placing_.begin(analysis::Lane::moves,
                   [plan = placing_of_, fragment = scene_.chosen_places().front()](std::stop_token stop) -> Placing {
                       const StopScope scope(std::move(stop));
                       const analysis::Acceptance found =
                           analysis::measure_acceptance(*plan, {}, fragment, plan::FitBasis::hand);
                       return {analysis::accepting(*plan, fragment, plan::FitBasis::hand, found),
                               fmt::format("{}: accepted beside {}, residual {:.2f} mm",
                                           plan->fragments[static_cast<std::size_t>(fragment)].name, found.partner,
                                           found.residual * 1e3)};
                   });
}

/// Once per picture: what was computed becomes a step, or a list to choose from.
void PlanPanel::tend_placing() {
    // A list that was made for another state of the plan means nothing any more.
    if (found_ && found_->plan != case_.newest()) end_candidates();
    // The fragment was dragged on from the place that was offered.
    if (found_ && !mover_.offers()) {
        found_.reset();
        placed_.clear();
    }
    try {
        if ((placing_.is_busy() || fits_.is_searching()) && placing_of_ != case_.newest()) {
            placing_.let_go();
            fits_.cancel();
            throw Error("the plan was changed meanwhile; ask again");
        }
        if (placing_.is_ready()) {
            Placing made = placing_.take();
            case_.give(made.command);
            placed_ = std::move(made.words);
        }
        auto found = fits_.take();
        if (!found) return;
        if (found->candidates.empty()) {
            placed_ =
                fmt::format("{} stays where it is: {}",
                            found->plan->fragments[static_cast<std::size_t>(found->fragment)].name, found->reason);
            return;
        }
        const FitCandidate& best = found->candidates.front();
        const bool is_certain = best.fits() && (found->candidates.size() < 2 || !found->candidates[1].fits());
        if (is_certain) {
            case_.give(best.step);
            placed_ = best.words;
            return;
        }
        found_ = std::move(found);
        candidate_ = 0;
        show_candidate();
    } catch (const std::exception& error) {
        placed_ = error.what();
        bench_.tell(placed_, true);
    }
}

void PlanPanel::show_candidate() { mover_.offer(found_->fragment, found_->candidates[candidate_].step.pose); }

void PlanPanel::end_candidates() {
    if (std::exchange(found_, std::nullopt)) mover_.show_plan();
    placed_.clear();
}

void PlanPanel::candidates() {
    if (fits_.is_searching()) {
        ImGui::ProgressBar(static_cast<float>(fits_.progress()), ImVec2(-7.0f * ImGui::GetFontSize(), 0.0f),
                           "searching for a fit");
        mark_spot("searching for a fit");
        ImGui::SameLine();
        if (ImGui::SmallButton("cancel")) fits_.cancel();
        mark_spot("cancel search");
    }
    if (placing_.is_busy()) {
        ImGui::TextDisabled("measuring ...");
        mark_spot("place is measured");
        ImGui::SameLine();
        if (ImGui::SmallButton("cancel##measuring")) placing_.let_go();
        mark_spot("cancel measuring");
    }
    if (!placed_.empty()) {
        ImGui::TextWrapped("%s", placed_.c_str());
        mark_spot("placed");
    }
    if (!found_) return;
    const std::size_t count = found_->candidates.size();
    const FitCandidate& shown = found_->candidates[candidate_];
    const auto step = [&](const char* label, const char* spot, std::size_t to) {
        if (ImGui::SmallButton(label)) {
            candidate_ = to % count;
            show_candidate();
        }
        mark_spot(spot);
        ImGui::SameLine();
    };
    step("<", "candidate before", candidate_ + count - 1);
    ImGui::Text("%zu of %zu", candidate_ + 1, count);
    ImGui::SameLine();
    step(">", "next candidate", candidate_ + 1);
    const bool can = shown.is_possible();
    if (plan_button("put it there", can,
                    shown.fits() ? "a step of the plan"
                    : can        ? "a step of the plan without a fit; 'accept' records your decision"
                                 : "this place is not certain enough, or not possible")) {
        const plan::SettleFragment to = shown.step;
        placed_ = shown.words;
        found_.reset();
        case_.give(shown.fits() ? plan::PlanCommand(to) : plan::PlanCommand(plan::PlaceFragment{to.fragment, to.pose}));
        return mover_.show_plan();
    }
    if (plan_button("leave it", true, "the fragment stays where the plan has it")) return end_candidates();
    ImGui::PushStyleColor(ImGuiCol_Text, shown.fits() ? tone::good : tone::warm);
    ImGui::TextWrapped("%s", shown.words.c_str());
    ImGui::PopStyleColor();
}

}  // namespace tactus::window
