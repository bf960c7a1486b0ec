// SPDX-License-Identifier: Apache-2.0
// The draped skin paddle with the bone below it.
#pragma once

#include "tools/analysis/plan/paddle_study.hpp"

#include <filesystem>

namespace tactus::report {

inline constexpr Vec3 paddle_colour{0.87, 0.62, 0.52};

/// Seen against the defect's normal: bones, paddle and perforators. Written atomically. Throws Error when no
/// picture can be made or written.
void write_paddle_picture(const analysis::FlapStudy& study, const analysis::PaddleStudy& found,
                          const std::filesystem::path& path);

}  // namespace tactus::report
