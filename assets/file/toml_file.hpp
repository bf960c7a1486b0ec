// SPDX-License-Identifier: Apache-2.0
// What all readers of TOML files share: parsing that no text can crash, and errors with line and column. The parser's own
// header is heavy and stays in the .cpp of those who look into tables.
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

/// `file` names the text in messages. Throws Error at the place where it is not TOML.
TomlTable parse_toml(std::string_view text, const std::string& file);

/// The place of something in that file.
SourceLocation toml_place(const std::string& file, const toml::source_region& source);

/// A file that is read value by value. Its members throw Error at the value that is wrong.
class TomlFile {
public:
    /// `what` it is, for messages: "a display rig". Throws Error when it cannot be read or is not TOML.
    TomlFile(const std::filesystem::path& path, std::string what);

    const std::string& file() const { return file_; }
    const toml::table& root() const { return *root_; }
    [[noreturn]] void fail(const toml::node& node, const std::string& message) const;
    const toml::table& as_table(const toml::node& node) const;
    /// Fails at the first key that is none of `names`.
    void know(const toml::table& table, const std::vector<std::string>& names) const;
    std::string word(const toml::node& node) const;

private:
    std::string file_, what_;
    TomlTable root_;
};

}  // namespace tactus::file
