// SPDX-License-Identifier: Apache-2.0
#include "tools/window/desk/desk.hpp"

#include "tools/window/desk/run_bar.hpp"
#include "tools/window/desk/state_banner.hpp"
#include "tools/window/frame/whole_window.hpp"
#include "tools/window/hand/hand_offer.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

namespace tactus::window {

Desk::Desk(Window& window, Workbench& bench, TakeBench* take, WindowMemory& memory)
    : questions(bench),
      window_(window),
      bench_(bench),
      take_(take),
      fonts_{window.body, window.bold, window.large, window.scale(), window.small},
      patch_(bench),
      nodes_(bench),
      scopes_(bench),
      scene_(bench),
      calibration_(bench, scene_),
      plan_(bench, scene_),
      slices_(bench, scene_, plan_.case_run(), memory),
      train_(bench),
      memory_(memory),
      start_page_(memory),
      faults_(bench) {
    patch_.is_read_only = nodes_.is_read_only = take != nullptr;
    if (take) {
        const std::filesystem::path& folder = take->take().folder;
        scopes_.folder_of_take = folder.has_filename() ? folder : folder.parent_path();
    }
    commands_ = make_commands();
    nodes_.ask_file = [this](const std::string& title, FileChooser chooser, FileDialog::Done done) {
        ask_file(title, std::move(chooser), std::move(done));
    };
    scopes_.ask_value = [this](ValueQuestion question) { value_.ask(std::move(question)); };
    slices_.ask_scan = [this] { ask_scan(); };
    questions.save_plan = [this] { return save_plan(); };
    bench_.asset_for_run = [this]() -> std::optional<std::pair<std::string, std::filesystem::path>> {
        const CaseRun& run = plan_.case_run();
        if (!plan_document_ || run.asset().empty()) return std::nullopt;
        return std::pair(run.asset(), plan_document_->file_for_run(bench_.status()->folder));
    };
    if (!take_) scene_.hand().offer = [this] { draw_hand_offer(bench_); };
}

const Feed* Desk::feed() const {
    if (take_) return &take_->feed();
    return live_.get();
}

/// A new run resets everything that shows the previous run.
void Desk::follow_run() {
    if (take_) {
        take_->tend(static_cast<double>(ImGui::GetIO().DeltaTime));
        take_->feed().traced_s = scopes_.longest_span();
        take_->feed().follow(looked_at_, scopes_.traced());
        return;
    }
    bench_.tend();
    scene_.hand().stand(bench_.status()->state == RunStatus::State::stands);
    if (runs_ != bench_.runs()) {
        runs_ = bench_.runs();
        live_ = bench_.observer() ? std::make_unique<LiveFeed>(bench_.observer()) : nullptr;
    }
    if (!live_) return;
    live_->set_now(bench_.status()->time);
    std::set<std::string> traced = scopes_.traced();
    calibration_.add_traced(traced);
    live_->follow(looked_at_, traced);
}

void Desk::rest() {
    if (take_) return bench_.tend();
    follow_run();
    tend_plan();
    // Steps of a run that nobody sees are kept, too.
    plan_.case_run().tend(bench_.observer());
}

void Desk::show_messages(double height) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, vec({8.0 * fonts_.scale, 4.0 * fonts_.scale}));
    ImGui::BeginChild("messages", vec({0.0, height}), false, ImGuiWindowFlags_AlwaysUseWindowPadding);
    ImGui::PopStyleVar();
    const auto& all = bench_.messages();
    for (std::size_t i = all.size() > 60 ? all.size() - 60 : 0; i < all.size(); ++i) {
        ImGui::PushStyleColor(ImGuiCol_Text, all[i].is_problem ? tone::bad : tone::dim);
        ImGui::TextWrapped("%s", all[i].text.c_str());
        ImGui::PopStyleColor();
    }
    // The list holds the latest only: its length says nothing about what is new.
    if (std::exchange(told_seen_, bench_.told()) != bench_.told()) ImGui::SetScrollHereY(1.0f);
    ImGui::EndChild();
}

void Desk::draw_faults(double height, double gap) {
    const std::string node = faults_.draw(height, fonts_);
    ImGui::Dummy(vec({1.0, gap}));
    if (node.empty()) return;
    if (!shows(columns_, Panel::patch)) use_layout(Layout::patch);
    patch_.choose_only(node);
    patch_.look_at(node);
}

