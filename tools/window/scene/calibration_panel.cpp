// SPDX-License-Identifier: Apache-2.0
#include "tools/window/scene/calibration_panel.hpp"

#include "tools/window/frame/tooltip.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <filesystem>

namespace tactus::window {

using analysis::calibrated_display;
using analysis::calibration_steps;
using analysis::check_screens;
using analysis::fit_options;
using analysis::part_text;
using analysis::prompt_of;
using analysis::touches_off;
using analysis::TouchesOff;
using analysis::write_calibrated;

namespace {

void words(ImU32 ink, const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, ink);
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::PopStyleColor();
}

void field(const char* label, const char* hint, std::string& text) {
    ImGui::SetNextItemWidth(17.0f * ImGui::GetFontSize());
    ImGui::InputTextWithHint(label, hint, &text);
    mark_spot(label);
}

bool marked_button(const char* label) {
    const bool pressed = ImGui::Button(label);
    mark_spot(label);
    return pressed;
}

}  // namespace

void CalibrationPanel::add_traced(std::set<std::string>& ports) const {
    if (!watch_) return;
    const std::set<std::string> wanted = watch_->traced();
    ports.insert(wanted.begin(), wanted.end());
}

void CalibrationPanel::draw(const Feed* feed) {
    if (!is_open) return;
    const float unit = ImGui::GetFontSize();
    ImGui::SetNextWindowPos(ImVec2(20.0f * unit, 5.0f * unit), ImGuiCond_Appearing);
    ImGui::SetNextWindowSize(ImVec2(31.0f * unit, 0.0f));
    if (ImGui::Begin("Calibration", &is_open, ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse)) {
        if (lead_) {
            if (feed) lead_on(*feed);
            else words(tone::warm, "The run is over; run it again to continue.");
        } else if (is_unwritten_) write_elsewhere();
        else if (feed) choose(*feed);
        else words(tone::dim, "Run a patch with a device. Its tip touches screens, mirror and known places.");
        if (!problem_.empty()) words(tone::bad, problem_);
        if (fit_) show_fit();
    }
    ImGui::End();
    if (is_open) return;
    lead_.reset();
    watch_.reset();
    marks_.reset();
}

void CalibrationPanel::choose_source(const Feed& feed) {
    const std::vector<TouchSource> sources = touch_sources(feed);
    if (source_.pose.empty() && !sources.empty()) source_ = sources.front();
    const auto list = [&](const char* label, const std::string& chosen, const char* none, const auto& choose_one) {
        ImGui::SetNextItemWidth(17.0f * ImGui::GetFontSize());
        if (!ImGui::BeginCombo(label, chosen.empty() ? none : chosen.c_str())) return;
        if (ImGui::Selectable(none, chosen.empty())) choose_one(TouchSource{});
        for (const TouchSource& one : sources)
            if (ImGui::Selectable(one.pose.c_str(), one.pose == chosen)) choose_one(one);
        ImGui::EndCombo();
    };
    list("hand", source_.pose, "none", [&](const TouchSource& one) {
        source_.pose = one.pose;
        source_.button = one.button;
    });
    list("tracker", source_.tracker, "none: the device is the world",
         [&](const TouchSource& one) { source_.tracker = one.pose; });
    if (ImGui::IsItemHovered())
        show_tooltip("a tracked marker held to the tip: measures the device's pose in the viewer's world");
}

void CalibrationPanel::choose(const Feed& feed) {
    words(tone::dim,
          "Touch the parts of the display with the tip of the device, so that objects appear where they are felt. "
          "Leave known parts empty.");
    choose_source(feed);
    field("tip in the handle", "0 mm, 0 mm, 0 mm", choice_.tip);
    field("known places", "file with x_mm, y_mm, z_mm", places_);
    ImGui::Checkbox("mirror", &choice_.mirror);
    mark_spot("mirror");
    field("screen", "name: its marks are touched", screen_);
    field("image of screen", "name: touched in the mirror", image_);
    ImGui::SetNextItemWidth(17.0f * ImGui::GetFontSize());
    ImGui::SliderInt("marks per side", &choice_.grid, 2, 5);
    mark_spot("marks per side");
    ImGui::SetNextItemWidth(17.0f * ImGui::GetFontSize());
    ImGui::SliderInt("touches of a mirror", &choice_.points, 4, 20);
    mark_spot("touches of a mirror");
    const std::string on = marks_on_ < 0    ? "not shown"
                           : marks_on_ == 0 ? "a window"
                                            : fmt::format("monitor {}", marks_on_);
    ImGui::SetNextItemWidth(17.0f * ImGui::GetFontSize());
    ImGui::SliderInt("marks are on", &marks_on_, -1, 4, on.c_str());
    choose_file();
    if (scene_.display_file()) words(tone::dim, "Parts without touches keep the values of the display file in use.");
    const bool has_steps =
        !places_.empty() || !source_.tracker.empty() || choice_.mirror || !screen_.empty() || !image_.empty();
    ImGui::BeginDisabled(!has_steps || source_.pose.empty() || file_.empty());
    if (marked_button("begin")) begin();
    ImGui::EndDisabled();
}

