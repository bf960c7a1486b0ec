// SPDX-License-Identifier: Apache-2.0
#include "tools/window/plan/plan_panel.hpp"

#include "assets/plan/plan_file.hpp"
#include "assets/plan/plan_files.hpp"
#include "dsp/fit/fit.hpp"
#include "tools/window/frame/tooltip.hpp"
#include "tools/window/plan/plan_button.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tactus::window {

/// Grasp, snap and settle are buttons of the hand; each stays held until it is pressed again.
void PlanPanel::hand_buttons() {
    if (!scene_.hand().is_there()) return;
    struct Named {
        const char *what, *label, *tip;
    };
    constexpr Named all[] = {
        {"grasp", "grasp", "hold the fragment at the hand; again: let it go"},
        {"snap", "snap", "look for a fit of the held fragment, and pull it there; again: no longer"},
        {"settle", "settle", "put the held fragment where it fits; a step of the plan"}};
    bool is_first = true;
    for (const Named& named : all) {
        const auto number = case_.hand_button(named.what);
        if (!number) continue;
        const bool is_held = scene_.hand().is_held(*number);
        if (is_held) ImGui::PushStyleColor(ImGuiCol_Button, faded(tone::good, 0.5));
        const bool pressed = plan_button(named.label, true, named.tip, is_first);
        if (is_held) ImGui::PopStyleColor();
        if (is_held) mark_spot(std::string(named.label) + " is held");
        if (pressed) scene_.hand().hold(*number, !is_held);
        is_first = false;
    }
}

void PlanPanel::fit_line() const {
    const auto fit = case_.fit();
    if (!fit) return;
    if (fit->fragment < 0) return ImGui::TextDisabled("no fragment is being fitted");
    const auto name = [&](int place) {
        for (const SceneModel::Part& part : scene_.parts())
            if (part.place == place) return part.name;
        return fmt::format("fragment {}", place + 1);
    };
    const bool is_known = fit->verdict >= 0 && fit->verdict <= static_cast<int>(fit::FitVerdict::uncertain);
    if (!is_known) return ImGui::TextDisabled("%s: not fitted yet", name(fit->fragment).c_str());
    const auto verdict = fit::name_of(static_cast<fit::FitVerdict>(fit->verdict));
    std::string text = fmt::format("{}: {}", name(fit->fragment), verdict);
    // Without a partner nothing was measured.
    if (fit->partner < 0) text += "; nothing within reach fits it, bring it closer to its place";
    else
        text += fmt::format(", to {}; score {:.2f}, {:.2f} mm rms, gap {:.2f} mm, overlap {:.2f} mm deep",
                            name(fit->partner), fit->score, fit->rms * 1e3, fit->gap * 1e3, fit->penetration * 1e3);
    ImGui::PushStyleColor(ImGuiCol_Text, fit->fits ? tone::good : tone::warm);
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::PopStyleColor();
}

/// On the fragments that are chosen in the scene, or the one held last.
void PlanPanel::fragment_buttons() {
    const bool can = case_.can_give();
    if (plan_button(
            "group", can && scene_.chosen_places().size() != 1,
            "the chosen fragments move together from now on (Ctrl and click chooses several); with none chosen: the "
            "one held last and its partner",
            true))
        group();
    if (plan_button("split", can, "the chosen fragments, or the one held last, leave their groups")) split();
    if (plan_button("lock", can, "lock or unlock the chosen fragments, or the one held last")) lock();
    if (plan_button("hide in plan", can, "out of pictures and fits: a step of the plan")) hide();
    if (plan_button("show hidden", can, "all that the plan hides")) case_.show_hidden();
}

void PlanPanel::studies() {
    const bool can = case_.plan() && !case_.is_busy();
    if (plan_button("gaps", can, "between the fragments of the plan as it is now", true))
        case_.begin(CaseRun::Study::gaps);
    if (plan_button("mirror", can, "distance of each fragment from the mirrored healthy side"))
        case_.begin(CaseRun::Study::healthy);
    if (plan_button("report", can, "a page with pictures, gaps, fits and steps, in the run's folder"))
        case_.begin(CaseRun::Study::report);
    if (plan_button("export", can, "placed meshes, transforms and landmarks for 3D Slicer, in the run's folder"))
        case_.begin(CaseRun::Study::files);
    if (case_.is_busy()) {
        ImGui::TextDisabled("measuring, %.0f s", case_.busy_s());
        mark_spot("study is made");
        if (case_.can_cancel_study()) {
            ImGui::SameLine();
            if (ImGui::SmallButton("cancel##study")) case_.cancel_study();
            mark_spot("cancel study");
        }
    } else if (!case_.found().empty()) ImGui::TextWrapped("%s", case_.found().c_str());
}

