// SPDX-License-Identifier: Apache-2.0
#include "assets/file/utc_text.hpp"

#include <fmt/format.h>

#include <ctime>

namespace tactus::file {

std::string utc_text(std::chrono::system_clock::time_point time, bool has_milliseconds) {
    using namespace std::chrono;
    const auto second = floor<seconds>(time);
    const std::time_t whole = system_clock::to_time_t(second);
    std::tm parts{};
    ::gmtime_r(&whole, &parts);
    const std::string fraction =
        has_milliseconds ? fmt::format(".{:03}", duration_cast<milliseconds>(time - second).count()) : std::string();
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}{}Z", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday,
                       parts.tm_hour, parts.tm_min, parts.tm_sec, fraction);
}

}  // namespace tactus::file
