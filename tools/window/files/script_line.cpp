// SPDX-License-Identifier: Apache-2.0
#include "tools/window/files/script_line.hpp"

#include "assets/file/whole_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <utility>

namespace tactus::window {

namespace {

std::vector<std::string> words_of(const std::string& line) {
    std::vector<std::string> words;
    std::istringstream stream(line);
    for (std::string word; stream >> word;) {
        if (word.front() == '#') break;
        if (word.front() == '"') {
            std::string rest;
            if (word.size() < 2 || word.back() != '"') {
                std::getline(stream, rest, '"');
                word = word.substr(1) + rest;
            } else word = word.substr(1, word.size() - 2);
        }
        words.push_back(word);
    }
    return words;
}

}  // namespace

const std::string& ScriptLine::word(std::size_t i) const {
    if (i >= words.size())
        throw Error(where, fmt::format("'{}' needs {} more words", words.front(), i + 1 - words.size()));
    return words[i];
}

double ScriptLine::number(std::size_t i) const {
    const std::string& text = word(i);
    double value = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
        throw Error(where, fmt::format("'{}' is not a number", text));
    return value;
}

std::vector<ScriptLine> script_lines(const std::string& text, const std::string& file,
                                     const std::vector<std::string>& commands,
                                     const std::vector<std::pair<std::string, std::string>>& old) {
    std::vector<ScriptLine> lines;
    std::istringstream stream(text);
    int number = 0;
    for (std::string written; std::getline(stream, written);) {
        ++number;
        ScriptLine line{{file, number, 1}, false, words_of(written)};
        if (line.words.empty()) continue;
        if (line.words.front() == "!") {
            line.is_refused = true;
            line.words.erase(line.words.begin());
        }
        const std::string name = line.words.empty() ? "" : line.words.front();
        if (const auto before = std::ranges::find(old, name, &std::pair<std::string, std::string>::first);
            before != old.end())
            line.words.front() = before->second;
        if (line.words.empty() || std::ranges::find(commands, line.words.front()) == commands.end())
            throw Error(line.where, fmt::format("no command '{}'{}", name, did_you_mean(name, commands)));
        lines.push_back(std::move(line));
    }
    return lines;
}

std::vector<ScriptLine> read_script(const std::filesystem::path& file, const std::vector<std::string>& commands,
                                    const std::vector<std::pair<std::string, std::string>>& old) {
    return script_lines(file::read_whole_file(file), file.string(), commands, old);
}

}  // namespace tactus::window