void CalibrationPanel::choose_file() {
    field("file", "display.toml", file_);
    std::error_code unknown;
    if (!file_.empty() && std::filesystem::exists(file_, unknown))
        words(tone::warm, fmt::format("{} exists and will be replaced.", file_));
}

void CalibrationPanel::begin() {
    problem_.clear();
    said_.clear();
    fit_.reset();
    try {
        choice_.places = places_;
        choice_.tracker = places_.empty() ? source_.tracker : "";
        choice_.screens.clear();
        choice_.images.clear();
        if (!screen_.empty()) choice_.screens.push_back(screen_);
        if (!image_.empty()) choice_.images.push_back(image_);
        base_ = scene_.display_file().value_or(display::DisplayFile{});
        check_screens(choice_, base_);
        options_ = fit_options(choice_, base_);
        TouchSource source = source_;
        source.tip = display::parse_vector(choice_.tip, "mm");
        source.tracker = choice_.tracker;
        lead_.emplace(calibration_steps(choice_), !choice_.tracker.empty(),
                      [this](std::span<const display::Touch> done) { fit_ = display::fit_display(done, options_); });
        watch_.emplace(std::move(source));
        if (marks_on_ >= 0) marks_ = std::make_unique<MarkScreen>(marks_on_);
    } catch (const Error& error) {
        problem_ = error.what();
        lead_.reset();
        watch_.reset();
    }
}

void CalibrationPanel::lead_on(const Feed& feed) {
    try {
        while (const auto touched = watch_->next(feed)) {
            said_ = lead_->take(*touched);
            if (lead_->is_done()) return finish();
        }
        show_mark();
    } catch (const Error& error) {
        problem_ = error.what();
        lead_.reset();
        watch_.reset();
        marks_.reset();
        return;
    }
    const display::Touch& step = lead_->steps()[lead_->due()];
    words(tone::text, fmt::format("{} of {}: {}", lead_->due() + 1, lead_->steps().size(), prompt_of(step)));
    ImGui::ProgressBar(static_cast<float>(lead_->due()) / static_cast<float>(lead_->steps().size()),
                       ImVec2(-1.0f, 0.4f * ImGui::GetFontSize()), "");
    if (!said_.empty()) words(tone::bad, said_);
    if (watch_->is_reading()) words(tone::good, "hold still");
    else
        words(tone::dim, fmt::format("Hold the tip there and press {}.",
                                     source_.button.empty() ? "Enter" : "the button of the device, or Enter"));
    if (marked_button("touch") ||
        (!ImGui::GetIO().WantTextInput && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false)))
        watch_->ask();
    ImGui::SameLine();
    if (!marked_button("stop")) return;
    lead_.reset();
    watch_.reset();
    marks_.reset();
}

void CalibrationPanel::finish() {
    const std::vector<display::Touch> touches = lead_->steps();
    lead_.reset();
    watch_.reset();
    marks_.reset();
    fit_ = display::fit_display(touches, options_);
    write();
}

void CalibrationPanel::write() {
    problem_.clear();
    is_unwritten_ = true;
    try {
        write_calibrated(file_, calibrated_display(base_, *fit_), *fit_);
        scene_.use_display(file_);
    } catch (const Error& error) {
        problem_ = error.what();
        return;
    }
    is_unwritten_ = false;
    const TouchesOff off = touches_off(*fit_);
    bench_.tell(fmt::format("{} is written and used: {} touches, {:.2f} mm rms, {:.2f} mm worst", file_, off.count,
                            off.rms * 1e3, off.worst * 1e3));
}

/// Keeps the touches when the file cannot be written.
void CalibrationPanel::write_elsewhere() {
    words(tone::text, "All touches are made, but the display file is not written. Choose another file.");
    choose_file();
    ImGui::BeginDisabled(file_.empty());
    if (marked_button("write")) write();
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (marked_button("discard")) {
        is_unwritten_ = false;
        problem_.clear();
        fit_.reset();
    }
}

void CalibrationPanel::show_mark() {
    if (!marks_) return;
    if (marks_->wants_to_close()) marks_.reset();
    else marks_->show(lead_->steps()[lead_->due()]);
}

/// Residuals of the complete parts.
void CalibrationPanel::show_fit() const {
    ImGui::Separator();
    for (const display::TouchedPart& part : fit_->parts) words(tone::text, part_text(part));
    const TouchesOff off = touches_off(*fit_);
    words(tone::dim, fmt::format("all {} touches: {:.2f} mm rms; touch {} is farthest off, {:.2f} mm", off.count,
                                 off.rms * 1e3, off.worst_touch + 1, off.worst * 1e3));
}

}  // namespace tactus::window
