// SPDX-License-Identifier: Apache-2.0
#include "tools/window/plan/plan_alternatives.hpp"

#include "assets/plan/plan_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/leaving.hpp"
#include "tools/window/frame/tooltip.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <exception>

namespace tactus::window {

namespace {

int find(const plan::CasePlan& plan, const std::string& name) {
    const auto found = std::ranges::find(plan.alternatives, name, &plan::PlanAlternative::name);
    return found == plan.alternatives.end() ? -1 : static_cast<int>(found - plan.alternatives.begin());
}

/// The next control, with this label, on the same line if it fits.
void continue_line(const char* label) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float wide = ImGui::CalcTextSize(label).x + ImGui::GetFrameHeight() + 2.0f * style.ItemSpacing.x;
    if (ImGui::GetItemRectMax().x + wide < ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x)
        ImGui::SameLine();
}

}  // namespace

void PlanAlternatives::tend() {
    if (counting_.is_ready()) {
        numbers_.clear();
        try {
            for (const AlternativeNumbers& one : counting_.take()) numbers_.push_back(words_of(one));
        } catch (const std::exception& error) {
            bench_.tell(error.what(), true);
        }
    }
    const plan::CasePlan* plan = run_.plan();
    const int other = plan ? find(*plan, compared_) : -1;
    if (other < 0 || other == plan->current) {
        if (!shown_.empty()) scene_.compare({}, "");
        shown_.clear();
        return;
    }
    if (shown_ == compared_ && of_ == run_.version()) return;
    if (counting_.is_busy()) return;  // of the plan as it was; then again
    if (!scene_.is_fitted()) return;  // the middles of the fragments are known when their bodies are made
    shown_ = compared_;
    of_ = run_.version();
    scene_.compare(poses_of_alternative(*plan, other), compared_);
    std::vector<Vec3> middles;
    for (const auto& body : scene_.plan_bodies()) middles.push_back(body ? body->home.position : Vec3(0.0));
    differences_ = differences(*plan, plan->current, other, middles);
    counting_.begin(analysis::Lane::studies,
                    analysis::leaving([plan = *plan, other, folder = run_.file().parent_path()] {
                        return Numbers{numbers_of_alternative(plan, plan.current, folder),
                                       numbers_of_alternative(plan, other, folder)};
                    }));
}

void PlanAlternatives::ask_name() {
    const plan::CasePlan* const plan = run_.plan();
    if (!plan) return;
    name_ = plan->alternatives[static_cast<std::size_t>(plan->current)].name;
    wants_question_ = true;
}

