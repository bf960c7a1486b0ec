// SPDX-License-Identifier: Apache-2.0
// A stretch of a record: the part to analyse.
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>

namespace tactus::sound {

/// Seconds from the start of the record: samples at `from` or later and before `to`.
struct Stretch {
    static constexpr double to_the_end = std::numeric_limits<double>::infinity();

    double from = 0.0, to = to_the_end;

    bool is_whole() const { return from == 0.0 && to == to_the_end; }
};

/// The stretch of a record that was read.
struct ReadStretch {
    double from = 0.0, to = 0.0;  ///< s from the start of the record
    double of = 0.0;              ///< s, length of the whole record

    bool is_whole() const { return from == 0.0 && to == of; }
    std::string text() const;  ///< "1.5 s to 3 s of 5.001 s"
};

/// Returns the stretch within a record of `length` seconds; an excess of up to half a sample is clamped to the end.
/// Throws Error, which states the length, for a stretch that is empty or not within the record.
ReadStretch stretch_within(const Stretch& stretch, double length, double rate, const std::filesystem::path& file);

}  // namespace tactus::sound
