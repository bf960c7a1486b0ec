// SPDX-License-Identifier: Apache-2.0
#include "tools/window/training/train_panel.hpp"

#include "assets/training/warnings.hpp"
#include "dsp/core/error.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

namespace tactus::window {

namespace {

const char* const numbers[] = {"distance", "angle", "depth_left", "clearance", "elapsed"};
/// A word and a large number at the right border; on a line of its own where both do not fit.
void figure(const char* what, const std::string& value, const Fonts& fonts) {
    ImGui::PushFont(fonts.large);
    const float wide = ImGui::CalcTextSize(value.c_str()).x, high = ImGui::GetTextLineHeight();
    ImGui::PopFont();
    const float left = ImGui::GetCursorPosX(), right = left + ImGui::GetContentRegionAvail().x;
    const float top = ImGui::GetCursorPosY();
    const float word = ImGui::CalcTextSize(what).x;
    const bool fits = left + word + wide + ImGui::GetFontSize() <= right;
    if (fits) ImGui::SetCursorPosY(top + 0.5f * (high - ImGui::GetTextLineHeight()));
    ImGui::TextDisabled("%s", what);
    if (fits) ImGui::SetCursorPosY(top);
    ImGui::SetCursorPosX(std::max(left, right - wide));
    ImGui::PushFont(fonts.large);
    ImGui::TextUnformatted(value.c_str());
    ImGui::PopFont();
}

void how_to_move() {
    for (const char* line :
         {"drag: move the hand", "wheel, or drag with Shift: nearer, farther", "right button: turn; with Shift: roll",
          "hold T: the tool runs", "1 to 7: look from another side", "middle button: turn the view"})
        ImGui::TextDisabled("%s", line);
}

}  // namespace

TrainPanel::~TrainPanel() {
    if (observer_)
        for (const std::string& port : watched_) observer_->watch(port, observe::Watch::nothing, this);
}

void TrainPanel::follow(const std::shared_ptr<observe::Observer>& observer) {
    if (observer == observer_ && plan_version_ == bench_.plan_version()) return;
    if (observer_)
        for (const std::string& port : watched_) observer_->watch(port, observe::Watch::nothing, this);
    watched_.clear();
    if (observer != observer_) peak_N_ = 0.0;
    observer_ = observer;
    plan_version_ = bench_.plan_version();
    node_.clear();
    depth_.clear();
    wrench_.clear();
    task_.reset();
    limit_N_ = 0.0;
    if (!bench_.plan() || !observer_) return;
    for (const compile::ScheduleNode& node : bench_.plan()->nodes) {
        if (const auto most = node.params.find("max_force");
            most != node.params.end() && node.type->role == NodeRole::hand_sink)
            max_N_ = most->second->value;
        for (const compile::ScheduleOutput& out : node.outputs)
            if (out.name == "penetration" && depth_.empty()) {
                depth_ = node.name + "." + out.name;
                const auto force = std::ranges::find(node.outputs, "wrench", &compile::ScheduleOutput::name);
                if (force != node.outputs.end()) wrench_ = node.name + ".wrench";
            }
        if (node.type->name != "task") continue;
        node_ = node.name;
        for (const AssetParam* asset : node.assets)
            for (const patch::PatchAsset& entry : bench_.plan()->patch.assets)
                if (entry.name == asset->name) try {
                        task_ = training::load_task_file(entry.path);
                        limit_N_ = task_->limits.force.value_or(0.0);
                    } catch (const Error&) {
                        task_.reset();  // the run says what is wrong
                    }
    }
    const auto watch = [&](std::string port) {
        observer_->watch(port, observe::Watch::latest, this);
        watched_.push_back(std::move(port));
    };
    if (!depth_.empty()) watch(depth_);
    if (!wrench_.empty()) watch(wrench_);
    if (node_.empty()) return;
    for (const char* name : numbers) watch(node_ + "." + name);
    for (const std::string_view warning : training::warning_names) watch(fmt::format("{}.{}", node_, warning));
}

double TrainPanel::number(const std::string& port) const {
    const auto seen = observer_ ? observer_->latest<double>(port) : std::nullopt;
    return seen ? seen->value : std::numeric_limits<double>::quiet_NaN();
}

bool TrainPanel::flag(const std::string& port) const {
    const auto seen = observer_ ? observer_->latest<bool>(port) : std::nullopt;
    return seen && seen->value;
}

std::optional<TrainPanel::FirstCut> TrainPanel::first_cut() const {
    constexpr double begun_s = 1.5, ahead = 8e-3;
    if (!task_ || node_.empty() || bench_.status()->state != RunStatus::State::runs) return std::nullopt;
    if (number(node_ + ".elapsed") > begun_s) return std::nullopt;
    return FirstCut{task_->cuts.front().point, task_->cuts.front().position(0.0, ahead)};
}

void TrainPanel::meter(const Fonts& fonts, double force) const {
    const Point at = point(ImGui::GetCursorScreenPos());
    const double wide = static_cast<double>(ImGui::GetContentRegionAvail().x), high = 44.0 * fonts.scale;
    ImGui::Dummy(vec({wide, high}));
    const Painter paint(ImGui::GetWindowDrawList(), fonts);
    const Box bar{at.x, at.y, at.x + wide, at.y + high};
    const double most = std::max(max_N_, 0.1), share = std::clamp(force / most, 0.0, 1.0);
    const bool is_over = limit_N_ > 0.0 && force > limit_N_;
    paint.box(bar, tone::lane, 4.0);
    paint.box({bar.left, bar.top, bar.left + share * wide, bar.bottom},
              is_over                                    ? tone::bad
              : limit_N_ > 0.0 && force > 0.8 * limit_N_ ? tone::warm
                                                         : tone::good,
              4.0);
    if (limit_N_ > 0.0) {
        // One that the device cannot reach stands at the end.
        const double x = bar.left + std::min(limit_N_ / most * wide, wide - 2.0);
        paint.line({x, bar.top}, {x, bar.bottom}, tone::text, 3.0);
        // Not by colour alone.
        const std::string text = fmt::format("limit {:.0f} N", limit_N_);
        const double size = 12.0 * fonts.scale;
        if (x + 4.0 + paint.width_of(text, size) < bar.right)
            paint.text({x + 4.0, bar.top + 2.0}, size, tone::text, text);
        else paint.text_left_of({x - 4.0, bar.top + 2.0}, size, tone::text, text);
    }
    const double peak = bar.left + std::clamp(peak_N_ / most, 0.0, 1.0) * wide;
    paint.line({peak, bar.top}, {peak, bar.bottom}, tone::dim, 1.0);
    // What the tool has, and what of it the device gives, may differ: by its scale, its limit, or a fault.
    const auto tool = observer_ && !wrench_.empty() ? observer_->latest<Wrench>(wrench_) : std::nullopt;
    if (tool) {
        const double has = glm::length(tool->value.force), thin = 5.0 * fonts.scale;
        paint.box({bar.left, bar.bottom - thin, bar.left + std::clamp(has / most, 0.0, 1.0) * wide, bar.bottom},
                  tone::text, 2.0);
        const std::string text = fmt::format("tool {:.1f} N", has);
        paint.text({bar.left + 8.0 * fonts.scale, bar.bottom - 18.0 * fonts.scale}, 11.0 * fonts.scale, tone::text,
                   text);
    }
    paint.frame(bar, tone::node_edge, 4.0);
    paint.text({bar.left + 8.0 * fonts.scale, bar.top + (tool ? 2.0 : 8.0) * fonts.scale},
               (tool ? 20.0 : 24.0) * fonts.scale, tone::text, fmt::format("{:.1f} N{}", force, is_over ? " !" : ""));
    paint.text_left_of({bar.right - 6.0, bar.bottom - 16.0 * fonts.scale}, 12.0 * fonts.scale, tone::text,
                       fmt::format("{:.0f} N", most));
}

void TrainPanel::figures(const Fonts& fonts) {
    const double elapsed = number(node_ + ".elapsed");
    figure("time", fmt::format("{:.1f} s", std::isfinite(elapsed) ? elapsed : bench_.status()->time), fonts);
    const auto millimetres = [this](const std::string& port) {
        const double metres = number(port);
        return std::isfinite(metres) ? fmt::format("{:.1f} mm", 1e3 * std::abs(metres)) : std::string("-");
    };
    if (!node_.empty()) {
        const double left = number(node_ + ".depth_left");
        figure(left < 0.0 ? "too deep by" : "depth left", millimetres(node_ + ".depth_left"), fonts);
        figure("beside the plan", millimetres(node_ + ".distance"), fonts);
        const double angle = number(node_ + ".angle");
        figure("tilt", std::isfinite(angle) ? fmt::format("{:.0f}°", 57.29577951 * angle) : "-", fonts);
        const double spared = number(node_ + ".clearance");
        if (spared < 0.9)
            figure(spared < 0.0 ? "inside what is spared" : "to what is spared", millimetres(node_ + ".clearance"),
                   fonts);
    } else if (!depth_.empty()) figure("depth", millimetres(depth_), fonts);
    for (std::size_t w = 0; w < training::warning_count; ++w) {
        if (node_.empty() || !flag(fmt::format("{}.{}", node_, training::warning_names[w]))) continue;
        ImGui::PushFont(fonts.bold);
        ImGui::PushStyleColor(ImGuiCol_Text, tone::bad);
        ImGui::TextWrapped("! %s", training::warning_words[w].data());
        ImGui::PopStyleColor();
        ImGui::PopFont();
    }
}

/// Each row with its limit, and what earlier attempts in this window reached.
void TrainPanel::score_table(const Fonts& fonts) const {
    const ScoreCard& card = *score_;
    const ScoreCard* before = nullptr;
    for (const ScoreCard& other : earlier_)
        if (other.task == card.task) before = &other;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(ImGui::GetStyle().ItemSpacing.x, 1.0f));
    std::string never;  // in one line: a low window has no room for each
    for (const ScoreRow& row : card.rows) {
        const bool is_warning = row.name.starts_with('!');
        if (is_warning && !row.is_bad) {
            never += (never.empty() ? "never " : ", ") + row.name.substr(2);
            continue;
        }
        const std::string value = row.note.empty() ? value_beside_limit(row) : row.note;
        const ImU32 ink = row.is_bad ? tone::bad : row.is_close() ? tone::warm : row.limit ? tone::good : tone::text;
        ImGui::TextDisabled("%s", row.name.c_str());
        ImGui::SameLine();
        const float wide = ImGui::CalcTextSize(value.c_str()).x;
        const float right = ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - wide;
        if (right < ImGui::GetCursorPosX()) ImGui::NewLine();
        ImGui::SetCursorPosX(std::max(right, ImGui::GetStyle().WindowPadding.x));
        ImGui::PushStyleColor(ImGuiCol_Text, ink);
        ImGui::TextUnformatted(value.c_str());
        ImGui::PopStyleColor();
        const ScoreRow* const last = before ? before->row(row.name) : nullptr;
        if (!last) continue;
        std::string beside = "  before " + (last->note.empty() ? value_text(*last) : last->note);
        if (const ScoreRow* best = best_of(earlier_, card, row)) beside += ", best " + value_text(*best);
        ImGui::PushFont(fonts.small);
        ImGui::TextDisabled("%s", beside.c_str());
        ImGui::PopFont();
    }
    ImGui::PushFont(fonts.small);
    if (!never.empty()) ImGui::TextWrapped("%s", never.c_str());
    ImGui::PopFont();
    for (const std::string& note : card.notes) ImGui::TextWrapped("%s", note.c_str());
    ImGui::PopStyleVar();
}