void PlanAlternatives::draw_question() {
    constexpr const char* title = "another name for the alternative";
    if (std::exchange(wants_question_, false)) ImGui::OpenPopup(title);
    ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Appearing, ImVec2(0.5f, 0.5f));
    if (!ImGui::BeginPopup(title)) return;
    const plan::CasePlan* const plan = run_.plan();
    ImGui::TextUnformatted(title);
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(16.0f * ImGui::GetFontSize());
    const bool is_entered = ImGui::InputText("##asked name", &name_,
                                             ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    mark_spot("asked name of the alternative");
    ImGui::TextDisabled("The run begins again with it. Enter: take it; Esc: leave the old one.");
    if (is_entered && plan) rename(plan->alternatives[static_cast<std::size_t>(plan->current)].name, name_);
    if (is_entered || !plan || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

void PlanAlternatives::ask_name(int place, const std::string& name) {
    renamed_ = place;
    name_ = name;
    wants_focus_ = true;
}

/// Enter takes the name, Escape and a click elsewhere leave the old one.
void PlanAlternatives::name_field(int place) {
    if (std::exchange(wants_focus_, false)) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-1.0f);
    const bool is_entered =
        ImGui::InputText("##name", &name_, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    mark_spot("name of the alternative");
    if (is_entered) rename(run_.plan()->alternatives[static_cast<std::size_t>(place)].name, name_);
    if (is_entered || ImGui::IsItemDeactivated()) renamed_ = -1;
}

void PlanAlternatives::rename(const std::string& name, const std::string& wanted) {
    if (name == wanted) return;
    if (wanted.empty() || (run_.plan() && find(*run_.plan(), wanted) >= 0))
        return bench_.tell(
            fmt::format("an alternative cannot be named '{}': a name must not be empty, nor that of another", wanted),
            true);
    if (!wanted_name_.second.empty() && wanted_name_.first != name)
        return bench_.tell(fmt::format("'{}' is still being renamed; try again in a moment", wanted_name_.first), true);
    if (run_.changes_document()) {
        plan::CasePlan plan = run_.document()->plan();
        const int place = find(plan, name);
        if (place < 0 || find(plan, wanted) >= 0)
            return bench_.tell(
                fmt::format("'{}' cannot be named '{}': the alternatives are others by now", name, wanted), true);
        plan.alternatives[static_cast<std::size_t>(place)].name = wanted;
        return run_.document()->adopt(std::make_shared<const plan::CasePlan>(std::move(plan)));
    }
    if (run_.may_begin_again()) wanted_name_ = {name, wanted};
}

std::filesystem::path PlanAlternatives::take_changed() {
    if (wanted_name_.second.empty() || !run_.plan() || !run_.is_settled()) return {};
    if (!run_.is_live()) {
        bench_.tell(fmt::format("the run has ended: '{}' keeps its name", std::exchange(wanted_name_, {}).first), true);
        return {};
    }
    try {
        plan::CasePlan plan = *run_.plan();
        const auto [name, wanted] = std::exchange(wanted_name_, {});
        const int place = find(plan, name);
        if (place < 0 || find(plan, wanted) >= 0)
            throw Error(fmt::format("'{}' cannot be named '{}': the alternatives are others by now", name, wanted));
        plan.alternatives[static_cast<std::size_t>(place)].name = wanted;
        const std::filesystem::path file = free_plan(run_.file().parent_path());
        plan::save_case_plan(plan, file);
        return file;
    } catch (const std::exception& error) {
        wanted_name_ = {};
        bench_.tell(error.what(), true);
    }
    return {};
}

bool PlanAlternatives::waits_for_list() const {
    // What the run refuses never comes.
    constexpr double longest_s = 5.0;
    return run_.is_asked() || (asked_of_ == run_.version() && ImGui::GetTime() - asked_at_ < longest_s);
}

void PlanAlternatives::note_asked() {
    asked_of_ = run_.version();
    asked_at_ = ImGui::GetTime();
}

void PlanAlternatives::go_to(int place) {
    note_asked();
    run_.give(plan::GoToAlternative{place});
}

void PlanAlternatives::drop(int place) {
    note_asked();
    run_.give(plan::DropAlternative{place});
}

void PlanAlternatives::list(const plan::CasePlan& plan) {
    for (int n = 0; n < static_cast<int>(plan.alternatives.size()); ++n) {
        const std::string& name = plan.alternatives[static_cast<std::size_t>(n)].name;
        ImGui::PushID(n);
        if (renamed_ == n) {
            name_field(n);
            ImGui::PopID();
            continue;
        }
        const bool is_current = n == plan.current;
        if (ImGui::RadioButton(name.c_str(), is_current) && !is_current) go_to(n);
        mark_spot("alternative " + name);
        if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) ask_name(n, name);
        if (ImGui::IsItemHovered())
            show_tooltip(fmt::format("{}: {}; double click: another name, with which the run begins again", name,
                                     is_current ? "the scene shows this one" : "the scene goes to this one"));
        if (!is_current) {
            continue_line("compare");
            bool is_compared = compared_ == name;
            if (ImGui::Checkbox("compare", &is_compared)) compared_ = is_compared ? name : "";
            mark_spot("compare " + name);
            if (ImGui::IsItemHovered()) show_tooltip("drawn through the current one, in a second colour");
            continue_line("drop");
            if (ImGui::SmallButton("drop")) drop(n);
            mark_spot("drop " + name);
            if (ImGui::IsItemHovered()) show_tooltip("its steps stay in the file; 'restore' brings it back");
        }
        ImGui::PopID();
    }
}

void PlanAlternatives::draw() {
    if (!run_.plan()) return;
    const plan::CasePlan& plan = *run_.plan();
    ImGui::BeginDisabled(!(run_.is_live() || run_.changes_document()) || waits_for_list());
    if (ImGui::Button("new from here")) go_to(static_cast<int>(plan.alternatives.size()));
    mark_spot("new from here");
    if (ImGui::IsItemHovered()) show_tooltip("begins an alternative at the plan as it is now");
    ImGui::SameLine();
    if (ImGui::Button("restore")) run_.give(plan::RestoreAlternative{});
    mark_spot("restore alternative");
    if (ImGui::IsItemHovered()) show_tooltip("brings the alternative that was dropped last in this run back");
    list(plan);
    ImGui::EndDisabled();
    if (shown_.empty()) return;
    for (const std::string& line : numbers_) ImGui::TextWrapped("%s", line.c_str());
    if (counting_.is_busy()) ImGui::TextDisabled("...");
    if (differences_.empty()) ImGui::TextDisabled("all fragments lie alike");
    for (const std::string& line : differences_) ImGui::TextWrapped("%s", line.c_str());
}

}  // namespace tactus::window
