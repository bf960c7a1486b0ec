// SPDX-License-Identifier: Apache-2.0
// Shell completion of verbs, options and option values; otherwise of files.
#include "tools/command/manual.hpp"
#include "tools/run/shell_word.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tactus::command {

namespace {

std::vector<std::string> verbs_in(const VerbPage& page) {
    std::vector<std::string> names;
    for (const VerbPage& verb : page.verbs) names.push_back(verb.name);
    return names;
}

std::vector<std::string> options_in(const VerbPage& page) {
    std::vector<std::string> names;
    for (const OptionPage& option : page.options)
        if (!option.is_positional) names.insert(names.end(), option.names.begin(), option.names.end());
    return names;
}

/// Quotes a text for fish.
std::string quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) {
        if (c == '\'' || c == '\\') out += '\\';
        out += c;
    }
    return out + "'";
}

/// Entries for the `case` of completion words, such as "plan move" (no verb: ""), and for option values.
void add_bash(std::string& cases, std::string& values, const std::string& words, const VerbPage& page) {
    cases += fmt::format("        '{}') words='{} {}' ;;\n", words, fmt::join(verbs_in(page), " "),
                         fmt::join(options_in(page), " "));
    for (const OptionPage& option : page.options)
        if (!option.choices.empty())
            for (const std::string& name : option.names)
                if (name.starts_with('-'))
                    values +=
                        fmt::format("        '{} {}') words='{}' ;;\n", words, name, fmt::join(option.choices, " "));
    for (const VerbPage& verb : page.verbs)
        add_bash(cases, values, words.empty() ? verb.name : words + " " + verb.name, verb);
}

/// Entries of a zsh `case` for the values of options: "'plan snap --mode') values=(extended global) ;;".
void add_zsh_values(std::string& cases, const std::string& words, const VerbPage& page) {
    for (const OptionPage& option : page.options)
        if (!option.choices.empty())
            for (const std::string& name : option.names)
                if (name.starts_with('-'))
                    cases +=
                        fmt::format("        ('{} {}') values=({}) ;;\n", words, name, fmt::join(option.choices, " "));
    for (const VerbPage& verb : page.verbs)
        add_zsh_values(cases, words.empty() ? verb.name : words + " " + verb.name, verb);
}

/// The program's own options that take a value, as a pattern of a `case`; the value is not a verb.
std::string valued_options(const VerbPage& program) {
    std::vector<std::string> names{"''"};  // never empty
    for (const OptionPage& option : program.options)
        if (!option.value.empty()) names.insert(names.end(), option.names.begin(), option.names.end());
    return fmt::format("{}", fmt::join(names, "|"));
}

/// Patterns of a `case` for the verbs typed so far.
std::string groups_of(const VerbPage& page) {
    std::vector<std::string> groups;
    for (const VerbPage& verb : page.verbs)
        if (!verb.verbs.empty()) groups.push_back(verb.name);
    return fmt::format("{}", fmt::join(groups, "|"));
}

void add_zsh(std::string& cases, const std::string& words, const VerbPage& page) {
    cases += fmt::format("        {})\n            said=(", run::shell_word(words));
    const auto add = [&](std::string name, const std::string& about) {
        for (std::size_t at = 0; (at = name.find(':', at)) != std::string::npos; at += 2) name.replace(at, 1, "\\:");
        cases += "\n                " + run::shell_word(name + ":" + about);
    };
    for (const VerbPage& verb : page.verbs) add(verb.name, verb.about);
    for (const OptionPage& option : page.options)
        if (!option.is_positional)
            for (const std::string& name : option.names) add(name, option.about);
    cases += "\n            ) ;;\n";
    for (const VerbPage& verb : page.verbs) add_zsh(cases, words.empty() ? verb.name : words + " " + verb.name, verb);
}

void add_fish(std::string& out, const std::string& condition, const VerbPage& page, const std::string& program) {
    for (const VerbPage& verb : page.verbs)
        out += fmt::format("complete -c {} -n {} -f -a {} -d {}\n", program, quoted(condition), verb.name,
                           quoted(verb.about));
    for (const OptionPage& option : page.options) {
        if (option.is_positional) continue;
        out += fmt::format("complete -c {} -n {}", program, quoted(condition));
        for (const std::string& name : option.names)
            out += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
        if (!option.choices.empty())
            out += fmt::format(" -x -a {}", quoted(fmt::format("{}", fmt::join(option.choices, " "))));
        else if (option.is_file) out += " -r";
        else if (!option.value.empty()) out += " -x";
        out += " -d " + quoted(option.about) + "\n";
    }
}

}  // namespace

std::string bash_completion(const VerbPage& program) {
    std::string cases, values;
    add_bash(cases, values, "", program);
    return fmt::format(R"(# bash completion of {0}; written by '{0} generate bash'
_{0}() {{
    local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} verb= words= i
    for ((i = 1; i < COMP_CWORD; ++i)); do
        case ${{COMP_WORDS[i]}} in
        {4}) ((++i)); continue ;;
        -*) continue ;;
        esac
        case $verb in
        '') verb=${{COMP_WORDS[i]}} ;;
        {1}) verb="$verb ${{COMP_WORDS[i]}}" ;;
        *) break ;;
        esac
    done
    case "$verb $before" in
{3}    esac
    if [[ -z $words ]]; then
        case $verb in
{2}        esac
    fi
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
}}
complete -o default -F _{0} {0}
)",
                       program.name, groups_of(program), cases, values, valued_options(program));
}

std::string zsh_completion(const VerbPage& program) {
    std::string cases, values;
    add_zsh(cases, "", program);
    add_zsh_values(values, "", program);
    return fmt::format(R"(#compdef {0}
# zsh completion of {0}; written by '{0} generate zsh'
_{0}() {{
    local verb='' i
    local -a said values
    for ((i = 2; i < CURRENT; ++i)); do
        case $words[i] in
        ({3}) ((++i)); continue ;;
        (-*) continue ;;
        esac
        case $verb in
        ('') verb=$words[i] ;;
        ({1}) verb="$verb $words[i]" ;;
        (*) break ;;
        esac
    done
    case "$verb $words[CURRENT-1]" in
{4}    esac
    if (( $#values )); then
        compadd -a values
        return
    fi
    case $verb in
{2}    esac
    _describe '{0}' said || _files
}}
_{0} "$@"
)",
                       program.name, groups_of(program), cases, valued_options(program), values);
}

std::string fish_completion(const VerbPage& program) {
    std::string out = fmt::format("# fish completion of {0}; written by '{0} generate fish'\n", program.name);
    add_fish(out, "__fish_use_subcommand", program, program.name);
    for (const VerbPage& verb : program.verbs) {
        const std::string here = "__fish_seen_subcommand_from " + verb.name;
        if (verb.verbs.empty()) {
            // Verbs of a group are separate: "plan snap" is not "snap".
            std::string others;
            for (const VerbPage& group : program.verbs)
                if (!group.verbs.empty()) others += "; and not __fish_seen_subcommand_from " + group.name;
            add_fish(out, here + others, verb, program.name);
            continue;
        }
        const std::string none = fmt::format("{}", fmt::join(verbs_in(verb), " "));
        add_fish(out, here + "; and not __fish_seen_subcommand_from " + none, verb, program.name);
        for (const VerbPage& inner : verb.verbs)
            add_fish(out, here + "; and __fish_seen_subcommand_from " + inner.name, inner, program.name);
    }
    return out;
}

}  // namespace tactus::command
