// SPDX-License-Identifier: Apache-2.0
// Binary form of surface points and of scanned borders, for bone files.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/scanned_border.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::bone {

/// Layout, little-endian: a magic number with the format number, the count (64 bits), then for each point position and
/// normal (3 doubles each), area (double) and label (1 byte).
std::string to_bytes(std::span<const contact::SurfacePoint> points);

/// Reads the bytes of to_bytes back, bit for bit. Throws Error, naming `file`, when the format is newer, the length
/// does not match the count, or a number is not finite.
std::vector<contact::SurfacePoint> points_from(std::string_view bytes, const std::string& file);

/// The same for a scanned border: a magic number with the format number, the count (64 bits), the voxel and the faces
/// (3 doubles each).
std::string border_bytes(const contact::ScannedBorder& border);

/// Throws Error as points_from does, and for a voxel of zero size.
contact::ScannedBorder border_from(std::string_view bytes, const std::string& file);

}  // namespace tactus::bone
