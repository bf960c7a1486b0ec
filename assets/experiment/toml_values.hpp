// SPDX-License-Identifier: Apache-2.0
// Values of TOML files about experiments, checked. Errors have file, line and column.
#pragma once

#include "assets/file/toml_file.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace toml {
inline namespace v3 {
class array;
}  // namespace v3
}  // namespace toml

namespace tactus::experiment {

class TomlValues : public file::TomlFile {
public:
    TomlValues(const std::filesystem::path& path, const std::string& what)
        : file::TomlFile(path, what), folder_(std::filesystem::absolute(path).parent_path()) {}

    void check_format(int known) const;
    const toml::node& need(const toml::table& table, const char* name, const std::string& example) const;
    /// One line of 1 to 80 bytes.
    std::string line(const toml::node& node) const;
    /// Letters and digits only: part of file names in BIDS, where '-' and '_' separate.
    std::string label(const toml::node& node) const;
    std::string choice(const toml::node& node, const std::vector<std::string>& all) const;
    double number(const toml::node& node, double least, double most) const;
    int whole(const toml::node& node, int least, int most) const;
    bool flag(const toml::node& node) const;
    /// A text with a unit, "1.5 s"; SI. A bare number where `unit` is "".
    double quantity(const toml::node& node, std::string_view unit, double least, double most) const;
    const toml::array& list(const toml::node& node, std::size_t least, std::size_t most) const;
    std::vector<std::string> words(const toml::node& node, std::size_t least, std::size_t most) const;
    /// NODE.PARAM=VALUE each.
    std::vector<std::string> settings(const toml::node& node) const;
    /// A file beside this one; it must exist.
    std::filesystem::path beside(const toml::node& node) const;

private:
    std::filesystem::path folder_;
};

}  // namespace tactus::experiment
