// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/stretch.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/readable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::sound {

namespace {

std::string seconds(double value) { return plain(value, 6) + " s"; }

}  // namespace

std::string ReadStretch::text() const { return fmt::format("{} to {} of {}", seconds(from), seconds(to), seconds(of)); }

ReadStretch stretch_within(const Stretch& stretch, double length, double rate, const std::filesystem::path& file) {
    const double tolerance = 0.5 / rate;
    if (!(stretch.from >= 0.0) || stretch.from >= length - tolerance)
        throw Error(fmt::format("{}: is {} long; a stretch from {} on lies outside of it", file.string(),
                                seconds(length), seconds(stretch.from)));
    if (std::isfinite(stretch.to) && stretch.to > length + tolerance)
        throw Error(fmt::format("{}: is {} long; a stretch to {} does not fit in it", file.string(), seconds(length),
                                seconds(stretch.to)));
    if (!(stretch.to > stretch.from))
        throw Error(fmt::format("{}: a stretch from {} must end after that, not at {} (the record is {} long)",
                                file.string(), seconds(stretch.from), seconds(stretch.to), seconds(length)));
    return {stretch.from, std::min(stretch.to, length), length};
}

}  // namespace tactus::sound
