// SPDX-License-Identifier: Apache-2.0
#include "assets/file/room.hpp"
#include "graph/plugin/plugins.hpp"
#include "nodes/catalogue.hpp"
#include "tools/command/declare.hpp"
#include "tools/command/written_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <system_error>

namespace tactus::command {

namespace {

/// Replaces old spellings after the verb by the current ones.
void modernise(const OldSpellings& old, std::vector<std::string>& words) {
    if (old.rewrite) old.rewrite(words);
    for (std::string& word : words)
        for (const auto& [before, now] : old.renamed)
            if (word == before) word = now;
            else if (word.starts_with(before + "=")) word = now + word.substr(before.size());
}

/// Moves --nodes, an option of the program, in front of the verb: users write it where they write the patch.
void bring_forward_nodes(std::vector<std::string>& words) {
    std::vector<std::string> before, after;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const bool is_nodes = words[i] == "--nodes" || words[i].starts_with("--nodes=");
        (is_nodes ? before : after).push_back(words[i]);
        if (words[i] == "--nodes" && i + 1 < words.size()) before.push_back(words[++i]);
    }
    words = std::move(before);
    words.insert(words.end(), after.begin(), after.end());
}

/// Index of the verb: the first word after the program's own options.
std::size_t place_of_verb(const CLI::App& app, const std::vector<std::string>& words) {
    std::size_t place = 0;
    for (; place < words.size() && words[place].starts_with('-'); ++place)
        if (const CLI::Option* option = app.get_option_no_throw(words[place]))
            place += static_cast<std::size_t>(option->get_items_expected_min());
    return std::min(place, words.size());
}

/// The verb with this name; an old name is replaced by the current one in `word`. Null: none.
const Verb* verb_of(const Verbs& verbs, std::string& word) {
    for (const Verb& verb : verbs)
        if (word == verb.name || (verb.old_name && word == verb.old_name)) {
            word = verb.name;
            return &verb;
        }
    return nullptr;
}

/// The given verb, also within a group.
const CLI::App* given_verb(const CLI::App& app) {
    const auto below = app.get_subcommands();
    return below.empty() ? &app : given_verb(*below.front());
}

/// "plan report": the verb with its group.
std::string full_name_of(const CLI::App& verb, const CLI::App& program) {
    const CLI::App* parent = verb.get_parent();
    return parent == &program || !parent ? verb.get_name() : full_name_of(*parent, program) + " " + verb.get_name();
}

/// Reports a failed system call; returns the exit code.
int failed_call(const std::system_error& error) {
    say(stderr, fmt::format("tactus: {}\n", error.what()));
    for (const std::errc full :
         {std::errc::no_space_on_device, std::errc::io_error, std::errc::not_enough_memory, std::errc::no_such_device,
          std::errc::read_only_file_system, std::errc::resource_unavailable_try_again})
        if (error.code() == full) return machine_failed;
    return bad_input;
}

/// Arguments to forward when the verb is another program; they are removed from `words`.
std::vector<std::string> words_handed_on(const Program& program, const CLI::App& app, const DeclaredVerbs& declared,
                                         std::vector<std::string>& words) {
    std::size_t place = place_of_verb(app, words);
    const CLI::App* part = &app;
    for (const Verbs* verbs = &program.verbs; verbs && place < words.size(); ++place) {
        const Verb* verb = verb_of(*verbs, words[place]);
        if (!verb) return {};
        const auto behind = words.begin() + static_cast<std::ptrdiff_t>(place) + 1;
        if (verb->forward) {
            std::vector<std::string> handed_on(behind, words.end());
            words.erase(behind, words.end());
            return handed_on;
        }
        part = part->get_subcommand(verb->name);
        std::vector<std::string> typed(behind, words.end());
        modernise(declared.at(part).old, typed);
        words.erase(behind, words.end());
        words.insert(words.end(), typed.begin(), typed.end());
        verbs = verb->verbs ? &verb->verbs() : nullptr;
    }
    return {};
}

}  // namespace

int command_line(const Program& program, int argc, char** argv) {
    CLI::App app{program.about, program.name};
    DeclaredVerbs declared;
    try {
        if (argc <= 1 && program.first_steps) {
            say(stdout, program.first_steps);
            return done;
        }
        declare(app, program, declared);
        std::vector<std::string> words(argv + 1, argv + std::max(argc, 1));
        bring_forward_nodes(words);
        const std::vector<std::string> handed_on = words_handed_on(program, app, declared, words);
        app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
        const CLI::App* given = given_verb(app);
        const DeclaredVerb& chosen = declared.at(given);
        check_written(*given, full_name_of(*given, app), declared);
        if (plugin::are_given()) nodes::catalogue();  // an error of them is one of the command line
        return chosen.verb->forward ? chosen.verb->forward(handed_on) : chosen.run();
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? done : bad_input;
    } catch (const file::NoRoom& error) {
        say(stderr, fmt::format("tactus: {}\n", error.what()));
        return machine_failed;
    } catch (const std::bad_alloc&) {
        say(stderr, "tactus: not enough memory\n");
        return machine_failed;
    } catch (const std::system_error& error) {
        return failed_call(error);
    } catch (const std::exception& error) {
        say(stderr, fmt::format("tactus: {}\n", error.what()));
    }
    return bad_input;
}

}  // namespace tactus::command
