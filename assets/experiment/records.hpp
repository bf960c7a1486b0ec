// SPDX-License-Identifier: Apache-2.0
// Files of the data of an experiment: subjects with their rows of the order, and the trials of each.
//
//   DIR/experiment.json               hash of the protocol, subjects; replaced as a whole
//   DIR/frozen/                       protocol and patches as the first subject met them
//   DIR/sub-P01/trials.jsonl          one line for each trial that came to its end; replaced as a whole, synced
//   DIR/sub-P01/trial-0001/           results and take of a trial
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tactus::experiment {

inline constexpr int data_format = 1;

enum class Phase : std::uint8_t { practice, main, catch_trial, repeat };

/// A level that a subject has set in an adjustment.
struct Turn {
    double time = 0.0;  ///< s, since the trial began: from when on it was rendered
    double level = 0.0;
};

/// One trial that came to its end.
struct TrialRecord {
    int number = 0;   ///< from 1, in the order of presentation
    int block = 0;    ///< from 0
    Phase phase = Phase::main;
    std::string condition, task;
    double seconds = 0.0;      ///< rendered
    std::string folder;        ///< within the subject's
    std::string output_hash;
    // Psychophysics.
    double level = 0.0;        ///< wanted; of an adjustment that at which it began
    int interval = 0;          ///< with the stimulus, from 1; 0: none
    std::vector<double> rendered;       ///< measure of each interval: what was commanded after all limits
    std::optional<double> rendered_level;  ///< of the interval with the stimulus
    int answer = -1;           ///< index into the names of the answers
    bool is_correct = false;
    std::optional<double> response_time;  ///< s, from the end of the last interval; of an adjustment from its beginning
    std::vector<Turn> turns;  ///< of an adjustment
    std::optional<double> match;  ///< level at which the subject ended an adjustment
    // Tasks.
    std::map<std::string, double> measures;
    bool is_finished = true;  ///< the task was done before its time was over
    // What may spoil a trial.
    double missed = 0.0, gap = 0.0, limited = 0.0;
    double sound_limited = 0.0;  ///< of the samples of the audio output that was limited most, a fraction
    std::string marked;  ///< why the trial is beyond the limits; empty: it is not
    bool is_simulated = false, is_rehearsal = false;
};

struct SubjectEntry {
    std::string pseudonym;
    std::size_t row = 0;  ///< of the order
    bool is_simulated = false;
    std::string consent;  ///< time at which consent was recorded; empty: none
    bool is_complete = false;
    std::string registration;  ///< note on the registration of the display
    /// What the command line set for all trials of this subject: "hand.device=touch", "asset hand=file". None: it was not stored.
    std::optional<std::vector<std::string>> settings;
};

struct FrozenFile {
    std::string name;  ///< relative to the protocol
    std::string hash;
};

struct ExperimentFile {
    std::string name;
    std::string protocol;  ///< path as it was run first
    std::vector<FrozenFile> files;  ///< copied into the folder
    std::vector<FrozenFile> assets;  ///< bones, sounds and others that the patches load: hashed, too large to be copied
    std::vector<SubjectEntry> subjects;
    std::vector<std::size_t> freed_rows;  ///< of subjects who withdrew; the next ones inherit them
};

/// Throws Error when a file is damaged or of another format.
ExperimentFile load_experiment_file(const std::filesystem::path& path);
/// Replaces the file as a whole, synced to disk. Throws Error.
void save_experiment_file(const ExperimentFile& experiment, const std::filesystem::path& path);

/// None when there is no file. Throws Error when a line is damaged.
std::vector<TrialRecord> load_trials(const std::filesystem::path& path);
void save_trials(const std::vector<TrialRecord>& trials, const std::filesystem::path& path);

const char* name_of(Phase phase);

}  // namespace tactus::experiment
