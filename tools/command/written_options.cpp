// SPDX-License-Identifier: Apache-2.0
#include "tools/command/written_options.hpp"

#include "assets/bone/bone.hpp"
#include "assets/file/outputs.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/experiment/experiment_folder.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>
#include <utility>

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

std::string name_of(const CLI::Option& option) {
    return option.get_lnames().empty() ? option.get_name() : "--" + option.get_lnames().front();
}

/// ".html, .pdf or .txt"
std::string list_of(const std::vector<std::string>& endings) {
    if (endings.size() == 1) return endings.front();
    return fmt::format("{} or {}", fmt::join(endings.begin(), endings.end() - 1, ", "), endings.back());
}

bool has_ending(const std::string& name, const std::vector<std::string>& endings) {
    return std::ranges::any_of(endings, [&](const std::string& ending) { return name.ends_with(ending); });
}

/// Throws Error for a name whose ending belongs to a format that the option does not write.
void check_ending(const fs::path& out, const DeclaredOutput& output, const std::vector<std::string>& formats) {
    const OutputFormat& what = output.what;
    const std::string name = out.filename().string();
    std::error_code failed;
    // Whether an existing folder will do is for the verb to judge.
    if (out.empty() || file::is_stream(out) || fs::is_directory(out, failed)) return;
    if (has_ending(name, what.endings) || (what.is_free && !has_ending(name, formats))) return;
    const std::string option = name_of(*output.option);
    if (what.endings.empty())
        throw Error(fmt::format("{}: {} does not write '{}' files; choose a name without this ending", out.string(),
                                option, out.extension().string()));
    throw Error(fmt::format("{}: {} is written as {}{}", out.string(), option, list_of(what.endings),
                            what.is_free ? ", or into a folder" : ""));
}

}  // namespace

std::vector<std::string> written_formats(const DeclaredVerbs& declared) {
    // No option names these: sounds are written into folders, and the others are only read.
    std::set<std::string> all{".wav", ".flac", ".obj", ".dcm", ".zip"};
    for (const auto& [app, verb] : declared)
        for (const DeclaredOutput& output : verb.outputs)
            all.insert(output.what.endings.begin(), output.what.endings.end());
    return {all.begin(), all.end()};
}

std::vector<std::string> files_in_folder(std::string_view verb) {
    if (verb == "fracture") return {"fragment_*.vdb", "fragment_*.stl", "truth.json"};
    if (verb == "plan export") return {"*.stl", "*.ply", "*.tfm", "*.h5", "*.vtp", "*.mrk.json", "*.csv"};
    if (verb == "gripper") return {"rig.csv", "series.csv", "rig.json", "*.png"};
    return {};
}

void check_written(const CLI::App& app, const std::string& verb, const DeclaredVerbs& declared) {
    const std::vector<DeclaredOutput>& outputs = declared.at(&app).outputs;
    std::vector<fs::path> sources, files, folders;
    std::vector<std::pair<fs::path, const DeclaredOutput*>> named;
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_type_size() == 0) continue;  // a flag
        const auto output = std::ranges::find(outputs, option, &DeclaredOutput::option);
        for (const std::string& value : option->results()) {
            if (output == outputs.end()) {
                std::ranges::move(files_in(value), std::back_inserter(sources));
                continue;
            }
            named.emplace_back(value, &*output);
            if (std::error_code failed; fs::is_directory(value, failed)) folders.emplace_back(value);
            else files.emplace_back(value);
        }
    }
    // Results that 'experiment analyse' made at another time are in the folder that it reads.
    const auto is_own = [&](const fs::path& source, const fs::path& out) {
        std::error_code failed;
        return verb == "experiment analyse" && analysis::is_experiment_result(out.filename().string()) &&
               fs::equivalent(source, out.has_parent_path() ? out.parent_path() : ".", failed);
    };
    for (const fs::path& out : files)
        for (const fs::path& source : sources)
            if (!is_own(source, out) && file::is_of_source(source, out)) file::check_outputs({&source, 1}, {&out, 1});
    for (std::size_t n = 0; n < files.size(); ++n)
        if (std::ranges::count(files, files[n]) > 1) file::check_outputs({}, files);
    if (const std::vector<std::string> patterns = files_in_folder(verb); !patterns.empty())
        for (const fs::path& folder : folders) check_folder(folder, sources, patterns);
    // Last: that a source would be lost is the graver mistake.
    const std::vector<std::string> formats = written_formats(declared);
    for (const auto& [out, output] : named) check_ending(out, *output, formats);
}

}  // namespace tactus::command
