// SPDX-License-Identifier: Apache-2.0
// Scores of an attempt at a task, from the results of its run. docs/reference/scores.md defines the measures. None of
// them is validated.
#pragma once

#include "assets/bone/bone.hpp"
#include "assets/training/task_file.hpp"
#include "assets/training/warnings.hpp"
#include "dsp/training/motion.hpp"
#include "dsp/training/removed.hpp"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::analysis {

struct SparedScore {
    std::string name;
    double injured_mm3 = 0.0;
    double closest_mm = 0.0;  ///< 0 if it was injured
};

/// One cut of a task. Empty: it was not made, or is too small to have a plane.
struct CutScore {
    std::string name;
    std::optional<double> rms_mm, max_mm, angle_deg;
    double over_mm3 = 0.0, under_mm3 = 0.0;
    std::optional<double> breakthrough_mm, breakthrough_mm_per_s;
};

/// Minimum rendered fraction of a comparable attempt: below it, a part of the cut was made without force feedback.
inline constexpr double complete_share = 0.99;

/// Empty values: unknown in the run, or not applicable (a plane of a bone that was not cut). Of several cuts: the rms over
/// the places of all, the greatest of maxima, angles and plunges, the sums of volumes and strokes, the mean jerk.
struct Score {
    std::vector<CutScore> cuts;
    std::optional<double> rms_mm, max_mm, angle_deg;
    double over_mm3 = 0.0, under_mm3 = 0.0;
    std::vector<SparedScore> spared;
    double mean_N = 0.0, over_limit_Ns = 0.0;  ///< of the tool, which `device_scale` divides from that of the hand
    double contact_s = 0.0;  ///< time of contact
    double device_scale = 1.0;  ///< forces on the device over those of the tool
    double limited = 0.0;  ///< fraction of the time of contact in which the device gave less than the tool wanted
    std::optional<double> shown_share;  ///< of the time of contact, in which the hand was given a force
    std::optional<double> jerk, breakthrough_mm, breakthrough_mm_per_s;
    int strokes = 0;
    double seconds = 0.0, path_mm = 0.0;
    std::optional<double> heat_s;
    /// s for which each warning stood live, in the order of training::Warning.
    std::array<double, training::warning_count> warnings_s{};
};

/// An attempt with the data of its scores, for images.
struct ScoredRun {
    std::string name;  ///< the run, as given by the user
    std::string trainee;  ///< of a session; empty: unknown
    training::Task task;
    Score score;
    bone::Bone before, after;
    std::vector<std::optional<training::CutPlane>> planes;  ///< per cut of the task
    std::vector<training::Severance> severances;
    std::vector<training::AttemptSample> samples;
    double removed_mm3 = 0.0, max_N = 0.0;
};

/// Returns the attempts in a folder: for a session all completed ones, in order; otherwise the folder itself. Throws
/// Error for a session without completed attempts.
std::vector<std::filesystem::path> attempts_in(const std::filesystem::path& folder);

/// Scores the results of a run, a take (it is replayed first), or an attempt of a session. `task` replaces the task of
/// the run; empty: that one. Throws Error if the run has no record of a task, did not end normally, or used another
/// bone, or if its task has changed since.
ScoredRun score_run(const std::filesystem::path& folder, const std::filesystem::path& task = {});

}  // namespace tactus::analysis
