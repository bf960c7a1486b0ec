// SPDX-License-Identifier: Apache-2.0
// tactus new: a patch of one's own from one that comes with Tactus.
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "graph/edit/patch_paths.hpp"
#include "tools/command/options.hpp"
#include "tools/exit_code.hpp"
#include "tools/run/load_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tactus::command {

namespace {

namespace fs = std::filesystem;

struct NewChoice {
    fs::path patch;
    std::string from;
};

/// Folders of the library that hold examples: the gallery, and the patches that have a name on the command line.
constexpr const char* folders[] = {"examples", "patches"};

std::vector<std::string> example_names() {
    std::vector<std::string> names;
    for (const char* folder : folders) {
        const auto begin = static_cast<std::ptrdiff_t>(names.size());
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(run::library_folder() / folder, ignored))
            if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
        std::sort(names.begin() + begin, names.end());
    }
    return names;
}

fs::path find_example(const std::string& name) {
    for (const char* folder : folders)
        if (const fs::path file = run::library_folder() / folder / (name + ".toml"); fs::exists(file)) return file;
    const std::vector<std::string> names = example_names();
    throw Error(names.empty()
                    ? fmt::format("the library {} has no examples; build first", run::library_folder().string())
                    : fmt::format("--from: no example '{}'{}; there are {}", name, did_you_mean(name, names),
                                  fmt::join(names, ", ")));
}

int make_new(const NewChoice& choice) {
    const fs::path example = find_example(choice.from);
    fs::path file = choice.patch;
    if (file.filename().empty() || file.filename() == ".toml") throw Error("the new patch needs a name");
    if (file.extension() != ".toml") file += ".toml";
    if (fs::exists(fs::symlink_status(file)))
        throw Error(fmt::format("{}: the file exists already; a patch is never overwritten", file.string()));
    if (const fs::path folder = file.parent_path(); !folder.empty() && !fs::is_directory(folder))
        throw Error(fmt::format("{}: there is no such folder", folder.string()));
    const fs::path from = fs::absolute(example).lexically_normal().parent_path();
    file::write_whole_file(file, edit::with_absolute_paths(file::read_whole_file(example), from));
    fmt::print("{0}: a copy of {1}; try: tactus render {0} --seconds 2\n", file.string(), choice.from);
    return done;
}

Action declare_new(VerbOptions& verb) {
    const auto choice = std::make_shared<NewChoice>();
    verb.add("name", choice->patch, "file of the new patch; '.toml' may be left out").required();
    Option from =
        verb.add("--from", choice->from, "a small patch of the gallery, or a patch of the library").required();
    // The list is for help and completion; a slip gets a message of its own.
    if (const std::vector<std::string> names = example_names(); !names.empty())
        from.value_name(fmt::format("{{{}}}", fmt::join(names, ",")));
    return [choice] { return make_new(*choice); };
}

}  // namespace

Verb new_verb() { return {"new", "make a patch from an example", declare_new}; }

}  // namespace tactus::command
