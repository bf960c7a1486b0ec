// SPDX-License-Identifier: Apache-2.0
#include "tools/window/desk/run_bar.hpp"

#include "tools/window/desk/take_bench.hpp"
#include "tools/window/frame/tooltip.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::window {

namespace {

enum class Sign { play, pause, stop, record };

/// A button with a drawn symbol.
bool sign_button(const char* id, Sign sign, ImU32 ink, bool is_on, const char* tip) {
    const float size = ImGui::GetFrameHeight();
    if (is_on) ImGui::PushStyleColor(ImGuiCol_Button, faded(ink, 0.35));
    const bool pressed = ImGui::Button(id, ImVec2(1.4f * size, size));
    if (is_on) ImGui::PopStyleColor();
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const ImVec2 c((low.x + high.x) * 0.5f, (low.y + high.y) * 0.5f);
    const float r = 0.24f * size;
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (sign == Sign::play)
        list->AddTriangleFilled({c.x - 0.8f * r, c.y - r}, {c.x + r, c.y}, {c.x - 0.8f * r, c.y + r}, ink);
    if (sign == Sign::stop) list->AddRectFilled({c.x - r, c.y - r}, {c.x + r, c.y + r}, ink, 1.0f);
    if (sign == Sign::record) list->AddCircleFilled(c, 1.1f * r, ink);
    if (sign == Sign::pause) {
        list->AddRectFilled({c.x - r, c.y - r}, {c.x - 0.3f * r, c.y + r}, ink, 1.0f);
        list->AddRectFilled({c.x + 0.3f * r, c.y - r}, {c.x + r, c.y + r}, ink, 1.0f);
    }
    mark_spot(id + 2);
    if (ImGui::IsItemHovered()) show_tooltip(tip);
    ImGui::SameLine();
    return pressed;
}

/// A text button; the text is its name for scripts.
bool button(const char* label) {
    const bool pressed = ImGui::Button(label);
    mark_spot(label);
    return pressed;
}

/// Where the words of the bar end: what stands on the right must never leave the window.
float words_end = 0.0f;

/// Words that do not fit before `words_end` are left out.
void words(const std::string& text, ImU32 ink) {
    if (ImGui::GetCursorPosX() + ImGui::CalcTextSize(text.c_str()).x > words_end) return;
    ImGui::PushStyleColor(ImGuiCol_Text, ink);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopStyleColor();
    ImGui::SameLine();
}

/// Whether the hands feel forces.
void forces_word(const RunStatus& status) {
    using control::ForceState;
    const run::HandForces* worst = nullptr;
    for (const run::HandForces& forces : status.forces)
        if (!worst || forces.state > worst->state) worst = &forces;
    if (worst) {
        const bool is_off = control::is_off(worst->state);
        const bool is_on = worst->state == ForceState::on || worst->state == ForceState::ramps;
        words(is_off  ? "forces off"
              : is_on ? "forces on"
                      : "forces wait",
              is_off  ? tone::bad
              : is_on ? tone::good
                      : tone::warm);
    }
}

bool wants_faults = false;

std::string faults_label(const RunStatus& status) {
    // Of a device the newest 64 are kept.
    constexpr std::size_t max_kept = 64;
    return fmt::format("{}{} fault{}###faults", status.faults.size(), status.faults.size() >= max_kept ? "+" : "",
                       status.faults.size() > 1 ? "s" : "");
}

/// Faults of the run behind a button, which stays when the run is over.
void history_of_faults(const RunStatus& status) {
    const bool asked = std::exchange(wants_faults, false);
    if (status.faults.empty()) return;
    if (ImGui::Button(faults_label(status).c_str()) || asked) ImGui::OpenPopup("history of faults");
    mark_spot("faults");
    ImGui::SameLine();
    if (!ImGui::BeginPopup("history of faults")) return;
    for (const run::FaultOnRecord& fault : status.faults) {
        ImGui::PushStyleColor(ImGuiCol_Text, fault.over_s < 0.0 ? tone::bad : tone::text);
        ImGui::TextUnformatted(fault.text().c_str());
        ImGui::PopStyleColor();
    }
    ImGui::EndPopup();
}

constexpr const char* look_label = "Look at the take";

bool offers_take(Workbench& bench, const RunStatus& status) {
    const bool runs = bench.running() && status.state != RunStatus::State::over;
    return !runs && !bench.take().empty() && std::filesystem::exists(bench.take() / "result.json");
}

float button_width(const char* label) {
    return ImGui::CalcTextSize(label, nullptr, true).x + 2.0f * ImGui::GetStyle().FramePadding.x +
           ImGui::GetStyle().ItemSpacing.x;
}

void run_buttons(Workbench& bench, const RunStatus& status) {
    using State = RunStatus::State;
    const bool runs = bench.running() && status.state != State::over;
    const bool paused = status.state == State::stands || status.state == State::fades;
    if (!runs) {
        if (sign_button("##run", Sign::play, tone::good, false, "Run the patch")) bench.run();
    } else if (sign_button("##stop", Sign::stop, tone::text, false, "End the run")) bench.stop();
    ImGui::BeginDisabled(!runs);
    if (sign_button("##pause", Sign::pause, tone::warm, paused,
                    "Pause: forces fade, then logical time stands still (Space)"))
        bench.pause(!paused);
    ImGui::EndDisabled();
    const char* tip = status.is_recording ? "End the recording" : runs ? "Record from now on" : "Run and record";
    if (sign_button("##record", Sign::record, tone::bad, runs && status.is_recording, tip))
        bench.record(!(runs && status.is_recording));
    static const char* const names[] = {"loading", "runs", "forces fade", "paused", "not running"};
    const ImU32 ink = status.state == State::runs ? tone::good : status.state == State::stands ? tone::warm : tone::dim;
    const bool has_take = offers_take(bench, status);
    // A button comes before words.
    if (has_take) words_end -= button_width(look_label);
    words(names[static_cast<std::size_t>(status.state)], ink);
    if (has_take) {
        words_end += button_width(look_label);
        ImGui::BeginDisabled(!bench.editor().is_saved());
        if (button(look_label)) bench.wants_take = true;
        ImGui::EndDisabled();
        ImGui::SameLine();
    }
    if (!runs) return;
    forces_word(status);
    words(fmt::format("{:8.2f} s", status.time), tone::text);
    words(fmt::format("{:5.2f} N on the hand", status.force), status.force > 0.01 ? tone::text : tone::dim);
    std::int64_t missed = 0, ticks = 0;
    double late = 0.0;
    for (const GroupStatus& group : status.groups) {
        missed += group.missed;
        ticks += group.ticks;
        late = std::max(late, group.late_max_ms);
    }
    // Red above 1 % of late ticks only: a single late tick is not an error.
    const bool is_bad = 100 * missed > ticks;
    words(fmt::format("{} late, at most {:.2f} ms", missed, late), is_bad ? tone::bad : tone::dim);
}

void take_line(Workbench& bench, TakeBench& take) {
    if (bench.has_patch_behind) {
        if (button("Back to the patch")) bench.wants_patch = true;
        ImGui::SameLine();
    }
    float at = static_cast<float>(take.time());
    if (sign_button("##play", take.is_playing() ? Sign::pause : Sign::play, tone::good, false, "Play the take (Space)"))
        take.play(!take.is_playing());
    words(fmt::format("{:.3f} s of {:.3f} s", take.time(), take.length()), tone::text);
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - 17.0f * ImGui::GetFontSize());
    if (ImGui::SliderFloat("##time", &at, 0.0f, static_cast<float>(take.length()), "%.3f s"))
        take.go_to(static_cast<double>(at));
    mark_spot("time");
    // The recorded stretches, below the time line.
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    for (const Range& stretch : take.feed().recorded()) {
        const auto x = [&](double t) { return low.x + static_cast<float>(t / take.length()) * (high.x - low.x); };
        ImGui::GetWindowDrawList()->AddRectFilled({x(stretch.low), high.y - 3.0f}, {x(stretch.high), high.y},
                                                  tone::bad);
    }
    ImGui::SameLine();
    constexpr std::size_t room = 34;
    const std::string note = take.scene_note();
    // Not within a letter.
    std::size_t end = std::min(room, note.size());
    while (end < note.size() && end > 0 && (static_cast<unsigned char>(note[end]) & 0xC0) == 0x80) --end;
    words(end < note.size() ? note.substr(0, end) + "..." : note, tone::dim);
    if (note.size() > room && ImGui::IsItemHovered()) show_tooltip(note);
    ImGui::NewLine();
}

}  // namespace

