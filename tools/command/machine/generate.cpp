// SPDX-License-Identifier: Apache-2.0
// tactus generate (hidden): writes manual pages and shell completions, for packages, and JSON Schemas.
#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "tools/command/catalogue.hpp"
#include "tools/command/manual.hpp"
#include "tools/exit_code.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

namespace tactus::command {

namespace {

struct GenerateChoice {
    std::string what;
    std::filesystem::path folder;
};

/// A file for each verb that has one: orders.schema.json, plan-check.schema.json.
void write_schemas(const Verbs& verbs, const std::string& group, const std::filesystem::path& folder) {
    for (const Verb& verb : verbs) {
        const std::string name = group + verb.name;
        if (verb.verbs) write_schemas(verb.verbs(), name + " ", folder);
        if (!verb.schema) continue;
        file::Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                          {"title", fmt::format("tactus {} --json", name)}};
        schema.update(verb.schema());
        std::string file = name;
        std::ranges::replace(file, ' ', '-');
        file::write_whole_file(folder / (file + ".schema.json"), schema.dump(2) + "\n");
    }
}

int generate(const GenerateChoice& choice) {
    const VerbPage pages = pages_of(tactus_program());
    std::filesystem::create_directories(choice.folder);
    if (choice.what == "schema") {
        write_schemas(all_verbs(), "", choice.folder);
        return done;
    }
    if (choice.what == "man")
        for (const auto& [name, text] : man_pages(pages)) file::write_whole_file(choice.folder / name, text);
    else if (choice.what == "bash") file::write_whole_file(choice.folder / "tactus.bash", bash_completion(pages));
    else if (choice.what == "zsh") file::write_whole_file(choice.folder / "_tactus", zsh_completion(pages));
    else file::write_whole_file(choice.folder / "tactus.fish", fish_completion(pages));
    return done;
}

Action declare_generate(VerbOptions& verb) {
    const auto choice = std::make_shared<GenerateChoice>();
    verb.add("what", choice->what, "what to write").required().one_of({"man", "bash", "zsh", "fish", "schema"});
    verb.add("folder", choice->folder, "output folder; made if missing").required();
    return [choice] { return generate(*choice); };
}

}  // namespace

Verb generate_verb() {
    return {.name = "generate",
            .about = "write manual pages, the completion of a shell, or JSON Schemas of outputs",
            .add = declare_generate,
            .is_hidden = true};
}

}  // namespace tactus::command
