// SPDX-License-Identifier: Apache-2.0
// Whole-body exposure as text, JSON and CSV.
#pragma once

#include "assets/file/json.hpp"
#include "tools/study/vibration/body_exposure.hpp"

#include <optional>
#include <string>

namespace tactus::command {

std::string body_text(const study::BodyOperation& one);
/// Verdict of a day (health).
std::string body_day_text(const study::BodyDay& day);
file::Json body_json(const study::BodyOperation& one);
file::Json body_day_json(const std::optional<study::BodyDay>& day);
/// A row per axis, with the header first.
std::string body_table_header();
std::string body_table_rows(const study::BodyOperation& one);

}  // namespace tactus::command
