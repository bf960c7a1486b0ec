// SPDX-License-Identifier: Apache-2.0
#include "assets/experiment/toml_values.hpp"

#include "dsp/core/units.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <limits>
#include <optional>

namespace tactus::experiment {

void TomlValues::check_format(int known) const {
    const toml::node* node = root().get("format");
    if (!node) throw Error(SourceLocation{file(), 1, 1}, fmt::format("the file begins with format = {}", known));
    const auto format = node->value_exact<std::int64_t>();
    if (!format || *format != known)
        fail(*node, fmt::format("this program reads format {}; write format = {}", known, known));
}

const toml::node& TomlValues::need(const toml::table& table, const char* name, const std::string& example) const {
    if (const auto* node = table.get(name)) return *node;
    const SourceLocation where = file::toml_place(file(), table.source());
    throw Error(where.line > 0 ? where : SourceLocation{file(), 1, 1},
                fmt::format("'{}' is missing: {}", name, example));
}

std::string TomlValues::line(const toml::node& node) const {
    const std::string text = word(node);
    if (text.empty() || text.size() > 80 ||
        std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
        fail(node, "one line of 1 to 80 bytes is expected here");
    return text;
}

std::string TomlValues::label(const toml::node& node) const {
    const std::string text = word(node);
    const auto is_plain = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 && static_cast<unsigned char>(c) < 128;
    };
    if (text.empty() || text.size() > 40 || !std::ranges::all_of(text, is_plain))
        fail(node, "a name of 1 to 40 letters and digits is expected here: it becomes part of file names");
    return text;
}

std::string TomlValues::choice(const toml::node& node, const std::vector<std::string>& all) const {
    const std::string text = word(node);
    if (std::ranges::find(all, text) == all.end()) {
        std::string list;
        for (const std::string& one : all) list += (list.empty() ? "" : ", ") + one;
        fail(node, fmt::format("'{}' is none of {}{}", text, list, did_you_mean(text, all)));
    }
    return text;
}

double TomlValues::number(const toml::node& node, double least, double most) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || !(*value >= least && *value <= most))
        fail(node, fmt::format("a number from {} to {} is expected here", least, most));
    return *value;
}

int TomlValues::whole(const toml::node& node, int least, int most) const {
    const auto value = node.value_exact<std::int64_t>();
    if (!value || *value < least || *value > most)
        fail(node, fmt::format("a whole number from {} to {} is expected here", least, most));
    return static_cast<int>(*value);
}

bool TomlValues::flag(const toml::node& node) const {
    const auto value = node.value_exact<bool>();
    if (!value) fail(node, "true or false is expected here");
    return *value;
}

double TomlValues::quantity(const toml::node& node, std::string_view unit, double least, double most) const {
    double value = 0.0;
    if (unit.empty() && node.is_number()) {
        value = node.value<double>().value_or(std::numeric_limits<double>::quiet_NaN());
    } else {
        try {
            value = parse_as(word(node), unit);
        } catch (const Error& error) {
            if (error.where().line > 0) throw;
            fail(node, error.message());
        }
    }
    if (!(value >= least && value <= most))
        fail(node, fmt::format("must be {} to {}", format_quantity(least, unit), format_quantity(most, unit)));
    return value;
}

const toml::array& TomlValues::list(const toml::node& node, std::size_t least, std::size_t most) const {
    const auto* array = node.as_array();
    if (!array || array->size() < least || array->size() > most)
        fail(node, fmt::format("a list of {} to {} values is expected here", least, most));
    return *array;
}

std::vector<std::string> TomlValues::words(const toml::node& node, std::size_t least, std::size_t most) const {
    std::vector<std::string> all;
    for (const toml::node& one : list(node, least, most)) all.push_back(word(one));
    return all;
}

std::vector<std::string> TomlValues::settings(const toml::node& node) const {
    std::vector<std::string> all;
    for (const toml::node& one : list(node, 0, 256)) {
        all.push_back(word(one));
        const std::size_t equals = all.back().find('='), dot = all.back().find('.');
        if (equals == std::string::npos || dot == std::string::npos || dot > equals)
            fail(one, fmt::format("'{}' is not NODE.PARAM=VALUE", all.back()));
    }
    return all;
}

std::filesystem::path TomlValues::beside(const toml::node& node) const {
    const std::string name = word(node);
    if (name.empty() || name.find('\0') != std::string::npos) fail(node, "a file name is expected here");
    std::filesystem::path path = (folder_ / name).lexically_normal();
    if (!std::filesystem::is_regular_file(path)) fail(node, fmt::format("there is no file {}", path.string()));
    return path;
}

}  // namespace tactus::experiment