/// After the run: the score of an attempt at a task, or what the command would say.
void TrainPanel::result(const Fonts& fonts) {
    ViewedRun* const run = bench_.running();
    if (!run || !run->is_over()) return;
    if (scoring_.valid() && scoring_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
        if (score_ && score_->problem.empty()) earlier_.push_back(std::move(*score_));
        score_ = scoring_.get();
    }
    // Not before the score of an earlier run is there: waiting would stop the window.
    if (scored_run_ != bench_.runs() && !scoring_.valid()) {
        scored_run_ = bench_.runs();
        said_.clear();
        if (const std::string failure = bench_.status()->failure; !failure.empty()) said_ = failure;
        else if (node_.empty()) said_ = run->summary_text();
        else scoring_ = std::async(std::launch::async, score_of, bench_.status()->folder);
    }
    ImGui::Separator();
    ImGui::BeginGroup();
    if (scoring_.valid()) ImGui::TextWrapped("computes the score...");
    else if (!said_.empty()) ImGui::TextWrapped("%s", said_.c_str());
    else if (score_ && !score_->problem.empty()) ImGui::TextWrapped("%s", score_->problem.c_str());
    else if (score_) score_table(fonts);
    ImGui::EndGroup();
    if (!scoring_.valid()) mark_spot("score");
}