/// Colours of the fragments in the scene.
void PlanPanel::maps() {
    using Kind = PlanMap::Kind;
    const auto choose = [&](const char* label, Kind kind, const char* tip, bool is_first) {
        const bool is_on = map_.shown() == kind;
        if (is_on) ImGui::PushStyleColor(ImGuiCol_Button, faded(tone::good, 0.5));
        const bool pressed = plan_button(label, case_.plan() != nullptr, tip, is_first);
        if (is_on) ImGui::PopStyleColor();
        if (pressed) map_.show(is_on ? std::nullopt : std::optional(kind));
    };
    choose("gap map", Kind::gaps,
           "colours each fragment by its distance to what faces it, where the last step of the plan left them; again: "
           "its own colours",
           true);
    choose("mirror map", Kind::healthy, "colours each fragment by its distance from the mirrored healthy side", false);
    if (!map_.shown()) return;
    const float wide = 7.0f * ImGui::GetFontSize();
    if (ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + wide <
        ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x)
        ImGui::SameLine();
    ImGui::SetNextItemWidth(wide);
    auto range = static_cast<float>(map_.range() * 1e3);
    if (ImGui::DragFloat("##range", &range, 0.02f, 0.1f, 20.0f, "up to %.2f mm", ImGuiSliderFlags_AlwaysClamp))
        map_.set_range(1e-3 * static_cast<double>(range));
    mark_spot("map range");
    if (ImGui::IsItemHovered()) show_tooltip("distance of the fullest colour; drag, or Ctrl and click to type");
    if (map_.is_busy()) {
        ImGui::SameLine();
        ImGui::TextDisabled("...");
    }
}

/// Above all that grows: a hand reaches them without scrolling.
void PlanPanel::history_buttons() {
    if (plan_button("undo step", case_.can_give(), "of the plan; a held fragment is released first", true))
        case_.give(plan::UndoStep{});
    if (plan_button("redo step", case_.can_give(), "of the plan")) case_.give(plan::RedoStep{});
}

void PlanPanel::step_list() {
    if (!case_.plan()) return ImGui::TextDisabled("the run has written no plan yet");
    // In a small panel, below what it shows first: some steps are seen at once.
    const float least = 7.0f * ImGui::GetTextLineHeightWithSpacing();
    ImGui::BeginChild("steps", ImVec2(0.0f, std::max(least, ImGui::GetContentRegionAvail().y)));
    const auto& steps = case_.steps();
    if (steps.empty()) ImGui::TextDisabled("no steps yet");
    for (const StepLine& step : steps) {
        ImGui::PushStyleColor(ImGuiCol_Text, step.is_done ? tone::text : tone::dim);
        ImGui::TextWrapped("%d  %s%s", step.number + 1, step.text.c_str(), step.is_done ? "" : "  (undone)");
        ImGui::PopStyleColor();
    }
    if (listed_ != steps.size()) ImGui::SetScrollHereY(1.0f);
    listed_ = steps.size();
    ImGui::EndChild();
}

/// The run begins again with another hand, and with the plan as it is written.
bool PlanPanel::may_change_hand() {
    const bool may = !case_.is_there() || case_.is_settled();
    if (may) has_told_to_let_go_ = false;
    else if (case_.is_holding() && !std::exchange(has_told_to_let_go_, true)) case_.may_begin_again();
    return may;
}

/// The opened plan has got steps that the run lacks: restored ones, or those of another program.
bool PlanPanel::waits_to_begin_again() {
    wants_to_begin_again_ = case_.document()->take_begin_again() || wants_to_begin_again_;
    // A run begins with the document as it is.
    if (!case_.is_live()) wants_to_begin_again_ = false;
    if (!wants_to_begin_again_ || !case_.is_settled()) return false;
    wants_to_begin_again_ = false;
    return true;
}

void PlanPanel::begin_again() {
    // One after the other: each has what the one before has changed.
    std::filesystem::path changed = flap_.flap().take_changed();
    if (changed.empty() && !flap_.flap().is_changing()) changed = alternatives_.take_changed();
    PlanDocument* const document = case_.document();
    try {
        if (document && !changed.empty()) {
            auto plan = plan::load_case_plan(changed);
            plan::make_files_absolute(plan, std::filesystem::absolute(changed).parent_path());
            document->adopt(std::make_shared<const plan::CasePlan>(std::move(plan)));
            // Without a run the document is all that changes.
            if (!case_.is_live()) {
                std::filesystem::remove(changed);
                return;
            }
        } else if (document && waits_to_begin_again()) changed = document->file_for_run(bench_.status()->folder);
    } catch (const std::exception& error) {
        return bench_.tell(error.what(), true);
    }
    if (changed.empty()) return;
    // What the run has written is there after its end, too.
    const std::filesystem::path now = std::filesystem::absolute(case_.file());
    bench_.run_with(case_.asset(), std::filesystem::absolute(changed), now);
}

void PlanPanel::draw(const Fonts&) {
    hand_buttons();
    history_buttons();
    fit_line();
    placing_buttons();
    fragment_buttons();
    studies();
    maps();
    ImGui::Separator();
    alternatives_.draw();
    ImGui::Separator();
    flap_.draw();
    step_list();
}

}  // namespace tactus::window
