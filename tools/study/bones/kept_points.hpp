// SPDX-License-Identifier: Apache-2.0
// Surface points that took long to make, kept beside the kept results (kept_result.hpp).
//
// The file names its key and has a checksum. At most 32 are kept: a new one takes the place of the oldest.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "tools/study/bones/kept_result.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tactus::study {

/// Points of this key to the bit, or those that `make` returns, which are then kept. `note` gets a sentence when a
/// file is there and is no use.
std::vector<contact::SurfacePoint> points_of_key(const ResultKey& key, std::string& note,
                                                 const std::function<std::vector<contact::SurfacePoint>()>& make);

/// The surface of a fragment with its paint: the points in a bone file, else sampled as they are for fits.
/// Throws Error.
std::vector<contact::SurfacePoint> points_of_fragment(const std::filesystem::path& path, std::string& note);

/// The file that keeps points; empty without a folder or a key.
std::filesystem::path file_of_points(const ResultKey& key);

}  // namespace tactus::study
