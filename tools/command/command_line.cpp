// SPDX-License-Identifier: Apache-2.0
#include "assets/file/room.hpp"
#include "tools/command/options.hpp"
#include "tools/exit_code.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <map>
#include <new>

namespace tactus::command {

namespace {

/// A verb in the command line: what runs with it, and what is handed on.
struct Known {
    const Verb* verb;
    Action run;
};
using KnownVerbs = std::map<const CLI::App*, Known>;

void add_verbs(CLI::App& app, const Verbs& verbs, KnownVerbs& known) {
    app.require_subcommand(1);
    for (const Verb& verb : verbs) {
        CLI::App* part = app.add_subcommand(verb.name, verb.about);
        if (verb.verbs) add_verbs(*part, verb.verbs(), known);
        VerbOptions options(*part);
        known[part] = {&verb, verb.add ? verb.add(options) : Action()};
    }
}

/// The verb that was given, also within a group.
const CLI::App* given_verb(const CLI::App& app) {
    const auto below = app.get_subcommands();
    return below.empty() ? &app : given_verb(*below.front());
}

/// Where the verb stands: the first word behind the options of the program itself.
int place_of_verb(const CLI::App& app, int argc, char** argv) {
    int place = 1;
    for (; place < argc && argv[place][0] == '-'; ++place) {
        const std::string word = argv[place];
        const CLI::Option* option = app.get_option_no_throw(word);
        if (option) place += option->get_items_expected_min();
    }
    return place;
}

}  // namespace

int command_line(const Program& program, int argc, char** argv) {
    CLI::App app{program.about, program.name};
    app.add_option_function<std::string>(
           "--memory", [](const std::string& size) { file::set_memory_limit(file::parse_memory_size(size)); },
           "most memory that one file may take, as in \"2 GB\" (default: half of the machine's)")
        ->trigger_on_parse();
    KnownVerbs known;
    try {
        add_verbs(app, program.verbs, known);
        // What another program is given is not ours to read.
        std::vector<std::string> handed_on;
        const int place = place_of_verb(app, argc, argv);
        for (const Verb& verb : program.verbs)
            if (verb.forward && place < argc && argv[place] == std::string(verb.name)) {
                handed_on.assign(argv + place + 1, argv + argc);
                argc = place + 1;
            }
        app.parse(argc, argv);
        const Known& chosen = known.at(given_verb(app));
        return chosen.verb->forward ? chosen.verb->forward(handed_on) : chosen.run();
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? done : bad_input;
    } catch (const file::NoRoom& error) {
        say(stderr, fmt::format("tactus: {}\n", error.what()));
        return machine_failed;
    } catch (const std::bad_alloc&) {
        say(stderr, "tactus: not enough memory\n");
        return machine_failed;
    } catch (const std::exception& error) {
        say(stderr, fmt::format("tactus: {}\n", error.what()));
    }
    return bad_input;
}

}  // namespace tactus::command
