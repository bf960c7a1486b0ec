// SPDX-License-Identifier: Apache-2.0
#include "tools/command/written_options.hpp"

#include "assets/bone/bone.hpp"
#include "assets/file/outputs.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <iterator>

namespace tactus::command {

namespace fs = std::filesystem;

namespace {

/// The existing files and folders that a value may name: FILE, FILE#BONE, NAME=FILE, FILE,FILE.
std::vector<fs::path> files_in(const std::string& value) {
    std::vector<fs::path> files;
    const auto add = [&files](const std::string& text) {
        std::error_code failed;
        if (text.empty()) return;
        for (const fs::path& path : {fs::path(text), bone::file_of_bone(text)})
            if (fs::exists(path, failed) && !failed) files.push_back(path);
    };
    add(value);
    add(value.substr(value.find('=') + 1));
    for (std::size_t start = 0; start <= value.size();) {
        const std::size_t comma = std::min(value.find(',', start), value.size());
        add(value.substr(start, comma - start));
        start = comma + 1;
    }
    return files;
}

bool matches(const std::string& name, const std::string& pattern) {
    const std::size_t star = pattern.find('*');
    if (star == std::string::npos) return name == pattern;
    return name.starts_with(pattern.substr(0, star)) && name.ends_with(pattern.substr(star + 1));
}

void check_folder(const fs::path& folder, const std::vector<fs::path>& sources,
                  const std::vector<std::string>& patterns) {
    std::error_code failed;
    for (const auto& entry : fs::directory_iterator(folder, failed)) {
        const std::string name = entry.path().filename().string();
        if (std::ranges::none_of(patterns, [&](const std::string& pattern) { return matches(name, pattern); }))
            continue;
        for (const fs::path& source : sources)
            if (file::is_of_source(source, entry.path()))
                throw Error(
                    fmt::format("{}: the folder has a source ({}), which a result might overwrite; name another folder",
                                folder.string(), name));
    }
}

}  // namespace

const std::vector<WrittenOption>& written_options() {
    static const std::vector<WrittenOption> all{{"", "--out"},
                                                {"", "--csv"},
                                                {"", "--table"},
                                                {"", "--plot"},
                                                {"", "--cepstrum"},
                                                {"", "--waterfall"},
                                                {"", "--straightened"},
                                                {"", "--equaliser"},
                                                {"", "--picture"},
                                                {"", "--record"},
                                                {"calibrate", "--keep"},
                                                {"plan guide", "--task"},
                                                {"plan report", "--pdf"},
                                                {"run", "--log"},
                                                {"segment", "--certainty"},
                                                {"segment", "--paint"},
                                                {"segment", "--plan"},
                                                {"segment", "--propose"}};
    return all;
}

bool is_written(std::string_view verb, const CLI::Option& option) {
    return std::ranges::any_of(written_options(), [&](const WrittenOption& one) {
        return (one.verb.empty() || one.verb == verb) && option.check_name(std::string(one.option));
    });
}

std::vector<std::string> files_in_folder(std::string_view verb) {
    if (verb == "fracture") return {"fragment_*.vdb", "fragment_*.stl", "truth.json"};
    if (verb == "plan export") return {"*.stl", "*.ply", "*.tfm", "*.h5", "*.vtp", "*.mrk.json", "*.csv"};
    if (verb == "gripper") return {"rig.csv", "series.csv", "rig.json", "*.png"};
    return {};
}

std::vector<std::string> own_results(std::string_view verb) {
    if (verb == "experiment analyse") return {"report.*", "results.*"};
    return {};
}

void check_written(const CLI::App& app, const std::string& verb) {
    std::vector<fs::path> sources, files, folders;
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_type_size() == 0) continue;  // a flag
        for (const std::string& value : option->results())
            if (!is_written(verb, *option)) std::ranges::move(files_in(value), std::back_inserter(sources));
            else if (std::error_code failed; fs::is_directory(value, failed)) folders.emplace_back(value);
            else files.emplace_back(value);
    }
    const std::vector<std::string> own = own_results(verb);
    const auto is_own = [&](const fs::path& source, const fs::path& out) {
        std::error_code failed;
        return fs::equivalent(source, out.has_parent_path() ? out.parent_path() : ".", failed) &&
               std::ranges::any_of(
                   own, [&](const std::string& pattern) { return matches(out.filename().string(), pattern); });
    };
    for (const fs::path& out : files)
        for (const fs::path& source : sources)
            if (!is_own(source, out) && file::is_of_source(source, out)) file::check_outputs({&source, 1}, {&out, 1});
    for (std::size_t n = 0; n < files.size(); ++n)
        if (std::ranges::count(files, files[n]) > 1) file::check_outputs({}, files);
    if (const std::vector<std::string> patterns = files_in_folder(verb); !patterns.empty())
        for (const fs::path& folder : folders) check_folder(folder, sources, patterns);
}

}  // namespace tactus::command
