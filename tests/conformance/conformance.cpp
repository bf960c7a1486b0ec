// SPDX-License-Identifier: Apache-2.0
// conformance [--check PAGE | --write PAGE] [TABLE ...]: gives the file of each case to the built command, and checks
// that it is read right without a note, read with the expected note, or refused with the expected words. --check compares the tables with those of
// the page, --write replaces them. Exit code 1 if a case or a table differs.
#include "assets/file/whole_file.hpp"
#include "tests/campaign/limited_run.hpp"
#include "tests/conformance/cases.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <stdexcept>

namespace tactus::conformance {

std::function<void(const fs::path&)> bytes(std::string content) {
    return [content = std::move(content)](const fs::path& path) { file::write_whole_file(path, content); };
}

void by_command(const fs::path& path, std::vector<std::string> words) {
    words.insert(words.begin(), campaign::tried_command());
    const fs::path said = path.parent_path() / "said.txt";
    const campaign::RunEnd end = campaign::run_limited(words, path.parent_path(), {}, said);
    if (end.code != 0)
        throw std::runtime_error(fmt::format("'{}' made no file: {}", words[1], file::read_whole_file(said)));
}

std::vector<std::string> strings_of(const Json& array) {
    std::vector<std::string> all;
    if (array.is_array())
        for (const Json& one : array) all.push_back(one.get<std::string>());
    return all;
}

std::string differs(const std::string& what, double found, double expected, double relative) {
    const bool is_same = std::abs(found - expected) <= relative * std::max(std::abs(expected), 1e-12);
    return is_same ? "" : fmt::format("{} is {} instead of {}", what, found, expected);
}

namespace {

constexpr const char* result_names[] = {"read", "read with a note", "refused"};

struct Answer {
    Result result = Result::refused;
    std::string text;  ///< the notes or the refusal
    std::string fault;
};

std::string trimmed(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    return text;
}

/// Standard output of a good answer, the message of a refusal.
Answer answer_of(const Format& format, const Case& one, const fs::path& folder) {
    std::vector<std::string> words{campaign::tried_command()};
    for (const std::string& word : format.verb) words.push_back(word == "FILE" ? one.file : word);
    words.insert(words.end(), one.options.begin(), one.options.end());
    const fs::path said = folder / "said.txt";
    const campaign::RunEnd end = campaign::run_limited(words, folder, {}, said);
    const std::string text = trimmed(file::read_whole_file(said));
    if (!end.fault.empty()) return {Result::refused, text, end.fault};
    if (end.code >= 2) {
        // Some verbs repeat the error in JSON.
        Answer refusal{Result::refused, text.substr(0, text.find("\n{")), ""};
        if (refusal.text.starts_with("tactus: ")) refusal.text.erase(0, 8);
        return refusal;
    }
    const std::size_t start = text.find('{');
    Json json = Json::parse(start == std::string::npos ? text : text.substr(start), nullptr, false);
    if (!json.is_object()) return {Result::read, text, "the answer is no JSON object: " + text};
    json["said"] = trimmed(text.substr(0, start));
    const std::vector<std::string> notes = format.notes(json);
    return {notes.empty() ? Result::read : Result::note, fmt::format("{}", fmt::join(notes, "; ")),
            (one.check ? one.check : format.check)(json)};
}

std::string fault_of(const Case& one, const Answer& answer) {
    if (!answer.fault.empty()) return answer.fault;
    if (answer.result != one.result)
        return fmt::format("{} in place of {}: {}", result_names[int(answer.result)], result_names[int(one.result)],
                           answer.text);
    if (one.result != Result::read && (one.words.empty() || answer.text.find(one.words) == std::string::npos))
        return fmt::format("'{}' is not in: {}", one.words, answer.text);
    return "";
}

std::string escaped(std::string text) {
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
    for (std::size_t at = 0; (at = text.find("\n  ", at)) != std::string::npos;) text.replace(at, 3, " / ");
    std::ranges::replace(text, '\n', ' ');
    return text;
}

std::string row_of(const std::string& format, const Case& one, const Answer& answer) {
    std::string result = result_names[int(one.result)];
    if (one.result != Result::read) result += fmt::format(": `{}`", escaped(answer.text));
    if (!one.options.empty()) result = fmt::format("`{}`: {}", fmt::join(one.options, " "), result);
    return fmt::format("| {} | {} | {} |\n", format, escaped(one.feature), result);
}

/// The table as Markdown. Errors go to standard error and are counted.
std::string run(const Table& table, const fs::path& scratch, int& faults) {
    std::string text = "| format | feature | result |\n|---|---|---|\n";
    for (const Format& format : table.formats) {
        std::string name = format.name;
        for (const Case& one : format.cases) {
            const fs::path folder = scratch / "case";
            fs::remove_all(folder);
            fs::create_directories((folder / one.file).parent_path());
            Answer answer;
            try {
                one.write(folder / one.file);
                answer = answer_of(format, one, folder);
            } catch (const std::exception& error) {
                answer.fault = error.what();
            }
            if (const std::string fault = fault_of(one, answer); !fault.empty()) {
                fmt::print(stderr, "{}, {}: {}\n", format.name, one.feature, fault);
                ++faults;
            }
            text += row_of(std::exchange(name, ""), one, answer);
        }
    }
    return text;
}

/// Where the table of the page begins and ends: between two comments.
std::pair<std::size_t, std::size_t> place_of(const Table& table, const std::string& page) {
    const std::string first = fmt::format("<!-- {}: written by docs/generate.sh -->\n\n", table.name),
                      last = fmt::format("\n<!-- end of {} -->", table.name);
    const std::size_t start = page.find(first), end = page.find(last);
    if (start == std::string::npos || end == std::string::npos)
        throw std::runtime_error(fmt::format("the page has no place for the table '{}'", table.name));
    return {start + first.size(), end};
}

int run_all(const std::vector<std::string>& wanted, const fs::path& page, bool is_written) {
    const fs::path scratch = fs::temp_directory_path() / fmt::format("tactus-conformance-{}", getpid());
    int faults = 0, tried = 0;
    std::string text = page.empty() ? "" : file::read_whole_file(page);
    for (const Table& table :
         {scan_table(), mesh_table(), mark_table(), sound_table(), log_table(), recording_table()}) {
        if (!wanted.empty() && std::ranges::find(wanted, table.name) == wanted.end()) continue;
        ++tried;
        const std::string made = run(table, scratch, faults);
        if (page.empty()) {
            fmt::print("{}\n{}\n", table.name, made);
            continue;
        }
        const auto [start, end] = place_of(table, text);
        if (is_written) text.replace(start, end - start, made);
        else if (text.compare(start, end - start, made) != 0) {
            fmt::print(stderr, "the table '{}' of {} differs; run docs/generate.sh. It would be:\n{}", table.name,
                       page.string(), made);
            ++faults;
        }
    }
    std::error_code ignored;
    fs::remove_all(scratch, ignored);
    if (tried == 0) throw std::runtime_error("there is no such table");
    if (is_written && faults == 0) file::write_whole_file(page, text);
    return faults > 0 ? 1 : 0;
}

}  // namespace

}  // namespace tactus::conformance

int main(int count, char** words) {
    std::vector<std::string> wanted(words + 1, words + count);
    std::filesystem::path page;
    bool is_written = false;
    if (wanted.size() >= 2 && wanted[0].starts_with("--")) {
        is_written = wanted[0] == "--write";
        page = wanted[1];
        wanted.erase(wanted.begin(), wanted.begin() + 2);
    }
    try {
        return tactus::conformance::run_all(wanted, page, is_written);
    } catch (const std::exception& error) {
        fmt::print(stderr, "conformance: {}\n", error.what());
        return 1;
    }
}
