// SPDX-License-Identifier: Apache-2.0
#include "assets/file/room.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <charconv>
#include <cmath>
#include <utility>

namespace tactus::file {

namespace {

std::atomic<std::uint64_t> limit{0};  // 0: not set

std::uint64_t half_of_memory() {
    const long pages = ::sysconf(_SC_PHYS_PAGES), page = ::sysconf(_SC_PAGESIZE);
    if (pages <= 0 || page <= 0) return std::uint64_t{2} << 30;
    return static_cast<std::uint64_t>(pages) / 2 * static_cast<std::uint64_t>(page);
}

}  // namespace

std::uint64_t memory_limit() {
    const std::uint64_t set = limit.load(std::memory_order_relaxed);
    return set > 0 ? set : half_of_memory();
}

void set_memory_limit(std::uint64_t bytes) { limit.store(bytes, std::memory_order_relaxed); }

std::uint64_t parse_memory_size(const std::string& text) {
    constexpr std::pair<std::string_view, double> units[] = {{"", 1.0},       {"B", 1.0},      {"kB", 1e3},
                                                             {"MB", 1e6},     {"GB", 1e9},     {"TB", 1e12},
                                                             {"KiB", 0x1p10}, {"MiB", 0x1p20}, {"GiB", 0x1p30}};
    double number = 0.0;
    const char *begin = text.data(), *end = begin + text.size();
    const auto [stop, failure] = std::from_chars(begin, end, number);
    std::string_view unit(stop, static_cast<std::size_t>(end - stop));
    while (!unit.empty() && unit.front() == ' ') unit.remove_prefix(1);
    if (failure == std::errc{} && std::isfinite(number))
        for (const auto& [name, factor] : units)
            // At least 1 MB, and at most 2^62 bytes.
            if (unit == name && number * factor >= 1e6 && number * factor < 0x1p62)
                return static_cast<std::uint64_t>(number * factor);
    throw Error(fmt::format("'{}' is not a size of memory; write it as \"2 GB\" or \"500 MB\", at least 1 MB", text));
}

void require_room(double bytes, const std::filesystem::path& file, std::string_view what) {
    const std::uint64_t most = memory_limit();
    if (bytes <= static_cast<double>(most)) return;
    throw NoRoom(
        fmt::format("{}: {} need {:.0f} MB of memory; the limit for one file is {:.0f} MB; raise it with --memory, or "
                    "use a smaller file",
                    file.string(), what, std::ceil(bytes / 1e6), std::floor(static_cast<double>(most) / 1e6)));
}

void require_possible(double claimed, double most, const std::filesystem::path& file, std::string_view what) {
    if (claimed <= most) return;
    throw Error(fmt::format("{}: damaged or cut short: it claims {:.0f} {}, more than a file of its size can hold",
                            file.string(), claimed, what));
}

}  // namespace tactus::file
