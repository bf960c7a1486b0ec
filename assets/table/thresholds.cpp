// SPDX-License-Identifier: Apache-2.0
#include "assets/table/thresholds.hpp"

#include "assets/file/toml_file.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace tactus::table {

namespace {

using Member = std::optional<double> Thresholds::*;

const std::array<std::pair<const char*, Member>, 12> members{{
    {"lsd_db", &Thresholds::lsd_db},
    {"harmonic_error_db", &Thresholds::harmonic_error_db},
    {"third_octave_max_db", &Thresholds::third_octave_max_db},
    {"level_gap_db", &Thresholds::level_gap_db},
    {"cosine_40_500", &Thresholds::cosine_40_500},
    {"cosine_40_1000", &Thresholds::cosine_40_1000},
    {"spectrogram_similarity", &Thresholds::spectrogram_similarity},
    {"st_sim", &Thresholds::st_sim},
    {"spqi", &Thresholds::spqi},
    {"coherence_mean", &Thresholds::coherence_mean},
    {"added_line_db", &Thresholds::added_line_db},
    {"missing_line_db", &Thresholds::missing_line_db},
}};

}  // namespace

Thresholds load_thresholds(const std::filesystem::path& path) {
    const auto at = [&](const toml::source_region& source) { return file::toml_place(path.string(), source); };
    const file::TomlTable parsed = file::parse_toml(file::read_whole_file(path), path.string());
    const toml::table& root = *parsed;
    Thresholds out;
    std::vector<std::string> names;
    for (const auto& [name, member] : members) names.emplace_back(name);
    for (const auto& [key, node] : root) {
        bool known = false;
        for (const auto& [name, member] : members) {
            if (key.str() != name) continue;
            known = true;
            if (const toml::value<bool>* judged = node.as_boolean(); judged && !judged->get()) {
                (out.*member).reset();
                continue;
            }
            const auto value = node.is_number() ? node.value<double>() : std::nullopt;
            if (!value || !std::isfinite(*value))
                throw Error(at(node.source()),
                            fmt::format("'{}' must be a number, or false when it is not judged", name));
            out.*member = *value;
        }
        if (!known)
            throw Error(at(node.source()),
                        fmt::format("no score is called '{}'{}", key.str(), did_you_mean(key.str(), names)));
    }
    return out;
}

}  // namespace tactus::table
