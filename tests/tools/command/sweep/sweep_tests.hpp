// SPDX-License-Identifier: Apache-2.0
// Sweeps of the tests, and their results.
#pragma once

#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace tactus::test {

/// 20 levels × 10 seeds of a program that prints JSON and keeps a file; a point takes some milliseconds.
inline std::string two_hundred_points(const std::string& more = {}) {
    return "format = 1\ntitle = \"Two hundred\"\n[axes.level]\nunit = \"N\"\nrange = [1, 20]\ncount = "
           "20\n[seeds]\ncount = 10\n"
           "[[step]]\ncommand = [\"sh\", \"-c\", '" +
           more +
           "echo \"$1 $2\" > \"$0/kept.txt\"; echo \"{{\\\"value\\\": $1, \\\"seed\\\": $2}}\"', \"{out}\", "
           "\"{level.number}\", \"{seed}\"]\nvalues = {value = \"/value\", drawn = \"/seed\"}\nfiles = [\"kept.txt\"]\n"
           "[limits]\nretries = 0\n";
}

struct SweepStatus {
    std::size_t points = 0, done = 0, failed = 0, repeated = 0;
    std::string hash;
};

inline SweepStatus status_of(const Folder& folder, const std::string& name) {
    const Outcome outcome = folder.tactus("sweep status " + (folder.path / name).string() + " --json");
    CAPTURE(outcome.err);
    REQUIRE(outcome.code != 2);
    const nlohmann::json json = nlohmann::json::parse(outcome.out);
    return {json["points"], json["done"], json["failed"], json["repeated"], json["hash"]};
}

/// The columns of results.csv that do not depend on who ran a point: all up to and with 'output'.
inline std::string results_of(const Folder& folder, const std::string& name) {
    std::istringstream table(slurp(folder.path / name / "results.csv"));
    std::string line, all;
    std::size_t columns = 0;
    while (std::getline(table, line)) {
        if (columns == 0) {
            const std::size_t end = line.find(",output,");
            REQUIRE(end != std::string::npos);
            columns = static_cast<std::size_t>(
                          std::count(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(end), ',')) +
                      2;
        }
        std::size_t at = 0;
        for (std::size_t c = 0; c < columns && at != std::string::npos; ++c) at = line.find(',', at + (c > 0 ? 1 : 0));
        all += line.substr(0, at) + "\n";
    }
    return all;
}

/// Waits until at least `count` rows are in the logs.
inline std::size_t rows_in(const fs::path& folder) {
    std::size_t rows = 0;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder / "log", ignored)) {
        const std::string text = slurp(entry.path());
        rows += static_cast<std::size_t>(std::ranges::count(text, '\n'));
        if (!text.empty()) --rows;
    }
    return rows;
}

}  // namespace tactus::test
