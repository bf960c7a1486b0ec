// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/experiment/subject_session.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/statistics/orders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace tactus::analysis {

using experiment::Method;
using experiment::Phase;
using experiment::Protocol;
using experiment::ResponseKind;
using experiment::Stimulus;
using experiment::TrialRecord;

psychophysics::QuestSettings quest_settings(const Protocol& protocol) {
    const Stimulus& stimulus = *protocol.stimulus;
    const double low = stimulus.axis(stimulus.min), high = stimulus.axis(stimulus.max);
    psychophysics::QuestSettings settings;
    settings.form = protocol.method.form;
    settings.slopes = protocol.method.slopes;
    settings.lapses = {protocol.method.lapse};
    // The false alarms of yes/no tasks are not known beforehand; the fit of the analysis estimates them.
    settings.target = protocol.method.target;
    settings.guess = protocol.response.kind == ResponseKind::choice ? protocol.response.guess()
                                                                    : std::min(0.1, 0.5 * settings.target);
    const auto grid = [&](double step) {
        const int count = std::max(2, 1 + static_cast<int>(std::ceil((high - low) / step - 1e-9)));
        std::vector<double> values;
        for (int i = 0; i < count; ++i) values.push_back(low + (high - low) * i / (count - 1));
        return values;
    };
    // log10 of 1.02 and of 1.05, at most 500 and 100 values.
    const double span = high - low;
    settings.thresholds = grid(stimulus.is_log ? std::max(0.0086, span / 500.0) : span / 150.0);
    settings.levels = grid(stimulus.is_log ? std::max(0.0212, span / 100.0) : span / 60.0);
    return settings;
}

SubjectSession::SubjectSession(const Protocol& protocol, std::size_t row, const std::vector<TrialRecord>& done)
    : protocol_(protocol), row_(row) {
    const std::vector<std::size_t> conditions = experiment::condition_order(protocol, row);
    if (protocol.is_psychophysics()) {
        for (const std::size_t condition : conditions) blocks_.push_back({condition, 0, blocks_.empty()});
    } else {
        const std::vector<std::size_t> tasks = experiment::task_order(protocol, row);
        for (std::size_t period = 0; period < conditions.size(); ++period)
            for (const std::size_t task : tasks) blocks_.push_back({conditions[period], task, period == 0});
    }
    if (!blocks_.empty()) begin_block();
    for (const TrialRecord& trial : done) {
        const std::optional<TrialSpec> spec = next();
        const std::string task = !spec || protocol.is_psychophysics() ? std::string() : protocol.tasks[spec->task].name;
        if (!spec || spec->phase != trial.phase || task != trial.task ||
            protocol.conditions[spec->condition].name != trial.condition || spec->interval != trial.interval ||
            (protocol.is_psychophysics() && spec->level != trial.level))
            throw Error(
                fmt::format("trial {} is not the one that the protocol prescribes there: the data belong to "
                            "another protocol or version of the program",
                            trial.number));
        add(trial);
    }
}

void SubjectSession::begin_block() {
    state_ = {};
    if (!protocol_.is_psychophysics()) return;
    const Method& method = protocol_.method;
    switch (method.kind) {
        case Method::Kind::staircase: state_.rule = psychophysics::Staircase(method.rule); break;
        case Method::Kind::quest_plus: state_.rule = psychophysics::QuestPlus(quest_settings(protocol_)); break;
        case Method::Kind::constant:
        case Method::Kind::adjustment: {
            const bool is_constant = method.kind == Method::Kind::constant;
            const auto count = static_cast<std::size_t>(method.trials);
            Listed listed;
            for (const std::size_t index :
                 statistics::block_random(is_constant ? method.levels.size() : 2, is_constant ? count : count / 2,
                                          mix(protocol_.seed + 1) ^ mix(row_ * 1000 + block_)))
                listed.levels.push_back(is_constant ? method.levels[index]
                                                    : start_of_adjustment(index == 1, listed.levels.size()));
            state_.rule = std::move(listed);
            break;
        }
    }
}

double SubjectSession::start_of_adjustment(bool is_above, std::uint64_t trial) const {
    const Stimulus& stimulus = *protocol_.stimulus;
    const double low = stimulus.axis(stimulus.min), high = stimulus.axis(stimulus.max);
    const double inward = random(3 * trial + 2) * protocol_.method.starts * (high - low);
    return stimulus.presentable(
        std::clamp(stimulus.level_at(is_above ? high - inward : low + inward), stimulus.min, stimulus.max));
}

double SubjectSession::random(std::uint64_t index) const {
    return Random{mix(protocol_.seed) ^ mix(row_ * 1000 + block_ + 1)}.uniform(index);
}

