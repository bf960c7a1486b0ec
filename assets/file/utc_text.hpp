// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

namespace tactus::file {

/// A time in UTC (ISO 8601): "2026-03-01T12:34:56Z", or with milliseconds "2026-03-01T12:34:56.789Z".
std::string utc_text(std::chrono::system_clock::time_point time, bool has_milliseconds = false);

}  // namespace tactus::file
