// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/fit/result_lines.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <fstream>

namespace tactus::bench {

namespace {

constexpr const char* end_mark = "complete";

}  // namespace

ResultLines::ResultLines(std::filesystem::path file, std::string key) : file_(std::move(file)), key_(std::move(key)) {
    if (file_.empty() || !std::filesystem::exists(file_)) return;
    std::ifstream in(file_);
    std::vector<Json> part;
    std::size_t number = 0;
    std::uintmax_t kept = 0, read = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        read += line.size() + 1;
        Json row = Json::parse_or_null(line);
        if (row.is_null() && in.peek() == std::ifstream::traits_type::eof()) break;
        if (!row.is_object() || !row.contains(key_) || !row[key_].is_number_integer())
            throw Error(
                fmt::format("{}:{}: is no result of this study; name another file with --out", file_.string(), number));
        if (row.contains(end_mark)) {
            done_.insert(row[key_].get<int>());
            rows_.insert(rows_.end(), part.begin(), part.end());
            part.clear();
            kept = read;
        } else part.push_back(std::move(row));
    }
    in.close();
    if (kept < std::filesystem::file_size(file_)) std::filesystem::resize_file(file_, kept);
}

void ResultLines::add(int number, const std::vector<Json>& rows) {
    rows_.insert(rows_.end(), rows.begin(), rows.end());
    done_.insert(number);
    if (file_.empty()) return;
    std::ofstream out(file_, std::ios::app);
    std::string text;
    for (const Json& row : rows) text += row.dump() + "\n";
    text += Json{{key_, number}, {end_mark, true}}.dump() + "\n";
    out << text << std::flush;
    if (!out) throw Error(fmt::format("{}: cannot be written", file_.string()));
}

}  // namespace tactus::bench
