// SPDX-License-Identifier: Apache-2.0
// A picture of a vessel pulled straight.
#pragma once

#include "dsp/vessel/straightened.hpp"

#include <filesystem>

namespace tactus::report {

/// Two cuts through the centre line, one below the other, the start of the branch at the left; the edge at the tracked
/// radius as lines, orange where contrast was lost. Black to white: from half the contrast below the background to half
/// of it above the vessel. A column of `cuts` is a pixel, or up to six of a short vessel; long vessels continue in further rows of at most 1600 columns.
/// Throws Error when the file cannot be written.
void write_picture(const vessel::Straightened& cuts, double background, double contrast,
                   const std::filesystem::path& path);

}  // namespace tactus::report
