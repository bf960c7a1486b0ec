// SPDX-License-Identifier: Apache-2.0
#include "tools/command/manual.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace tactus::command {

namespace {

/// Escapes text for troff: a dash is a hyphen there, and a line that begins with a dot or an apostrophe is a request.
std::string troff(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) out += "\\&";
        if (c == '\\') out += "\\e";
        else if (c == '-') out += "\\-";
        else out += c;
        if (c == ',') out += "\\:";  // a long list of values breaks here, without a hyphen
    }
    return out;
}

std::string dashed(std::string words) {
    std::ranges::replace(words, ' ', '-');
    return words;
}

std::string option_text(const OptionPage& option) {
    std::string text = ".TP\n";
    for (std::size_t i = 0; i < option.names.size(); ++i)
        text += fmt::format("{}\\fB{}\\fR", i == 0 ? "" : ", ", troff(option.names[i]));
    if (!option.value.empty()) text += fmt::format(" \\fI{}\\fR", troff(option.value));
    if (option.is_required) text += " (required)";
    text += "\n" + troff(option.about);
    if (!option.shown_default.empty())
        text += fmt::format("{}(default: {})", option.about.empty() ? "" : " ", troff(option.shown_default));
    return text + "\n";
}

void add_options(std::string& text, const VerbPage& page, bool positional, const char* title) {
    std::string options;
    for (const OptionPage& option : page.options)
        if (option.is_positional == positional) options += option_text(option);
    if (!options.empty()) text += fmt::format(".SH {}\n{}", title, options);
}

std::string page_text(const std::string& words, const VerbPage& page) {
    std::string text = fmt::format(".TH {} 1\n.ad l\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n\\fB{}\\fR [OPTIONS]",
                                   dashed(words), troff(dashed(words)), troff(page.about), troff(words));
    for (const OptionPage& option : page.options)
        if (option.is_positional)
            text += option.is_required ? " " + troff(option.names.front()) : " [" + troff(option.names.front()) + "]";
    text += page.verbs.empty() ? "\n" : " VERB\n";
    add_options(text, page, true, "ARGUMENTS");
    add_options(text, page, false, "OPTIONS");
    std::string job;
    for (const VerbPage& verb : page.verbs) {
        if (verb.job != job) text += fmt::format(".SH {}\n", verb.job == "Subcommands" ? "VERBS" : troff(verb.job));
        job = verb.job;
        text += fmt::format(".TP\n\\fB{}\\fR\n{}\n", troff(words + " " + verb.name), troff(verb.about));
    }
    return text +
           ".SH EXIT STATUS\n0: done, or the answer is yes; 1: the answer is no; 2: usage or input; 3: disk, memory, a "
           "lost device or a fault that was not recovered.\n";
}

void add_pages(std::vector<std::pair<std::string, std::string>>& pages, const std::string& words,
               const VerbPage& page) {
    pages.emplace_back(dashed(words) + ".1", page_text(words, page));
    for (const VerbPage& verb : page.verbs) add_pages(pages, words + " " + verb.name, verb);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> man_pages(const VerbPage& program) {
    std::vector<std::pair<std::string, std::string>> pages;
    add_pages(pages, program.name, program);
    return pages;
}

}  // namespace tactus::command
