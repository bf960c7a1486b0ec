// SPDX-License-Identifier: Apache-2.0
// Binary form of surface points, for bone files.
#pragma once

#include "dsp/contact/pointshell.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::bone {

/// Layout, little-endian: a mark with the format number, the count (64 bits), then for each point position and normal
/// (3 doubles each), area (double) and label (1 byte).
std::string to_bytes(std::span<const contact::SurfacePoint> points);

/// Reads the bytes of to_bytes back, bit for bit. Throws Error, naming `file`, when the format is newer, the length
/// does not match the count, or a number is not finite.
std::vector<contact::SurfacePoint> points_from(std::string_view bytes, const std::string& file);

}  // namespace tactus::bone
