// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/equaliser_file.hpp"

#include "assets/file/toml_file.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <array>
#include <cmath>
#include <sstream>

namespace tactus::sound {

namespace {

const std::array<std::string, 8> keys{"title", "kind", "rate", "delay", "band", "mean_gain", "unit", "taps"};
constexpr std::size_t max_taps = 1'000'000;

SourceLocation location(const toml::node& node, const std::filesystem::path& path) {
    return {path.string(), static_cast<int>(node.source().begin.line), static_cast<int>(node.source().begin.column)};
}

double quantity(const toml::node& node, const std::filesystem::path& path, std::string_view like) {
    if (!node.is_string())
        throw Error(location(node, path), fmt::format("a quantity with its unit is expected, as in \"1 {}\"", like));
    try {
        return parse_as(node.as_string()->get(), like);
    } catch (const Error& error) {
        throw Error(location(node, path), error.message());
    }
}

std::string text(const toml::node& node, const std::filesystem::path& path) {
    if (!node.is_string()) throw Error(location(node, path), "a text is expected");
    return node.as_string()->get();
}

}  // namespace

void save_equaliser(const vibration::Equaliser& equaliser, const std::string& title,
                    const std::filesystem::path& path) {
    std::ostringstream quoted;
    quoted << toml::value<std::string>(title);
    std::string out = fmt::format(
        "# An equaliser: a filter for the 'equaliser' node.\n"
        "title     = {}\nkind      = \"{}\"\nrate      = \"{} Hz\"\ndelay     = \"{} s\"\n"
        "band      = [\"{} Hz\", \"{} Hz\"]\nmean_gain = {}\nunit      = \"{}\"\ntaps = [\n",
        quoted.str(), equaliser.kind == vibration::EqualiserKind::linear_phase ? "linear_phase" : "minimum_phase",
        equaliser.rate, equaliser.delay, equaliser.lowest, equaliser.highest, equaliser.mean_gain, equaliser.unit);
    for (std::size_t i = 0; i < equaliser.taps.size(); ++i)
        out += fmt::format("{:.9e},{}", equaliser.taps[i], i % 8 == 7 ? "\n" : " ");
    file::write_whole_file(path, out + "]\n");
}

vibration::Equaliser load_equaliser(const std::filesystem::path& path) {
    const file::TomlTable parsed = file::parse_toml(file::read_whole_file(path), path.string());
    const toml::table& root = *parsed;
    const SourceLocation whole{path.string(), 0, 0};
    vibration::Equaliser out;
    for (const auto& [key, node] : root) {
        const std::string name(key.str());
        if (name == "kind") {
            const std::string kind = text(node, path);
            if (kind != "linear_phase" && kind != "minimum_phase")
                throw Error(location(node, path), "'kind' must be \"minimum_phase\" or \"linear_phase\"");
            out.kind = kind == "linear_phase" ? vibration::EqualiserKind::linear_phase
                                              : vibration::EqualiserKind::minimum_phase;
        } else if (name == "rate") {
            out.rate = quantity(node, path, "Hz");
        } else if (name == "delay") {
            out.delay = quantity(node, path, "s");
        } else if (name == "band") {
            const toml::array* band = node.as_array();
            if (!band || band->size() != 2) throw Error(location(node, path), "'band' must be two frequencies");
            out.lowest = quantity(*band->get(0), path, "Hz");
            out.highest = quantity(*band->get(1), path, "Hz");
        } else if (name == "mean_gain") {
            const auto value = node.value<double>();
            if (!value || !std::isfinite(*value)) throw Error(location(node, path), "'mean_gain' must be a number");
            out.mean_gain = *value;
        } else if (name == "unit") {
            out.unit = text(node, path);
        } else if (name == "taps") {
            const toml::array* taps = node.as_array();
            if (!taps || taps->empty() || taps->size() > max_taps)
                throw Error(location(node, path), fmt::format("'taps' must be a list of 1 to {} numbers", max_taps));
            for (const toml::node& tap : *taps) {
                const auto value = tap.value<double>();
                if (!value || !(std::abs(*value) <= 1e6))
                    throw Error(location(tap, path), "a tap must be a number from -1e6 to 1e6");
                out.taps.push_back(static_cast<float>(*value));
            }
        } else if (name != "title") {
            throw Error(location(node, path),
                        fmt::format("an equaliser has no key '{}'{}", name, did_you_mean(name, keys)));
        }
    }
    if (!root.contains("rate") || out.taps.empty())
        throw Error(whole, "an equaliser needs 'rate' and 'taps'; make one with 'tactus equalise'");
    if (!(out.rate >= 1.0 && out.rate <= 1e6)) throw Error(whole, "the equaliser's rate must be 1 Hz to 1 MHz");
    if (!(out.delay >= 0.0 && out.delay * out.rate < static_cast<double>(out.taps.size())))
        throw Error(whole, "the delay must be shorter than the impulse response");
    return out;
}

}  // namespace tactus::sound
