// SPDX-License-Identifier: Apache-2.0
// Surface points that took long to make, kept in the user's cache beside the kept results (kept_result.hpp).
#pragma once

#include "assets/cases/kept_result.hpp"
#include "dsp/contact/pointshell.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tactus::cases {

/// Points of this key to the bit, or those that `make` returns, which are then kept. `note` gets a sentence when a
/// file is there and is no use.
std::vector<contact::SurfacePoint> points_of_key(const ResultKey& key, std::string& note,
                                                 const std::function<std::vector<contact::SurfacePoint>()>& make);

/// The file that keeps points; empty without a folder or a key.
std::filesystem::path file_of_points(const ResultKey& key);

}  // namespace tactus::cases
