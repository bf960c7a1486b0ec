// SPDX-License-Identifier: Apache-2.0
// Runs finished points again, in fresh processes, and compares their outputs.
#pragma once

#include "tools/analysis/sweep/results.hpp"
#include "tools/analysis/sweep/run_point.hpp"

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace tactus::analysis {

struct Verification {
    std::size_t equal = 0;
    std::size_t not_comparable = 0;  ///< the output differs, and so do build, C library, vector target or processor
    std::vector<std::string> differences;  ///< the output differs though all these are equal, or the point fails
    std::size_t equal_elsewhere = 0;  ///< of `equal`: though build or processor differ
    std::vector<std::string> reasons;  ///< what differs, of those that are not comparable; each once
};

/// Points whose hash, mixed with `seed`, is in the lowest `fraction`; at least one if there is any.
std::vector<std::size_t> sample_points(const Results& results, double fraction, std::uint64_t seed);

/// `mine`: description of this process, see worker_description(). Kept files are hashed and dropped. Throws Error.
Verification verify_points(const Results& results, const std::vector<std::size_t>& points, const file::Json& mine,
                           const std::filesystem::path& program, const std::atomic<bool>& stop,
                           const std::function<void(std::size_t done)>& tell);

}  // namespace tactus::analysis