int SubjectSession::interval_of(std::uint64_t index) const {
    const double u = random(3 * index);
    switch (protocol_.response.kind) {
        case ResponseKind::choice:
        case ResponseKind::adjust: return 1 + static_cast<int>(u * protocol_.response.intervals);
        case ResponseKind::yes_no: return u < 0.5 ? 1 : 0;
        case ResponseKind::same_different: return u < 0.5 ? 0 : u < 0.75 ? 1 : 2;
    }
    return 0;
}

bool SubjectSession::is_rule_done() const {
    const Method& method = protocol_.method;
    if (const auto* stairs = std::get_if<psychophysics::Staircase>(&state_.rule))
        return stairs->is_done() || state_.main >= method.trials;
    if (const auto* listed = std::get_if<Listed>(&state_.rule))
        return static_cast<std::size_t>(state_.main) >= listed->levels.size();
    return state_.main >= method.trials;
}

double SubjectSession::rule_level() const {
    const Stimulus& stimulus = *protocol_.stimulus;
    if (const auto* stairs = std::get_if<psychophysics::Staircase>(&state_.rule))
        return stimulus.presentable(stimulus.level_at(stairs->level()));
    if (const auto* listed = std::get_if<Listed>(&state_.rule))
        return listed->levels[static_cast<std::size_t>(state_.main)];
    return stimulus.presentable(stimulus.level_at(std::get<psychophysics::QuestPlus>(state_.rule).level()));
}

std::optional<TrialSpec> SubjectSession::next_in_block() const {
    const Block& block = blocks_[block_];
    TrialSpec spec{number_ + 1, static_cast<int>(block_), Phase::main, block.condition, block.task, 0.0, 0, false};
    spec.begins_block = state_.practised == 0 && state_.presented == 0;
    const bool needs_practice = block.has_practice && state_.in_a_row < protocol_.practice.needed &&
                                state_.practised < protocol_.practice.max_trials;
    if (!protocol_.is_psychophysics()) {
        if (needs_practice) {
            spec.phase = Phase::practice;
            return spec;
        }
        if (state_.presented < protocol_.tasks[block.task].repetitions) return spec;
        return std::nullopt;
    }
    if (needs_practice) {
        spec.phase = Phase::practice;
        spec.level = protocol_.stimulus->max;
        spec.interval = interval_of(static_cast<std::uint64_t>(1'000'000 + state_.practised));
        return spec;
    }
    if (!is_rule_done()) {
        const auto index = static_cast<std::uint64_t>(state_.presented);
        spec.interval = interval_of(index);
        const bool is_catch = random(3 * index + 1) < protocol_.catch_rate;
        spec.phase = is_catch ? Phase::catch_trial : Phase::main;
        spec.level = is_catch ? protocol_.stimulus->max : rule_level();
        return spec;
    }
    if (state_.repeated < state_.to_repeat.size()) {
        spec.phase = Phase::repeat;
        std::tie(spec.level, spec.interval) = state_.to_repeat[state_.repeated];
        return spec;
    }
    return std::nullopt;
}

std::optional<TrialSpec> SubjectSession::next() const {
    return block_ < blocks_.size() ? next_in_block() : std::nullopt;
}

void SubjectSession::update_rule(const TrialRecord& trial) {
    // Without stimulus an answer says nothing about the level.
    if (trial.interval == 0) return;
    const double axis = protocol_.stimulus->axis(trial.level);
    if (auto* stairs = std::get_if<psychophysics::Staircase>(&state_.rule)) stairs->answer(trial.is_correct);
    if (auto* quest = std::get_if<psychophysics::QuestPlus>(&state_.rule)) quest->answer(axis, trial.is_correct);
}

void SubjectSession::add(const TrialRecord& trial) {
    ++number_;
    ++since_break_;
    const bool is_marked = !trial.marked.empty();
    switch (trial.phase) {
        case Phase::practice:
            ++state_.practised;
            state_.in_a_row =
                (protocol_.is_psychophysics() ? trial.is_correct : trial.is_finished) ? state_.in_a_row + 1 : 0;
            break;
        case Phase::catch_trial: ++state_.presented; break;
        case Phase::main:
            ++state_.presented;
            ++state_.main;
            if (!protocol_.is_psychophysics()) break;
            if (is_marked) state_.to_repeat.emplace_back(trial.level, trial.interval);
            else update_rule(trial);
            break;
        case Phase::repeat:
            ++state_.repeated;
            if (!is_marked) update_rule(trial);
            break;
    }
    while (block_ < blocks_.size() && !next_in_block()) {
        ++block_;
        if (block_ < blocks_.size()) begin_block();
    }
    if (protocol_.break_every > 0 && since_break_ > protocol_.break_every) since_break_ = 1;
}

bool SubjectSession::is_break_due() const { return protocol_.break_every > 0 && since_break_ == protocol_.break_every; }

}  // namespace tactus::analysis
