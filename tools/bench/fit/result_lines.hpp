// SPDX-License-Identifier: Apache-2.0
// Results of a long study, kept in a file: a study that was stopped goes on where it was.
#pragma once

#include "assets/file/json.hpp"

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace tactus::bench {

/// Rows of JSON, one per line. A part of the study is one number and all its rows.
class ResultLines {
public:
    using Json = file::Json;

    /// Reads what `file` holds; no name: nothing is kept. `key` is the name of the number in each row. Throws Error for a
    /// file with another content. A last line that was cut off is left out with its part.
    ResultLines(std::filesystem::path file, std::string key);

    bool has(int number) const { return done_.contains(number); }
    /// Adds a part and writes it to the file at once. Throws Error when that fails.
    void add(int number, const std::vector<Json>& rows);
    const std::vector<Json>& rows() const { return rows_; }

private:
    std::filesystem::path file_;
    std::string key_;
    std::set<int> done_;
    std::vector<Json> rows_;
};

}  // namespace tactus::bench
