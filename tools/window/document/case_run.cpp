// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/case_run.hpp"

#include "assets/plan/plan_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/fit/arrangement/history.hpp"
#include "tools/counted.hpp"
#include "tools/window/document/hand_of_patch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <exception>
#include <utility>

namespace tactus::window {

namespace fs = std::filesystem;

namespace {

// From a step in the run to its version of the plan.
constexpr auto published_within = std::chrono::milliseconds(500), longest_missing = std::chrono::milliseconds(10'000);

const char* const figures[] = {"verdict", "fits", "fragment", "partner", "score", "rms", "gap", "penetration"};

/// The node, and its output, that is wired to an input.
struct Source {
    const compile::ScheduleNode* node = nullptr;
    std::string output;
};
Source source_of(const compile::Schedule& plan, const compile::ScheduleNode& node, const std::string& input) {
    for (const compile::ScheduleWire& wire : plan.wires) {
        if (wire.from_node < 0 || wire.to_input < 0) continue;
        if (&plan.nodes[static_cast<std::size_t>(wire.to_node)] != &node) continue;
        if (node.inputs[static_cast<std::size_t>(wire.to_input)].name != input) continue;
        const compile::ScheduleNode& from = plan.nodes[static_cast<std::size_t>(wire.from_node)];
        return {&from, from.outputs[static_cast<std::size_t>(wire.from_output)].name};
    }
    return {};
}

std::string name_in(const plan::CasePlan& plan, int fragment) {
    return fragment >= 0 && fragment < static_cast<int>(plan.fragments.size())
               ? plan.fragments[static_cast<std::size_t>(fragment)].name
               : std::string();
}

std::string words_of(const plan::CasePlan& plan, const plan::PlanStep& step) {
    std::string names;
    for (const int fragment : step.fragments) names += (names.empty() ? "" : ", ") + name_in(plan, fragment);
    if (step.fit)
        return fmt::format("{} fits {}: {:.2f} mm rms, score {:.2f}", name_in(plan, step.fragments.front()),
                           step.fit->partner, step.fit->rms * 1e3, step.fit->score);
    if (!step.group.empty()) names += fmt::format(" ({})", step.group);
    return fmt::format("{} {}", plan::name_of(step.kind), names);
}

}  // namespace

std::vector<StepLine> step_lines(const plan::CasePlan& plan) {
    std::vector<StepLine> lines;
    const std::vector<int> before = plan.before();
    const fit::HistoryPlace place = plan.place();
    for (const int n : fit::steps_to(before, place.tip))
        lines.push_back(
            {n, words_of(plan, plan.steps[static_cast<std::size_t>(n)]), fit::is_on_way(before, n, place.head)});
    return lines;
}

CaseRun::~CaseRun() {
    // An export that waits behind another study would be dropped.
    if (study_.is_busy() && studied_ == Study::files) try {
            study_.take();
        } catch (const std::exception&) {
            // The window that would show it is closed.
        }
    if (observer_)
        for (const std::string& port : watched_) observer_->watch(port, observe::Watch::nothing, this);
}

void CaseRun::follow_patch() {
    plan_version_ = bench_.plan_version();
    node_.clear();
    matcher_.clear();
    holding_.clear();
    which_.clear();
    hand_buttons_.clear();
    if (!bench_.plan()) return;
    const compile::Schedule& plan = *bench_.plan();
    const auto hand = hand_of(plan);
    is_hand_of_person_ = !hand || !hand->moves_by_itself();
    const auto take_hand = [&](const compile::ScheduleNode& node, const char* input, const char* what) {
        const Source from = source_of(plan, node, input);
        if (!from.node || from.node->type->role != NodeRole::hand_source) return;
        const auto& outputs = from.node->outputs;
        // The buttons follow each other: trigger, second, third, fourth.
        const auto first = std::ranges::find(outputs, "trigger", &compile::ScheduleOutput::name),
                   found = std::ranges::find(outputs, from.output, &compile::ScheduleOutput::name);
        if (first != outputs.end() && found >= first && found - first < 4)
            hand_buttons_[what] = static_cast<std::size_t>(found - first);
    };
    for (const compile::ScheduleNode& node : plan.nodes) {
        if (node.type->name == "case_scene") {
            node_ = node.name;
            for (const AssetParam* asset : node.assets) asset_ = asset->name;
            const auto port_of = [&](const char* input) {
                const Source from = source_of(plan, node, input);
                return from.node ? from.node->name + "." + from.output : std::string();
            };
            holding_ = port_of("holding");
            which_ = port_of("which");
            take_hand(node, "settle", "settle");
            struct : MemberVisitor {
                std::string file;
                void text(std::string_view name, Text& text) override {
                    if (name == "file") file = text.value;
                }
            } texts;
            node.type->visit(node.instance.get(), texts);
            file_name_ = texts.file;
        } else if (node.type->name == "fragment_matcher") {
            matcher_ = node.name;
            take_hand(node, "engaged", "snap");
        } else if (node.type->name == "grasp") take_hand(node, "trigger", "grasp");
    }
}

/// The figures of the fit, and what tells that the plan is about to change.
void CaseRun::watch(const std::shared_ptr<observe::Observer>& observer) {
    if (observer_)
        for (const std::string& port : watched_) observer_->watch(port, observe::Watch::nothing, this);
    watched_.clear();
    observer_ = observer;
    if (!observer_ || !is_there()) return;
    if (!matcher_.empty())
        for (const char* figure : figures) watched_.push_back(matcher_ + "." + figure);
    for (const std::string& port : {holding_, which_, node_ + ".steps", node_ + ".received"})
        if (!port.empty()) watched_.push_back(port);
    for (const std::string& port : watched_) observer_->watch(port, observe::Watch::latest, this);
}

void CaseRun::tend(const std::shared_ptr<observe::Observer>& observer) {
    const bool is_other_patch = plan_version_ != bench_.plan_version(), is_other_run = observer != observer_;
    if (is_other_patch) follow_patch();
    if (is_other_patch || is_other_run) watch(observer);
    if (is_other_run) {
        if (!document_ && plan_ && steps_.size() > steps_at_start_ && !bench_.goes_on())
            bench_.tell(fmt::format("this run begins with the plan of the patch; that of the run before is in {}",
                                    file_.string()));
        commands_.clear();
        plan_.reset();
        of_run_.reset();
        steps_.clear();
        steps_done_ = -1.0;
        held_last_ = -1;
    }
    if (!is_there()) return;
    commands_.tend(node_, std::llround(number(node_ + ".received", 0.0)));
    if (const double held = which_.empty() ? -1.0 : number(which_, -1.0); held >= 0.0)
        held_last_ = static_cast<int>(held);
    look_for_changes();
    follow_plan();
    if (!is_live() && commands_.is_under_way()) do_what_is_left();
    if (study_.is_ready()) {
        has_numbers_ = studied_ == Study::gaps || studied_ == Study::healthy;
        try {
            found_ = study_.take();
        } catch (const std::exception& error) {
            found_ = error.what();
            has_numbers_ = false;
            bench_.tell(found_, true);
        }
    }
    if (has_numbers_ && study_of_ != version_) {
        has_numbers_ = false;
        found_.clear();
    }
}

void CaseRun::look_for_changes() {
    // Also those of the hand's buttons and of commands from elsewhere.
    const double steps = number(node_ + ".steps", -1.0);
    const bool is_step = std::exchange(steps_done_, steps) != steps;
    if (is_step) stepped_ = Clock::now();
    // A slow machine. A command that was lost on its way never comes.
    const auto done = static_cast<double>(std::ranges::count(steps_, true, &StepLine::is_done));
    const bool is_missing = plan_ && steps >= 0.0 && steps != done && Clock::now() - stepped_ < longest_missing;
    if (is_step || is_missing || commands_.is_under_way() || commands_.is_paused() || is_holding())
        unsettled_ = Clock::now();
}

bool CaseRun::is_holding() const {
    if (!is_live() || !is_hand_of_person_) return false;
    return holding_.empty() ? !which_.empty() && number(which_, -1.0) >= 0.0 : flag(holding_);
}

bool CaseRun::may_begin_again() {
    if (is_holding()) {
        bench_.tell(
            "let the fragment go first: the run begins again with this change, and where it is held is no step yet",
            true);
        return false;
    }
    commands_.tell_pause();
    return true;
}

void CaseRun::follow_plan() {
    const std::shared_ptr<const RunStatus> status = bench_.status();
    file_ = !status->folder.empty() && !file_name_.empty() ? status->folder / file_name_
            : document_                                    ? document_->file()
                                                           : fs::path();
    if (status->plan && status->plan != of_run_) {
        const bool is_first = !of_run_;
        of_run_ = status->plan;
        if (is_first) steps_at_start_ = step_lines(*of_run_).size();
        if (document_) try {
                document_->adopt(of_run_);
            } catch (const Error& error) {
                bench_.tell(error.what(), true);
            }
    }
    const bool shows_run = of_run_ && (is_live() || !document_);
    const auto& newest = shows_run || !document_ ? of_run_ : document_->newest();
    if (newest == plan_) return;
    plan_ = newest;
    ++version_;
    steps_ = plan_ ? step_lines(*plan_) : std::vector<StepLine>();
}

fs::path CaseRun::folder_of_results() const {
    if (document_ && !document_->needs_name()) return document_->folder();
    const fs::path& folder = bench_.status()->folder;
    std::error_code none;
    return folder.empty() ? fs::current_path(none) : folder;
}

void CaseRun::change_document(const plan::PlanCommand& command) {
    using Outcome = plan::PlanHistory::Outcome;
    try {
        // Kept from command to command: it can bring dropped alternatives back.
        if (!changed_ || changed_of_ != document_->newest()) changed_.emplace(document_->plan());
        const Outcome outcome = changed_->apply(command, {.time = plan::time_of_day()});
        if (outcome != Outcome::done) return bench_.tell(std::string(plan::text_of(outcome)), true);
        document_->adopt(std::make_shared<const plan::CasePlan>(changed_->plan()));
        changed_of_ = document_->newest();
    } catch (const Error& error) {
        bench_.tell(error.what(), true);
    }
}

/// The run has ended before it did all that it was asked for, as in a pause.
void CaseRun::do_what_is_left() {
    const std::deque<plan::PlanCommand> left = commands_.take_left();
    if (document_)
        for (const plan::PlanCommand& command : left) change_document(command);
    else bench_.tell(fmt::format("{} not done: the run has ended", counted(left.size(), "step")), true);
}

bool CaseRun::brings_what_waits() {
    if (!document_ || !commands_.is_under_way()) return false;
    if (is_live() && commands_.is_paused()) bench_.stop();
    return true;
}

void CaseRun::take_what_waits() {
    if (document_ && commands_.is_under_way()) do_what_is_left();
}

void CaseRun::give(const plan::PlanCommand& command) {
    if (changes_document()) change_document(command);
    else if (is_live()) commands_.add(command);
}

void CaseRun::toggle_lock(const std::vector<int>& fragments) {
    if (!plan_) return;
    const fit::Arrangement now = plan::state_of(*plan_).arrangement;
    const bool are_locked = std::ranges::all_of(fragments, [&](int n) { return now.is_locked(n); });
    give(plan::LockFragments{plan::set_of(fragments), !are_locked});
}

void CaseRun::show_hidden() {
    if (!plan_) return;
    const fit::Arrangement now = plan::state_of(*plan_).arrangement;
    plan::FragmentSet hidden;
    for (int n = 0; n < static_cast<int>(now.size()); ++n) hidden[static_cast<std::size_t>(n)] = now.is_hidden(n);
    if (hidden.none()) return bench_.tell("the plan hides no fragment", true);
    give(plan::HideFragments{hidden, false});
}

bool CaseRun::is_live() const { return is_there() && bench_.status()->state != RunStatus::State::over; }

bool CaseRun::is_settled() const {
    if (bench_.status()->state == RunStatus::State::over) return true;
    return !commands_.is_under_way() && Clock::now() - unsettled_ > published_within;
}

std::optional<std::size_t> CaseRun::hand_button(const std::string& what) const {
    const auto found = hand_buttons_.find(what);
    return found == hand_buttons_.end() ? std::nullopt : std::optional(found->second);
}

double CaseRun::number(const std::string& port, double otherwise) const {
    const auto seen = observer_ ? observer_->latest<double>(port) : std::nullopt;
    return seen && std::isfinite(seen->value) ? seen->value : otherwise;
}

bool CaseRun::flag(const std::string& port) const {
    const auto seen = observer_ ? observer_->latest<bool>(port) : std::nullopt;
    return seen && seen->value;
}

std::optional<CaseRun::Fit> CaseRun::fit() const {
    if (matcher_.empty() || !observer_) return std::nullopt;
    const auto of = [&](const char* figure) { return matcher_ + "." + figure; };
    const auto place = [&](const char* figure) { return static_cast<int>(std::lround(number(of(figure), -1.0))); };
    return Fit{
        place("fragment"),        place("partner"),       place("verdict"),       flag(of("fits")),
        number(of("score"), 0.0), number(of("rms"), 0.0), number(of("gap"), 0.0), number(of("penetration"), 0.0)};
}

}  // namespace tactus::window
