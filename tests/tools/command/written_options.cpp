// SPDX-License-Identifier: Apache-2.0
// No verb overwrites its input.
#include "tools/command/written_options.hpp"

#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/command/catalogue.hpp"
#include "tools/command/declare.hpp"

#include <CLI/CLI.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

using namespace tactus;
using command::is_written;
using Catch::Matchers::ContainsSubstring;
namespace fs = std::filesystem;
using test::Folder;
using test::slurp;

namespace {

/// Runs the command line in this process; returns the exit code and what was written on standard error.
std::pair<int, std::string> run_here(std::vector<std::string> words, const fs::path& errors) {
    std::fflush(stderr);
    const int before = ::dup(STDERR_FILENO), file = ::open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::dup2(file, STDERR_FILENO);
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    const int code =
        command::command_line(command::tactus_program(), static_cast<int>(pointers.size()), pointers.data());
    std::fflush(stderr);
    ::dup2(before, STDERR_FILENO);
    ::close(before);
    ::close(file);
    return {code, slurp(errors)};
}

std::string name_of(const CLI::Option& option) {
    if (option.get_positional()) return "";
    return option.get_lnames().empty() ? "-" + option.get_snames().front() : "--" + option.get_lnames().front();
}

bool is_text(const CLI::Option& option) { return option.get_type_size() != 0 && option.get_type_name() == "TEXT"; }

bool excludes(const CLI::Option& one, const CLI::Option& other) {
    return std::ranges::any_of(one.get_excludes(), [&](const CLI::Option* excluded) { return excluded == &other; });
}

void give(std::vector<std::string>& words, const CLI::Option& option, const std::string& text) {
    const std::string type = option.get_type_name();
    const std::size_t open = type.find('{');
    const std::string first =
        open == std::string::npos ? "2" : type.substr(open + 1, type.find_first_of(",}", open) - open - 1);
    const std::string value = is_text(option) ? text : first;
    if (!option.get_positional()) words.push_back(name_of(option));
    if (option.get_type_size() == 0) return;
    for (int n = 0; n < std::max(option.get_items_expected_min(), 1); ++n) words.push_back(value);
}

/// Tries each input of the verb as each of its outputs; all verbs below.
void walk(const CLI::App& app, const std::string& name, const Folder& folder, std::set<std::string>& tried) {
    for (const CLI::App* verb : app.get_subcommands(nullptr))
        walk(*verb, name.empty() ? verb->get_name() : name + " " + verb->get_name(), folder, tried);
    for (const CLI::Option* output : app.get_options()) {
        if (!is_written(name, *output)) continue;
        bool is_refused = false, has_input = false;
        for (const CLI::Option* input : app.get_options()) {
            if (is_written(name, *input) || !is_text(*input) || excludes(*input, *output) || excludes(*output, *input))
                continue;
            const fs::path file = folder.write("precious.csv", "scan of a patient");
            std::vector<std::string> words{"tactus"};
            for (std::size_t at = 0; at < name.size();) {
                const std::size_t end = std::min(name.find(' ', at), name.size());
                words.push_back(name.substr(at, end - at));
                at = end + 1;
            }
            std::set<const CLI::Option*> given;
            for (const CLI::Option* one : app.get_options())
                if (one == input || one == output || one->get_required()) given.insert(one);
            for (const CLI::Option* one : std::set(given))
                for (const CLI::Option* needed : one->get_needs()) given.insert(needed);
            for (const CLI::Option* one : app.get_options())
                if (given.contains(one))
                    give(words, *one, one == input || one == output ? file.string() : (folder.path / "x").string());
            const auto [code, errors] = run_here(words, folder.path / "errors");
            CAPTURE(words, errors);
            has_input = true;
            CHECK(code == 2);
            CHECK(slurp(file) == "scan of a patient");
            is_refused = is_refused || errors.find("this is a source") != std::string::npos;
        }
        CAPTURE(name, name_of(*output));
        CHECK(is_refused == has_input);
        tried.insert(name + " " + name_of(*output));
    }
}

}  // namespace

TEST_CASE("no verb overwrites its input: each input as each output is refused, and stays as it was") {
    const Folder folder;
    CLI::App app{"", "tactus"};
    command::DeclaredVerbs declared;
    command::declare(app, command::tactus_program(), declared);
    std::set<std::string> tried;
    walk(app, "", folder, tried);
    for (const char* one : {"spectrum --csv", "spectrum --table", "spectrum --cepstrum", "spectrum --plot",
                            "exposure --table", "compare --table", "validate --table", "score --csv",
                            "fracture-surface --out", "import --out", "plan export --out", "plan report --pdf"}) {
        CAPTURE(one);
        CHECK(tried.contains(one));
    }
    // Each option in the list is one of a verb.
    for (const command::WrittenOption& one : command::written_options()) {
        CAPTURE(one.option);
        CHECK(std::ranges::any_of(tried, [&](const std::string& name) {
            return name.ends_with(" " + std::string(one.option)) && name.starts_with(one.verb);
        }));
    }
}

TEST_CASE("a file in a source folder, or named by a source, is not overwritten") {
    const Folder folder;
    fs::create_directory(folder.path / "logs");
    folder.write("logs/a.csv", "t,a\n0,1\n");
    folder.write("left.stl", "solid left");
    folder.write("fragment_01.vdb", "a bone");
    folder.write("case.plan.json", R"({"fragments": [{"file": "left.stl#1"}]})");
    folder.write("task.toml", "plan = 'case.plan.json'\n");
    const std::string at = folder.path.string() + "/";
    const auto refused = [&](const std::string& arguments, const fs::path& kept) {
        const std::string before = slurp(folder.path / kept);
        const test::Outcome outcome = folder.tactus(arguments);
        CAPTURE(arguments, outcome.err);
        CHECK(outcome.code == 2);
        CHECK_THAT(outcome.err, ContainsSubstring("source"));
        CHECK(slurp(folder.path / kept) == before);
    };
    refused("spectrum " + at + "logs --table " + at + "logs/a.csv", "logs/a.csv");
    refused("score " + at + "logs --task " + at + "task.toml --csv " + at + "left.stl", "left.stl");
    refused("plan export " + at + "case.plan.json -o " + at, "left.stl");
    refused("fracture " + at + "fragment_01.vdb --overwrite -o " + at, "fragment_01.vdb");
    fs::create_directory(folder.path / "old");
    folder.write("old/fragment_07.stl", "an earlier piece");
    const test::Outcome again = folder.tactus("fracture " + at + "left.stl -o " + at + "old");
    CHECK(again.code == 2);
    CHECK_THAT(again.err, ContainsSubstring("--overwrite"));
}
