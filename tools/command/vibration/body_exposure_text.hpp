// SPDX-License-Identifier: Apache-2.0
// Whole-body exposure as text, JSON and CSV.
#pragma once

#include "assets/file/json.hpp"
#include "tools/analysis/vibration/body_exposure.hpp"

#include <optional>
#include <string>

namespace tactus::command {

std::string body_text(const analysis::BodyOperation& one);
/// Verdict of a day (health).
std::string body_day_text(const analysis::BodyDay& day);
file::Json body_json(const analysis::BodyOperation& one);
file::Json body_day_json(const std::optional<analysis::BodyDay>& day);
/// A row per axis, with the header first.
std::string body_table_header();
std::string body_table_rows(const analysis::BodyOperation& one);

}  // namespace tactus::command
