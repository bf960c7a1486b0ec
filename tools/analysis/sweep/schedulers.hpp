// SPDX-License-Identifier: Apache-2.0
// Sweeps on engines that exist: Slurm's job arrays, and make. Both call 'tactus sweep work' with a share.
#pragma once

#include "tools/analysis/sweep/sweep_folder.hpp"

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tactus::analysis {

struct SlurmJob {
    std::size_t points_per_element = 0;  ///< 0: as many as the largest array needs, at least 10
    int jobs = 1;                        ///< processors of an element
    std::vector<std::string> options;    ///< further ones of sbatch
    std::filesystem::path program;
};

struct SubmittedJob {
    std::string id;             ///< of Slurm
    std::size_t elements = 0;   ///< submitted
    std::size_t shares = 0;     ///< of the division of all points
};

/// Submits one array job for the shares that have unfinished points; each element is requeued when its node fails or is
/// preempted, and then runs what is left of its share. Nothing is submitted, and the id is empty, when all are finished.
/// Throws Error with sbatch's message.
SubmittedJob submit_to_slurm(const SweepFolder& folder, const SlurmJob& job);

/// Number of elements that are pending or running; 0 when the job has left the queue. Throws Error.
std::size_t elements_in_slurm(const std::string& id);

/// Writes DIR/Makefile, with one target per share; 'make -j' or any scheduler that reads makefiles runs it, and
/// 'make share-7' runs one. Returns the number of targets.
std::size_t write_makefile(const SweepFolder& folder, std::size_t points_per_target, int jobs,
                           const std::filesystem::path& program);

}  // namespace tactus::analysis
