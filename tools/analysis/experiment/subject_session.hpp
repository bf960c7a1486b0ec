// SPDX-License-Identifier: Apache-2.0
// Which trial comes next for a subject. A function of the protocol, the subject's row and the trials that came to their end, so
// that a session resumes where it was cut off.
#pragma once

#include "assets/experiment/protocol.hpp"
#include "assets/experiment/records.hpp"
#include "dsp/psychophysics/quest_plus.hpp"
#include "dsp/psychophysics/staircase.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

namespace tactus::analysis {

struct TrialSpec {
    int number = 1, block = 0;
    experiment::Phase phase = experiment::Phase::main;
    std::size_t condition = 0, task = 0;
    double level = 0.0;
    int interval = 0;  ///< with the stimulus, from 1; 0: none
    bool begins_block = false;
};

/// Settings of QUEST+ for a stimulus: grids of at most 2 % steps over the whole range of levels.
psychophysics::QuestSettings quest_settings(const experiment::Protocol& protocol);

class SubjectSession {
public:
    /// Throws Error when the trials do not belong to this protocol.
    SubjectSession(const experiment::Protocol& protocol, std::size_t row,
                   const std::vector<experiment::TrialRecord>& done);

    /// None: the session is complete.
    std::optional<TrialSpec> next() const;
    /// Adds a trial, whose spec was `next()`. A marked trial of psychophysics does not update the rule; it is repeated once at
    /// the end of its block.
    void add(const experiment::TrialRecord& trial);

    int done() const { return number_; }
    int blocks() const { return static_cast<int>(blocks_.size()); }
    /// The pause after so many trials is due before the next one.
    bool is_break_due() const;
    /// Index of this trial's condition and task for messages: the block that `next()` belongs to.
    const experiment::Protocol& protocol() const { return protocol_; }

private:
    struct Block {
        std::size_t condition = 0, task = 0;
        bool has_practice = false;
    };
    /// Levels that do not depend on answers: of constant stimuli, or those at which adjustments begin.
    struct Listed {
        std::vector<double> levels;
    };
    /// What happened in the current block.
    struct State {
        std::variant<Listed, psychophysics::Staircase, psychophysics::QuestPlus> rule;
        int practised = 0, in_a_row = 0;
        int presented = 0;  ///< main and catch trials
        int main = 0;  ///< of them main
        std::vector<std::pair<double, int>> to_repeat;  ///< level and interval
        std::size_t repeated = 0;
    };

    void begin_block();
    std::optional<TrialSpec> next_in_block() const;
    bool is_rule_done() const;
    double rule_level() const;
    double random(std::uint64_t index) const;
    /// Level near an end of the range at which a trial begins.
    double start_of_adjustment(bool is_above, std::uint64_t trial) const;
    int interval_of(std::uint64_t index) const;
    void update_rule(const experiment::TrialRecord& trial);

    const experiment::Protocol& protocol_;
    std::size_t row_;
    std::vector<Block> blocks_;
    std::size_t block_ = 0;
    State state_;
    int number_ = 0, since_break_ = 0;
};

}  // namespace tactus::analysis
