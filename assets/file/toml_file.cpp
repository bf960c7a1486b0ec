// SPDX-License-Identifier: Apache-2.0
#include "assets/file/toml_file.hpp"

#include "assets/file/toml_depth.hpp"
#include "assets/file/whole_file.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace tactus::file {

void TomlTableDeleter::operator()(toml::table* table) const noexcept { delete table; }

SourceLocation toml_place(const std::string& file, const toml::source_region& source) {
    return {file, static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

TomlTable parse_toml(std::string_view text, const std::string& file) {
    if (const std::optional<std::size_t> offset = overlong_key(text)) {
        const std::string_view before = text.substr(0, *offset);
        const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is the start of the text
        throw Error(
            {file, 1 + static_cast<int>(std::ranges::count(before, '\n')), 1 + static_cast<int>(*offset - line_start)},
            fmt::format("a key has at most {} dots", max_dots_in_key));
    }
    try {
        return TomlTable(new toml::table(toml::parse(text, file)));
    } catch (const toml::parse_error& error) {
        throw Error(toml_place(file, error.source()), fmt::format("not valid TOML: {}", error.description()));
    }
}

TomlFile::TomlFile(const std::filesystem::path& path, std::string what)
    : file_(path.string()), what_(std::move(what)), root_(parse_toml(read_whole_file(path), file_)) {}

void TomlFile::fail(const toml::node& node, const std::string& message) const {
    throw Error(toml_place(file_, node.source()), message);
}

const toml::table& TomlFile::as_table(const toml::node& node) const {
    if (!node.is_table()) fail(node, "a table is expected here");
    return *node.as_table();
}

void TomlFile::know(const toml::table& table, const std::vector<std::string>& names) const {
    for (const auto& [key, value] : table)
        if (std::ranges::find(names, key.str()) == names.end())
            fail(value, fmt::format("unknown key '{}' in {}{}", key.str(), what_, did_you_mean(key.str(), names)));
}

std::string TomlFile::word(const toml::node& node) const {
    if (!node.is_string()) fail(node, "a text in quotes is expected here");
    return node.as_string()->get();
}

}  // namespace tactus::file