void TrainPanel::draw(const std::shared_ptr<observe::Observer>& observer, bool has_mouse, const Fonts& fonts) {
    follow(observer);
    const std::shared_ptr<const RunStatus> status = bench_.status();
    const bool is_over = status->state == RunStatus::State::over;
    const double force = is_over ? 0.0 : status->most;
    peak_N_ = std::max(peak_N_, status->peak);
    ImGui::PushFont(fonts.bold);
    ImGui::TextWrapped("%s", task_ ? task_->title.c_str() : bench_.title().c_str());
    ImGui::PopFont();
    if (task_ && !task_->about.empty()) ImGui::TextWrapped("%s", task_->about.c_str());
    meter(fonts, force);
    // Always at the same place, so that it is found without looking.
    if (ImGui::Button(is_over ? "again" : "end", ImVec2(-1.0f, 1.6f * ImGui::GetFrameHeight()))) {
        if (is_over) bench_.run();
        else bench_.stop();
    }
    mark_spot(is_over ? "again" : "end");
    if (is_over) return result(fonts);
    figures(fonts);
    if (!has_mouse) return;
    ImGui::Separator();
    // A low window keeps its room for the warnings.
    ImGui::TextDisabled("how to move the hand");
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    how_to_move();
    ImGui::EndTooltip();
}

}  // namespace tactus::window
