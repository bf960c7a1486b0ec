// SPDX-License-Identifier: Apache-2.0
// Scores of an attempt at a task, from the results of its run. What each measure is: docs/reference/scores.md. None of
// them is validated.
#pragma once

#include "assets/bone/bone.hpp"
#include "assets/training/task_file.hpp"
#include "dsp/training/motion.hpp"
#include "dsp/training/removed.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::study {

struct SparedScore {
    std::string name;
    double injured_mm3 = 0.0;
    double closest_mm = 0.0;  ///< 0 when it was injured
};

/// Below this share of shown force an attempt is not comparable: it was cut in part without feeling the bone.
inline constexpr double complete_share = 0.99;

/// Empty values: the run does not say, or there is no such thing (a plane of a bone that was not cut).
struct Score {
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
};

/// An attempt with what its scores were computed from, for pictures.
struct ScoredRun {
    std::string name;  ///< the run, as the user gave it
    std::string trainee;  ///< of a session; empty: not known
    training::Task task;
    Score score;
    bone::Bone before, after;
    std::optional<training::CutPlane> plane;
    training::Severance severance;
    std::vector<training::AttemptSample> samples;
    double removed_mm3 = 0.0, max_N = 0.0;
};

/// The attempts in a folder: of a session all that were completed, in order; of everything else the folder itself.
/// Throws Error for a folder of a session in which none was completed.
std::vector<std::filesystem::path> attempts_in(const std::filesystem::path& folder);

/// Scores the results of a run, a take (it is repeated first), or an attempt of a session. `task` in place of the task
/// that the run names; empty: that. Throws Error when the run has no record of a task, did not come to its end, was at
/// another bone, or when its task has changed since.
ScoredRun score_run(const std::filesystem::path& folder, const std::filesystem::path& task = {});

}  // namespace tactus::study
