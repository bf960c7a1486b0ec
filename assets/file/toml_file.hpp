// SPDX-License-Identifier: Apache-2.0
// Base of all TOML readers: safe parsing, and errors with line and column. The parser's header is heavy, so only .cpp
// files include it.
#pragma once

#include "dsp/core/error.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace toml {
inline namespace v3 {
class node;
class table;
struct source_region;
}  // namespace v3
}  // namespace toml

namespace tactus::file {

struct TomlTableDeleter {
    void operator()(toml::table* table) const noexcept;
};
using TomlTable = std::unique_ptr<toml::table, TomlTableDeleter>;

/// Parses `text`; `file` names it in messages. Throws Error with the position of a syntax error.
TomlTable parse_toml(std::string_view text, const std::string& file);

/// Position of a node in that file.
SourceLocation toml_place(const std::string& file, const toml::source_region& source);

/// A TOML file in memory. Its members throw Error with the position of a wrong value.
class TomlFile {
public:
    /// `what`: kind of file for messages, such as "a display file". Throws Error when it cannot be read or is not TOML.
    TomlFile(const std::filesystem::path& path, std::string what);

    const std::string& file() const { return file_; }
    const toml::table& root() const { return *root_; }
    [[noreturn]] void fail(const toml::node& node, const std::string& message) const;
    const toml::table& as_table(const toml::node& node) const;
    /// Throws Error at the first key that is not in `names`.
    void know(const toml::table& table, const std::vector<std::string>& names) const;
    std::string word(const toml::node& node) const;

private:
    std::string file_, what_;
    TomlTable root_;
};

}  // namespace tactus::file
