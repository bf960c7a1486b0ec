// SPDX-License-Identifier: Apache-2.0
// Task files: the task of a trainee on a bone, in TOML. The format is described in docs/reference/task-file.md.
#pragma once

#include "assets/bone/bone.hpp"
#include "dsp/saw/guide_slot.hpp"
#include "dsp/training/planned_cut.hpp"
#include "dsp/training/spared.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::training {

/// Value of the key `format`.
inline constexpr int task_format = 1;

/// A structure that must not be cut: a label of a label map.
struct SparedFile {
    std::string name;
    std::filesystem::path file;
    int label = 1;
    double margin = 0.0;  ///< m; a smaller distance is a warning
    int line = 0;         ///< in the task file
};

/// Limits that an attempt should not exceed. Empty: no limit.
struct TaskLimits {
    std::optional<double> force;  ///< N, on the hand
    std::optional<double> time;   ///< s, from the first touch of the bone to the last
    std::optional<double> heat;   ///< s above the temperature that harms bone
};

/// A cutting guide that is seated on the bone and holds the blade in its slots.
struct GuideFile {
    std::filesystem::path bone;  ///< absolute: the guide as a bone file, where it is seated
    Vec3 removal{0.0, 0.0, 1.0};  ///< unit: it is put on against this direction
    int line = 0;                 ///< in the task file
};

struct TaskFile {
    std::filesystem::path file;  ///< source file, absolute
    std::string title, about;
    std::filesystem::path bone;         ///< absolute; may end in "#NAME", as assets of a patch
    std::string patch;                  ///< a path, or a name in the library; empty: the default one
    std::vector<std::string> settings;  ///< NODE.PARAM=VALUE, for that patch
    double length = 60.0;               ///< s: maximum duration of an attempt
    BladeSize blade;
    std::vector<PlannedCut> cuts{1};  ///< at least one
    std::optional<GuideFile> guide;
    std::vector<saw::GuideSlot> slots;  ///< of the guide
    std::vector<SparedFile> spare;
    TaskLimits limits;
};

/// Reads and checks a task file; bone and label maps are not opened. Throws Error with file:line:column.
TaskFile load_task_file(const std::filesystem::path& path);

/// A task with its spared structures and its guide in memory; the bone is not loaded.
struct Task : TaskFile {
    std::vector<SparedStructure> spared;
    std::shared_ptr<const bone::Bone> guide_body;  ///< null: no guide
    std::uint64_t hash = 0;  ///< of the task file, its label maps and its guide
};
Task load_task(const std::filesystem::path& path);

}  // namespace tactus::training
