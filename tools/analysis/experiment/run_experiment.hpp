// SPDX-License-Identifier: Apache-2.0
// A subject's session of an experiment, trial after trial, resumed where it was cut off.
#pragma once

#include "assets/experiment/observer_model.hpp"
#include "assets/experiment/protocol.hpp"
#include "assets/experiment/records.hpp"
#include "graph/compile/load_assets.hpp"
#include "tools/analysis/experiment/subject_session.hpp"
#include "tools/analysis/experiment/turned_level.hpp"
#include "tools/run/run_choice.hpp"

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tactus::analysis {

struct Answered {
    int answer = 0;              ///< index into the names
    double response_time = 0.0;  ///< s
};

/// A live run of a trial.
struct LiveEnd {
    std::string summary;  ///< as JSON
    std::vector<std::string> losses;
    bool is_ended = false;  ///< the subject ended the session in the trial, which is not kept
};

/// What a subject or an experimenter does. All but `say` may be null for simulated subjects.
struct ExperimentHooks {
    std::function<void(const std::string&)> say;       ///< to the experimenter or the subject
    /// Shows a text and waits for `key`, or for any key when it is 0. False: end the session.
    std::function<bool(const std::string&, char key)> confirm;
    std::function<std::optional<Answered>(const experiment::Protocol&)> ask;  ///< none: end the session
    std::function<void(const TrialSpec&, int done, int blocks)> progress;
    /// Runs a patch live, until its end or until `over`, which a task sets that is done, and a user who ends the session.
    /// `turned`: the level that the subject adjusts; null: none.
    std::function<LiveEnd(const run::RunChoice&, const experiment::Condition&, std::atomic<bool>& over,
                          TurnedLevel* turned)>
        perform;
};

struct ExperimentChoice {
    experiment::Protocol protocol;
    std::filesystem::path out;
    std::string subject;
    std::optional<experiment::ObserverModel> model;  ///< simulated; none: a person
    std::vector<std::string> settings, assets;  ///< of the command line, for all trials
    std::optional<double> registration;  ///< m, as measured for this session
    bool keeps_takes = true;  ///< false: the takes of trials are deleted once they are measured
};

struct ExperimentEnd {
    experiment::SubjectEntry subject;
    int trials = 0, marked = 0, resumed = 0;
    bool is_complete = false;
    std::vector<std::string> losses;
    std::string protocol_hash;
};

/// The overrides and length of a trial's patch. Level and interval become parameters.
run::RunChoice trial_choice(const experiment::Protocol& protocol, const TrialSpec& spec);

/// NODE.limit=VALUE for each audio output whose loudest sample the protocol limits. Throws Error for an output that the patch does
/// not have, for a limit that a wire or the stimulus drives, and for one in the unit of the signal where they drive the full scale.
std::vector<std::string> sound_settings(const experiment::Protocol& protocol, const compile::Schedule& plan);

/// Renders the least and the greatest level of each condition with the patch's simulated hand and measures them. Throws Error with
/// both numbers when a rendered level misses the wanted one by more than the tolerance, or is beyond the limits: then the
/// experiment cannot present its levels.
void check_levels(const experiment::Protocol& protocol, compile::AssetCache& assets,
                  const std::vector<std::string>& settings, const std::function<void(const std::string&)>& say);

/// Compiles the patch of each task in each condition, so that an error of the last one ends no session halfway. Where the protocol
/// limits the sound, also renders the ideal movement, and refuses a patch that plays louder. Throws Error.
void check_tasks(const experiment::Protocol& protocol, compile::AssetCache& assets,
                 const std::vector<std::string>& settings);

/// Throws Error. Whatever ends the program, only the trial that is running is lost.
ExperimentEnd run_experiment(const ExperimentChoice& choice, const ExperimentHooks& hooks,
                             const std::atomic<bool>& stop);

}  // namespace tactus::analysis
