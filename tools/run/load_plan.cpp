// SPDX-License-Identifier: Apache-2.0
#include "tools/run/load_plan.hpp"

#include "assets/file/part.hpp"
#include "graph/patch/sub_patch.hpp"
#include "nodes/catalogue.hpp"
#include "tools/run/find_sweep.hpp"
#include "tools/run/saw_fits.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ranges>

namespace tactus::run {

namespace fs = std::filesystem;

namespace {

/// The bundled library: beside the command in a build folder, otherwise at its installed place.
fs::path bundled_library() {
    const std::vector<fs::path> places = file::places_of_part("library", TACTUS_INSTALLED_LIBRARY);
    std::error_code failure;
    for (const fs::path& place : places)
        if (fs::is_directory(place, failure)) return place;
    return places.front();
}

}  // namespace

fs::path library_folder() {
    if (const char* given = std::getenv("TACTUS_LIBRARY"); given && *given) return given;
    return bundled_library();
}

bool is_of_library(const fs::path& file) {
    std::error_code failure;
    const fs::path path = fs::weakly_canonical(fs::absolute(file), failure);
    for (const fs::path& library : {library_folder(), bundled_library()}) {
        const fs::path folder = fs::weakly_canonical(fs::absolute(library), failure);
        if (!folder.empty() && std::ranges::mismatch(folder, path).in1 == folder.end()) return true;
    }
    return false;
}

namespace {

/// A file by path, or by name in a folder of the library.
fs::path find_bundled(const std::string& name, const char* what, const char* where) {
    // A folder of results may have the name of a patch.
    const bool is_folder = fs::is_directory(name);
    if (fs::exists(name) && !is_folder) return name;
    const fs::path folder = library_folder() / where;
    if (const fs::path bundled = folder / (name + ".toml"); fs::exists(bundled)) return bundled;
    std::vector<std::string> names;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored))
        if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    std::ranges::sort(names);
    std::string list;
    for (const std::string& known : names) list += (list.empty() ? "" : ", ") + known;
    throw Error(fmt::format("no {} '{}': {} one of the library ({}){}", what, name,
                            is_folder ? "a folder, and not" : "neither a file nor",
                            list.empty() ? "which is empty; build first" : list, did_you_mean(name, names)));
}

}  // namespace

namespace {

/// 299980 → "299,980".
std::string with_commas(std::size_t number) {
    std::string text = std::to_string(number);
    for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, 1, ',');
    return text;
}

}  // namespace

fs::path find_patch(const std::string& name) { return find_bundled(name, "patch", "patches"); }

fs::path find_task(const std::string& name) { return find_bundled(name, "task", "tasks"); }

fs::path find_experiment(const std::string& name) { return find_bundled(name, "experiment", "experiments"); }

fs::path find_sweep(const std::string& name) { return find_bundled(name, "sweep", "sweeps"); }

fs::path find_observer_model(const std::string& name) {
    return find_bundled(name, "model of subjects", "experiments/models");
}

fs::path find_display(const std::string& name) {
    // The folder was called rigs before: paths into it, and own libraries that have it, still work.
    const fs::path path(name), folder = path.parent_path();
    if (!fs::exists(path) && folder.filename() == "rigs")
        if (const fs::path renamed = folder.parent_path() / "displays" / path.filename(); fs::exists(renamed))
            return renamed;
    const fs::path old = library_folder() / "rigs" / (name + ".toml");
    if (!fs::exists(path) && !fs::exists(library_folder() / "displays" / (name + ".toml")) && fs::exists(old))
        return old;
    return find_bundled(name, "display", "displays");
}

std::optional<compile::Schedule> plan_of(patch::Patch patch, const patch::PatchOverrides& overrides,
                                         std::optional<std::uint64_t> seed, compile::AssetCache* assets,
                                         patch::Problems& problems) {
    patch::read_parts(patch);
    patch::apply_overrides(patch, overrides, problems);
    if (seed) patch.seed = *seed;
    // After syntax errors, errors of the compiler would mostly be consequences.
    if (!problems.empty()) return std::nullopt;
    std::optional<compile::Schedule> plan = compile::compile(std::move(patch), nodes::catalogue(), problems);
    if (plan && assets) assets->load(*plan, problems);
    if (plan && problems.empty()) check_saw(*plan, problems);
    return plan;
}

fs::path file_of(const PatchChoice& choice) { return choice.text ? fs::path(choice.patch) : find_patch(choice.patch); }

patch::Patch read_choice(const PatchChoice& choice, patch::Problems& problems) {
    if (choice.text) return patch::read_patch(*choice.text, choice.patch, problems);
    return patch::load_patch(find_patch(choice.patch), problems);
}

std::optional<compile::Schedule> read_plan(const PatchChoice& choice, patch::Problems& problems) {
    return plan_of(read_choice(choice, problems), choice.overrides, choice.seed, nullptr, problems);
}

compile::Schedule load_plan(const PatchChoice& choice, compile::AssetCache& assets) {
    patch::Problems problems;
    std::optional<compile::Schedule> plan =
        plan_of(read_choice(choice, problems), choice.overrides, choice.seed, &assets, problems);
    throw_problems(problems);
    return std::move(*plan);
}

std::vector<std::string> problem_lines(const patch::Problems& problems) {
    constexpr std::size_t max_shown = 20;
    std::vector<std::string> lines;
    for (const Error& error : problems.list | std::views::take(max_shown)) lines.emplace_back(error.what());
    if (const std::size_t all = problems.list.size(); all > max_shown)
        lines.push_back(
            fmt::format("… and {} more error{}", with_commas(all - max_shown), all - max_shown == 1 ? "" : "s"));
    return lines;
}

void throw_problems(const patch::Problems& problems) {
    if (problems.empty()) return;
    const std::vector<std::string> lines = problem_lines(problems);
    for (std::size_t i = 0; i + 1 < lines.size(); ++i) fmt::print(stderr, "tactus: {}\n", lines[i]);
    if (lines.size() == problems.list.size()) throw problems.list.back();
    throw Error(lines.back());
}

std::unique_ptr<take::TakeWriter> make_take(const PatchChoice& choice, const fs::path& folder, double seconds,
                                            bool live) {
    take::TakeAbout about{file_of(choice), choice.overrides, choice.seed, seconds, live};
    // Absolute paths, because a take may be replayed from any folder.
    for (std::string& asset : about.overrides.assets)
        if (const auto equals = asset.find('='); equals != std::string::npos)
            asset = asset.substr(0, equals + 1) + fs::absolute(asset.substr(equals + 1)).string();
    return std::make_unique<take::TakeWriter>(folder, std::move(about));
}

void make_output_folder(const fs::path& folder) {
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure) throw Error(fmt::format("{}: cannot make the folder: {}", folder.string(), failure.message()));
    const fs::path probe = folder / fmt::format(".write-{}.part", ::getpid());
    std::FILE* file = std::fopen(probe.c_str(), "w");
    if (!file) throw Error(fmt::format("{}: the folder is not writable", folder.string()));
    std::fclose(file);
    fs::remove(probe, failure);
}

}  // namespace tactus::run
