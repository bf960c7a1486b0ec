// SPDX-License-Identifier: Apache-2.0
// Cache of surface points that are slow to compute, beside the cached results (kept_result.hpp).
#pragma once

#include "assets/plan/kept_result.hpp"
#include "dsp/contact/pointshell.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tactus::plan {

/// Returns the cached points of this key, bit by bit, or those that `make` returns, which are then cached. `note`
/// receives a sentence if a cache file exists but is invalid.
std::vector<contact::SurfacePoint> points_of_key(const ResultKey& key, std::string& note,
                                                 const std::function<std::vector<contact::SurfacePoint>()>& make);

/// Returns the cache file of points; empty without a folder or a key.
std::filesystem::path file_of_points(const ResultKey& key);

}  // namespace tactus::plan