void show_faults(Workbench& bench) {
    if (bench.status()->faults.empty()) bench.tell("this run has had no fault");
    else wants_faults = true;
}

void run_bar(Workbench& bench, const RunStatus& status, TakeBench* take, const EditButtons& edits, const Fonts& fonts) {
    const char* const save = edits.is_saved ? "Saved" : "Save";
    const ImGuiStyle& style = ImGui::GetStyle();
    float wide = 3.0f * 2.0f * style.FramePadding.x + 3.0f * style.ItemSpacing.x + style.WindowPadding.x;
    for (const char* label : {"Undo", "Redo", save}) wide += ImGui::CalcTextSize(label).x;
    if (!status.faults.empty()) wide += button_width(faults_label(status).c_str());
    words_end = ImGui::GetWindowWidth() - (take ? 0.0f : wide);
    // A long title leaves room for the buttons of the run.
    const float signs = 3.0f * (1.4f * ImGui::GetFrameHeight() + style.ItemSpacing.x) + 2.0f * style.WindowPadding.x +
                        (!take && offers_take(bench, status) ? button_width(look_label) : 0.0f);
    const double room = static_cast<double>(std::clamp(words_end - signs, 0.0f, 0.3f * ImGui::GetWindowWidth()));
    const Painter paint(ImGui::GetWindowDrawList(), fonts);
    ImGui::PushFont(fonts.bold);
    if (room > 3.0 * static_cast<double>(ImGui::GetFontSize()))
        words(paint.shortened(bench.title(), static_cast<double>(ImGui::GetFontSize()), room, true), tone::text);
    ImGui::PopFont();
    if (take) return take_line(bench, *take);
    run_buttons(bench, status);
    ImGui::SameLine(words_end);
    history_of_faults(status);
    ImGui::BeginDisabled(!edits.can_undo);
    if (button("Undo")) edits.undo();
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::BeginDisabled(!edits.can_redo);
    if (button("Redo")) edits.redo();
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::BeginDisabled(edits.is_saved);
    if (button(save)) edits.save();
    ImGui::EndDisabled();
}

}  // namespace tactus::window
