// SPDX-License-Identifier: Apache-2.0
#include "tools/command/manual.hpp"

#include "tools/command/declare.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>

namespace tactus::command {

namespace {

/// The words between the braces of "TEXT:{hann,hamming}".
std::vector<std::string> choices_of(const std::string& value) {
    std::vector<std::string> choices;
    const std::size_t open = value.find('{'), close = value.find('}');
    if (open == std::string::npos || close == std::string::npos || close < open) return choices;
    for (std::size_t at = open + 1; at <= close;) {
        const std::size_t end = std::min(value.find(',', at), close);
        choices.push_back(value.substr(at, end - at));
        at = end + 1;
    }
    return choices;
}

OptionPage page_of(const CLI::Option& option) {
    OptionPage page;
    for (const std::string& name : option.get_snames()) page.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) page.names.push_back("--" + name);
    page.is_positional = option.get_positional();
    if (page.is_positional) page.names.push_back(option.get_name(true));
    if (option.get_type_size() != 0) page.value = option.get_type_name();
    page.shown_default = option.get_default_str();
    page.about = option.get_description();
    page.choices = choices_of(page.value);
    page.is_required = option.get_required();
    // A text without unit, range or choices may be a file.
    page.is_file = page.value == "TEXT";
    return page;
}

VerbPage page_of(const CLI::App& app) {
    VerbPage page{app.get_name(), app.get_description(), app.get_group(), {}, {}};
    for (const CLI::Option* option : app.get_options())
        if (!option->get_group().empty()) page.options.push_back(page_of(*option));
    for (const CLI::App* verb : app.get_subcommands(nullptr))
        if (!verb->get_group().empty()) page.verbs.push_back(page_of(*verb));
    return page;
}

}  // namespace

VerbPage pages_of(const Program& program) {
    CLI::App app{program.about, program.name};
    DeclaredVerbs declared;
    declare(app, program, declared);
    return page_of(app);
}

}  // namespace tactus::command
