// SPDX-License-Identifier: Apache-2.0
// Surface points as bytes, for bone files.
#pragma once

#include "dsp/contact/pointshell.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::bone {

/// A mark with the format's number, the count (64 bits), then position and normal (3 doubles each), area (double) and
/// label (a byte) of each point; little-endian.
std::string to_bytes(std::span<const contact::SurfacePoint> points);

/// What to_bytes wrote, every bit as it was. Throws Error, naming `file`, when the bytes are of a later format, not as
/// many as the count asks for, or not finite.
std::vector<contact::SurfacePoint> points_from(std::string_view bytes, const std::string& file);

}  // namespace tactus::bone
