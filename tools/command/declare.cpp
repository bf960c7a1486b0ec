// SPDX-License-Identifier: Apache-2.0
#include "tools/command/declare.hpp"

#include "assets/file/room.hpp"
#include "graph/plugin/plugins.hpp"

#include <CLI/CLI.hpp>

namespace tactus::command {

namespace {

void declare_verbs(CLI::App& app, const Verbs& verbs, DeclaredVerbs& declared) {
    app.require_subcommand(1);
    for (const Verb& verb : verbs) {
        CLI::App* part = app.add_subcommand(verb.name, verb.about);
        if (verb.is_hidden) part->group("");
        else if (*verb.job) part->group(verb.job);
        if (verb.verbs) declare_verbs(*part, verb.verbs(), declared);
        DeclaredVerb& one = declared[part];
        one.verb = &verb;
        VerbOptions options(*part, one.old, one.outputs);
        if (verb.add) one.run = verb.add(options);
    }
}

}  // namespace

void declare(CLI::App& app, const Program& program, DeclaredVerbs& declared) {
    app.set_version_flag("--version", version_text(program.name), "print version, build type and compiler");
    app.add_option_function<std::string>(
           "--memory", [](const std::string& size) { file::set_memory_limit(file::parse_memory_size(size)); },
           "memory limit for one file, such as \"2 GB\" (default: half of the machine's)")
        ->trigger_on_parse();
    app.add_option_function<std::vector<std::string>>(
           "--nodes",
           [](const std::vector<std::string>& paths) {
               for (const std::string& path : paths) plugin::use(path);
           },
           "a shared object with nodes of your own, or a folder of such; before or after the verb")
        ->trigger_on_parse()
        ->type_size(1)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->type_name("FILE|DIR");
    declare_verbs(app, program.verbs, declared);
}

}  // namespace tactus::command