void Desk::shortcuts() {
    if (ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) return;
    const bool is_typing = ImGui::GetIO().WantTextInput;
    if (!start_page_.is_open) return run_pressed(commands_, is_typing);
    // The page hides the patch, which no key may change then.
    std::vector<Command> some;
    for (const Command& command : commands_)
        if (command.menu == "File" || command.menu == "Help") some.push_back(command);
    run_pressed(some, is_typing);
}

void Desk::ask_farewell() {
    if (farewell == Farewell::asks && !ImGui::IsPopupOpen("The patch is still running"))
        ImGui::OpenPopup("The patch is still running");
    ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Appearing, ImVec2(0.5f, 0.5f));
    if (!ImGui::BeginPopupModal("The patch is still running", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return;
    if (farewell_is_of_window) ImGui::Text("The window is closing. Continue the run?");
    else ImGui::Text("%s is still running, and ends when another one opens.", bench_.title().c_str());
    const auto choose = [&](const char* label, Farewell what) {
        if (!ImGui::Button(label)) return;
        farewell = what;
        ImGui::CloseCurrentPopup();
    };
    mark_spot("farewell");
    choose("End it", Farewell::ends);
    ImGui::SameLine();
    if (farewell_is_of_window) {
        choose("Continue the run", Farewell::goes_on);
        ImGui::SameLine();
    }
    choose(farewell_is_of_window ? "Keep the window (Esc)" : "Cancel (Esc)", Farewell::none);
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
        farewell = Farewell::none;
        ImGui::CloseCurrentPopup();
    }
    if (farewell == Farewell::none) questions.want_all();
    ImGui::EndPopup();
}

void Desk::draw() {
    plan_.begin_again();
    follow_run();
    scene_.hand().begin_picture();
    looked_at_.clear();
    fonts_ = {window_.body, window_.bold, window_.large, window_.scale(), window_.small};
    begin_whole_window("desk", fonts_);
    shortcuts();
    tend_plan();
    // Also behind the start page: a step or a pause keeps the run from beginning again.
    plan_.tend(take_ ? nullptr : bench_.observer());
    if (start_page_.is_open) return draw_start();
    // On a narrow window the words of the run need the room of the menus.
    draw_menus(commands_, static_cast<double>(ImGui::GetWindowWidth()) > 1000.0 * fonts_.scale ? 1e9 : 0.0,
               std::exchange(wants_menus_, false));
    run_bar(bench_, *bench_.status(), take_, edit_buttons(), fonts_);
    const double gap = 6.0 * fonts_.scale, messages = 38.0 * fonts_.scale;
    const double width = static_cast<double>(ImGui::GetContentRegionAvail().x);
    const double room = static_cast<double>(ImGui::GetContentRegionAvail().y) - messages - 2.0 * gap;
    const double errors = take_ ? 0.0 : faults_.height(room, fonts_);
    const double height = room - (errors > 0.0 ? errors + gap : 0.0);
    // Three slices and a scene need more than a small window has.
    slices_.propose(height > 620.0 * fonts_.scale);
    arrange(width);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0.0f, 0.0f));
    for (std::size_t c = 0; c < columns_.size(); ++c) {
        const bool is_last = c + 1 == columns_.size();
        ImGui::BeginChild(fmt::format("column {}", c).c_str(),
                          vec({is_last ? 0.0 : columns_[c].share * width, height}));
        draw_column(c, height);
        ImGui::EndChild();
        if (is_last) break;
        if (const double by = splitter(fmt::format("behind column {}", c), true, height); by != 0.0) {
            move_border(columns_, c, by / std::max(width, 1.0));
            moves_border_ = true;
        }
    }
    ImGui::PopStyleVar();
    keep_borders();
    if (!shows(columns_, Panel::slices)) slices_.rest();
    ImGui::Dummy(vec({1.0, gap}));
    if (errors > 0.0) draw_faults(errors, gap);
    show_messages(messages);
    ask_farewell();
    if (!take_) plan_.draw_questions();
    // One dialog at a time.
    draw_dialogs();
    if (farewell != Farewell::asks && !dialog_.is_open()) questions.draw();
    ImGui::End();
    if (!take_) state_banner(bench_, fonts_);
    if (!shows(columns_, Panel::scene)) scene_.rest();
    if (std::exchange(scene_.wants_calibration, false)) calibration_.is_open = true;
    calibration_.draw(live_.get());
    ImGui::PopFont();
}

}  // namespace tactus::window
