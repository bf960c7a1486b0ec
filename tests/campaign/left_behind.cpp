// SPDX-License-Identifier: Apache-2.0
#include "tests/campaign/left_behind.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/sound/sound.hpp"
#include "tests/campaign/limited_run.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <sstream>
#include <string_view>

namespace tactus::campaign {

namespace {

namespace fs = std::filesystem;

/// Exit code of the command, and what it printed.
std::pair<int, std::string> answer(std::vector<std::string> words, const fs::path& folder) {
    words.insert(words.begin(), tried_command());
    const fs::path told = fs::path(folder.string() + ".told");
    const RunEnd end = run_limited(words, folder, {}, told);
    std::string text = fs::exists(told) ? file::read_whole_file(told) : std::string();
    fs::remove(told);
    return {end.fault.empty() ? end.code : -1, end.fault.empty() ? text : end.fault};
}

std::string fault_of_table(const std::string& text) {
    if (text.find('\0') != std::string::npos) return "holds NUL bytes";
    if (text.empty()) return {};
    if (text.back() != '\n') return "its last row is cut";
    std::istringstream lines(text);
    std::string line;
    std::getline(lines, line);
    const auto columns = std::ranges::count(line, ',');
    for (int row = 1; std::getline(lines, line); ++row)
        if (std::ranges::count(line, ',') != columns) return fmt::format("row {} is cut: {}", row, line);
    return {};
}

/// A take repeats its run as far as it goes; one that has not begun is called none.
std::string fault_of_take(const fs::path& take) {
    const auto [code, text] = answer({"replay", take.string(), "--json"}, take);
    if (!fs::exists(take / "take.json")) return code == 2 ? "" : fmt::format("replay ends with {}: {}", code, text);
    const nlohmann::json said = nlohmann::json::parse(text, nullptr, false);
    if (said.is_discarded()) return fmt::format("replay ends with {}: {}", code, text);
    if (!said.at("first_difference").is_null() || !said.at("damaged_files").empty() ||
        !said.at("differing_hashes").empty())
        return fmt::format("replay differs: {}", said.dump());
    const int wanted = said.at("compared_values") > 0 ? 0 : 1;
    return code == wanted ? "" : fmt::format("replay ends with {}: {}", code, text);
}

std::string fault_of_verb(std::vector<std::string> words, const fs::path& file) {
    words.push_back(file.string());
    const auto [code, text] = answer(words, file.parent_path());
    return code == 0 ? "" : fmt::format("{} ends with {}: {}", words.front(), code, text);
}

/// Empty: it opens.
std::string fault_of_file(const fs::path& file) {
    const std::string name = file.filename().string();
    const auto ends = [&name](std::string_view ending) { return name.ends_with(ending); };
    if (ends(".csv") || ends(".csv.part")) return fault_of_table(file::read_whole_file(file));
    // A plan's lock that was left stands for nothing; a socket is removed by the next run.
    if (ends(".part") || (name.starts_with('.') && ends(".lock"))) return {};
    if (ends(".plan.json")) return fault_of_verb({"plan", "show"}, file);
    if (ends(".json"))
        return nlohmann::json::accept(file::read_whole_file(file)) ? std::string() : std::string("is no JSON");
    if (ends(".wav")) {
        // A run that was ended before its first tick has a header and no sample; readers call it empty.
        constexpr std::uintmax_t longest_header = 128;
        if (fs::file_size(file) > longest_header) sound::load_sound(file);
        return {};
    }
    if (ends(".vdb") || ends(".stl")) return fault_of_verb({"info"}, file);
    if (ends(".png")) return file::read_whole_file(file).ends_with("IEND\xae\x42\x60\x82") ? "" : "is cut";
    if (ends(".toml")) return file::read_whole_file(file).empty() ? "is empty" : "";
    return "is of a kind that nothing is said of";
}

bool is_take(const fs::path& folder) { return fs::exists(folder / "events.jsonl"); }

}  // namespace

Snapshot snapshot_of(const fs::path& folder) {
    Snapshot all;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file())
            all[entry.path().lexically_relative(folder).string()] = file::read_whole_file(entry.path());
    return all;
}

std::vector<std::string> faults_in(const fs::path& folder, const Snapshot& before,
                                   const std::vector<std::string>& may_change, bool may_be_cut) {
    std::vector<std::string> faults;
    const auto note = [&faults](const std::string& name, const std::string& fault) {
        if (!fault.empty()) faults.push_back(fmt::format("{}: {}", name, fault));
    };
    const auto changes = [&](const std::string& name) {
        return std::ranges::find(may_change, name) != may_change.end();
    };
    for (const auto& [name, bytes] : before)
        if (!fs::exists(folder / name)) note(name, "is gone");
        else if (!changes(name) && file::read_whole_file(folder / name) != bytes) note(name, "has changed");
    std::vector<fs::path> entries;
    for (auto at = fs::recursive_directory_iterator(folder); at != fs::recursive_directory_iterator(); ++at) {
        entries.push_back(at->path());
        if (at->is_directory() && is_take(at->path())) at.disable_recursion_pending();
    }
    for (const fs::path& entry : entries) {
        const std::string name = entry.lexically_relative(folder).string();
        if (before.contains(name) && !changes(name)) continue;
        try {
            if (fs::is_directory(entry)) {
                if (is_take(entry) && !before.contains(name + "/events.jsonl")) note(name, fault_of_take(entry));
            } else if (fs::is_regular_file(entry)) {
                note(name, fault_of_file(entry));
                if (!may_be_cut && name.ends_with(".part")) note(name, "is left although nothing was cut");
            }
        } catch (const std::exception& error) {
            note(name, error.what());
        }
    }
    return faults;
}

}  // namespace tactus::campaign
