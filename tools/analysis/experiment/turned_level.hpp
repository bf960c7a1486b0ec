// SPDX-License-Identifier: Apache-2.0
// The level of a trial of adjustment while the subject turns it.
#pragma once

#include "assets/experiment/protocol.hpp"
#include "assets/experiment/records.hpp"
#include "engine/run/engine.hpp"
#include "tools/analysis/experiment/port_values.hpp"
#include "tools/analysis/experiment/subject_session.hpp"

#include <optional>
#include <vector>

namespace tactus::analysis {

class TurnedLevel {
public:
    /// `ports` counts the presses of the answering ports. All must outlive this.
    TurnedLevel(const experiment::Protocol& protocol, const TrialSpec& spec, PortCollector& ports);

    /// Turns the level by presses of "more" (positive) or "less", and sets the parameter of the running patch. Levels stay within
    /// their range. Throws Error when the parameter cannot be set.
    void turn(int presses, run::Engine& engine);
    /// An answer by its index: less, more, or matches, which ends the trial.
    void answer(int index, run::Engine& engine);
    /// Answers by the presses of the ports since the last call.
    void answer_by_ports(run::Engine& engine);

    const std::vector<experiment::Turn>& turns() const { return turns_; }
    double level() const;
    /// s, since the trial began; none: no match yet.
    std::optional<double> matched_at() const { return matched_at_; }

private:
    const experiment::Protocol& protocol_;
    const TrialSpec& spec_;
    PortCollector& ports_;
    /// Presses since the beginning: a sum of steps would depend on their order by rounding.
    int presses_ = 0;
    std::vector<experiment::Turn> turns_;
    std::optional<double> matched_at_;
};

}  // namespace tactus::analysis
