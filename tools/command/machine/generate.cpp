// SPDX-License-Identifier: Apache-2.0
// tactus generate (hidden): writes manual pages and shell completions, for packages, and JSON Schemas.
#include "assets/file/whole_file.hpp"
#include "tools/command/catalogue.hpp"
#include "tools/command/manual.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/report/vibration/orders_result.hpp"

#include <filesystem>
#include <memory>

namespace tactus::command {

namespace {

struct GenerateChoice {
    std::string what;
    std::filesystem::path folder;
};

int generate(const GenerateChoice& choice) {
    const VerbPage pages = pages_of(tactus_program());
    std::filesystem::create_directories(choice.folder);
    if (choice.what == "schema") {
        file::write_whole_file(
            choice.folder / "orders.schema.json",
            report::schema_of_output("tactus orders --json", report::orders_fields().schema()).dump(2) + "\n");
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
