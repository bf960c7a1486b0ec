// SPDX-License-Identifier: Apache-2.0
// Subjects with known parameters: answers to rendered stimuli, and movements of a hand.
#pragma once

#include "assets/experiment/observer_model.hpp"
#include "assets/experiment/protocol.hpp"
#include "tools/analysis/experiment/subject_session.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace tactus::analysis {

struct SimulatedAnswer {
    int answer = 0;
    double response_time = 0.0;  ///< s
};

class SimulatedSubject {
public:
    /// `pseudonym` chooses the subject: the same one is the same person. Throws Error when the model lacks what the protocol needs,
    /// or names conditions or factors that it does not have.
    SimulatedSubject(const experiment::ObserverModel& model, const experiment::Protocol& protocol,
                     const std::string& pseudonym);

    /// Answers by the level that was rendered, not by the one that was asked for. None, no level: as if there were no stimulus.
    SimulatedAnswer answer(const TrialSpec& spec, std::optional<double> rendered_level) const;
    /// Presses by which the subject turns an adjusted level after a presentation; 0: it matches. None, no level: nothing was
    /// noticed, and the subject turns it up.
    int presses(const TrialSpec& spec, std::optional<double> rendered_level) const;
    /// Threshold of this subject, level.
    double threshold(std::size_t condition) const;

    /// Text of a file of targets for the scripted hand: the ideal movement of the task with this subject's errors. Throws Error when
    /// the ideal file cannot be read.
    std::string hand_targets(const TrialSpec& spec) const;

private:
    const experiment::ObserverModel& model_;
    const experiment::Protocol& protocol_;
    std::uint64_t seed_;
};

}  // namespace tactus::analysis
