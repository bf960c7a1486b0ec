// SPDX-License-Identifier: Apache-2.0
// tactus plan new: makes a plan from files.
#include "assets/bone/labels.hpp"
#include "assets/file/extension.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/plan/plan_case.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/command/progress.hpp"
#include "tools/counted.hpp"

#include <fmt/format.h>

namespace tactus::command {

namespace {

namespace fs = std::filesystem;

struct NewChoice : PlanChoice {
    std::string title;
};

/// Throws Error when the last fragment is the same bone as an earlier one.
void check_is_new(const plan::CasePlan& plan) {
    const plan::PlanFragment& last = plan.fragments.back();
    const auto bone_in = [](const std::string& file) {
        return bone::file_of_bone(file) == file ? std::string() : file.substr(file.rfind('#') + 1);
    };
    for (const plan::PlanFragment& other : plan.fragments)
        if (&other != &last && other.hash == last.hash && bone_in(other.file) == bone_in(last.file))
            throw Error(fmt::format("{}: is the same bone as fragment '{}'; name each fragment's file once", last.file,
                                    other.name));
}

/// Throws Error when a fragment is an earlier one in another file.
void check_are_different(const plan::CasePlan& plan, const std::vector<analysis::CaseFragment>& loaded) {
    for (std::size_t m = 1; m < loaded.size(); ++m)
        for (std::size_t n = 0; n < m; ++n)
            if (fit::are_one_bone(analysis::placed_bone(loaded[m], {}), analysis::placed_bone(loaded[n], {})))
                throw Error(
                    fmt::format("{}: has the shape and the place of fragment '{}', as the same bone in another "
                                "file; name each bone once",
                                plan.fragments[m].file, plan.fragments[n].name));
}

/// "NAME=FILE" or "FILE"; the default name is the stem of the file, or the name of the bone in it.
void add_file_of(plan::CasePlan& plan, const std::string& text, const fs::path& folder) {
    const auto equals = text.find('=');
    const bool is_named = equals != std::string::npos && !fs::exists(text);
    const std::string name = is_named ? text.substr(0, equals) : "";
    const fs::path file = is_named ? text.substr(equals + 1) : text;
    std::vector<std::pair<std::string, fs::path>> found;
    if (bone::file_of_bone(file) == file && file::extension_of(file) == ".vdb") {
        const auto bones = bone::load_bones(file);
        if (bones.size() > 1 && is_named)
            throw Error(fmt::format("{}: there are {} bones; choose one, as in {}={}#{}", file.string(), bones.size(),
                                    name, file.string(), bones.front().name));
        for (const bone::Bone& bone : bones)
            found.emplace_back(bones.size() > 1 ? bone.name : file.stem().string(),
                               bones.size() > 1 ? fs::path(file.string() + "#" + bone.name) : file);
    } else {
        const std::string whole = file.string();
        const auto mark = whole.rfind('#');
        const bool is_one_of = bone::file_of_bone(file) != file && mark != std::string::npos;
        found.emplace_back(is_one_of ? whole.substr(mark + 1) : file.stem().string(), file);
    }
    for (auto& [own, path] : found) {
        plan::add_fragment(plan, is_named ? name : own, path, folder,
                           bone::label_colour(static_cast<int>(plan.fragments.size()) + 1));
        check_is_new(plan);
    }
}

int make_plan(const NewChoice& choice) {
    if (fs::exists(choice.plan))
        throw Error(fmt::format("{}: the file exists already; a plan is never overwritten", choice.plan.string()));
    const plan::PlanLock lock(choice.plan);
    plan::CasePlan plan;
    plan.title = choice.title.empty() ? choice.plan.stem().stem().string() : choice.title;
    const fs::path folder = choice.plan.parent_path();
    for (const std::string& name : choice.names) add_file_of(plan, name, folder);
    Progress progress;
    progress.show(0.0, "loading");
    // Loads every file now, so that wrong units, open surfaces and damaged files are reported before the session.
    const auto loaded = analysis::load_each(plan.fragments, folder, plan::Paint::as_filed, [&](std::size_t count) {
        progress.show(static_cast<double>(count) / static_cast<double>(plan.fragments.size()), "loading");
    });
    check_are_different(plan, loaded);
    progress.clear();
    plan::save_case_plan(plan, choice.plan);
    if (!choice.result.json) fmt::print("{}: {}\n", choice.plan.string(), counted(plan.fragments.size(), "fragment"));
    return show_change(choice);
}

Action declare_plan_new(VerbOptions& verb) {
    const auto choice = std::make_shared<NewChoice>();
    verb.output("plan", choice->plan, {{".json"}}, "plan file, JSON").required();
    verb.flag("--json", choice->result.json, "as JSON");
    verb.add("files", choice->names, "bone files or closed meshes, FILE or NAME=FILE").required();
    verb.add("--title", choice->title, "title of the case");
    return [choice] { return make_plan(*choice); };
}

}  // namespace

Verb plan_new_verb() { return {"new", "make a plan of fragments at their scanned poses", declare_plan_new}; }

}  // namespace tactus::command
