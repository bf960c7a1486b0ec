// SPDX-License-Identifier: Apache-2.0
// No verb overwrites its input, or writes a file whose ending promises another format.
#include "tools/command/written_options.hpp"

#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/command/catalogue.hpp"
#include "tools/command/declare.hpp"

#include <CLI/CLI.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <functional>
#include <set>
#include <utility>
#include <vector>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using command::DeclaredOutput;
using command::DeclaredVerbs;
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
    // The short name: 'validate --out NODE.PORT' is an old spelling of another option.
    if (!option.get_positional())
        words.push_back(option.get_snames().empty() ? name_of(option) : "-" + option.get_snames().front());
    if (option.get_type_size() == 0) return;
    for (int n = 0; n < std::max(option.get_items_expected_min(), 1); ++n) words.push_back(value);
}

const DeclaredOutput* output_of(const DeclaredVerbs& declared, const CLI::App& app, const CLI::Option& option) {
    const auto verb = declared.find(&app);
    if (verb == declared.end()) return nullptr;
    const auto found = std::ranges::find(verb->second.outputs, &option, &DeclaredOutput::option);
    return found == verb->second.outputs.end() ? nullptr : &*found;
}

/// The command line of a verb with these options and those that they need, each text `value(option)`.
std::vector<std::string> line_of(const CLI::App& app, const std::string& name, std::set<const CLI::Option*> given,
                                 const std::function<std::string(const CLI::Option&)>& value) {
    std::vector<std::string> words{"tactus"};
    for (std::size_t at = 0; at < name.size();) {
        const std::size_t end = std::min(name.find(' ', at), name.size());
        words.push_back(name.substr(at, end - at));
        at = end + 1;
    }
    for (const CLI::Option* one : app.get_options())
        if (one->get_required()) given.insert(one);
    for (const CLI::Option* one : std::set(given))
        for (const CLI::Option* needed : one->get_needs()) given.insert(needed);
    for (const CLI::Option* one : app.get_options())
        if (given.contains(one)) give(words, *one, value(*one));
    return words;
}

/// Calls `visit` for each verb, with its name.
void for_each_verb(const CLI::App& app, const std::string& name,
                   const std::function<void(const CLI::App&, const std::string&)>& visit) {
    visit(app, name);
    for (const CLI::App* verb : app.get_subcommands(nullptr))
        for_each_verb(*verb, name.empty() ? verb->get_name() : name + " " + verb->get_name(), visit);
}

/// The program's verbs as the command line declares them.
struct AllVerbs {
    CLI::App app{"", "tactus"};
    DeclaredVerbs declared;

    AllVerbs() { command::declare(app, command::tactus_program(), declared); }
    void each(const std::function<void(const CLI::App&, const std::string&)>& visit) const {
        for_each_verb(app, "", visit);
    }
};

}  // namespace

TEST_CASE("no verb overwrites its input: each input as each output is refused, and stays as it was") {
    const Folder folder;
    const AllVerbs verbs;
    std::set<std::string> tried;
    verbs.each([&](const CLI::App& app, const std::string& name) {
        for (const CLI::Option* output : app.get_options()) {
            const DeclaredOutput* const declared = output_of(verbs.declared, app, *output);
            if (!declared) continue;
            // With an ending that the output has: else this would be refused for its name.
            const std::string ending = declared->what.endings.empty() ? "" : declared->what.endings.front();
            bool is_refused = false, has_input = false;
            for (const CLI::Option* input : app.get_options()) {
                if (output_of(verbs.declared, app, *input) || !is_text(*input) || excludes(*input, *output) ||
                    excludes(*output, *input))
                    continue;
                const fs::path file = folder.write("precious" + ending, "scan of a patient");
                const auto words = line_of(app, name, {input, output}, [&](const CLI::Option& one) {
                    const DeclaredOutput* const other = output_of(verbs.declared, app, one);
                    const bool has_ending = other && !other->what.endings.empty();
                    return &one == input || &one == output
                               ? file.string()
                               : (folder.path / "x").string() + (has_ending ? other->what.endings.front() : "");
                });
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
    });
    for (const char* one : {"spectrum --csv", "spectrum --table", "spectrum --cepstrum", "spectrum --plot",
                            "exposure --table", "compare --table", "validate --table", "score --csv",
                            "fracture-surface --out", "import --out", "plan export --out", "plan report --pdf"}) {
        CAPTURE(one);
        CHECK(tried.contains(one));
    }
}

TEST_CASE("no verb writes a file whose ending promises another format: it is refused before any input is read") {
    const Folder folder;
    const AllVerbs verbs;
    const std::vector<std::string> formats = command::written_formats(verbs.declared);
    CHECK(std::ranges::find(formats, ".vdb") != formats.end());
    std::size_t refused = 0;
    verbs.each([&](const CLI::App& app, const std::string& name) {
        for (const CLI::Option* output : app.get_options()) {
            const DeclaredOutput* const declared = output_of(verbs.declared, app, *output);
            if (!declared) continue;
            const auto has = [&](const std::string& ending) {
                return std::ranges::any_of(declared->what.endings,
                                           [&](const std::string& own) { return ending.ends_with(own); });
            };
            std::vector<std::string> odd;
            if (!declared->what.is_free) odd = {".doc", ""};
            for (const std::string& format : formats)
                if (!has(format)) odd.push_back(format);
            for (const std::string& ending : odd) {
                const fs::path file = folder.path / ("odd" + ending);
                // The inputs do not exist, which would be the error after this one.
                const auto words = line_of(app, name, {output}, [&](const CLI::Option& one) {
                    const DeclaredOutput* const other = output_of(verbs.declared, app, one);
                    return &one == output
                               ? file.string()
                               : (folder.path / "x").string() +
                                     (other && !other->what.endings.empty() ? other->what.endings.front() : "");
                });
                const auto [code, errors] = run_here(words, folder.path / "errors");
                CAPTURE(words, errors);
                CHECK(code == 2);
                CHECK_THAT(errors, ContainsSubstring(file.string() + ": "));
                CHECK_THAT(errors, ContainsSubstring("is written as") || ContainsSubstring("does not write"));
                for (const std::string& own : declared->what.endings) CHECK_THAT(errors, ContainsSubstring(own));
                CHECK_FALSE(fs::exists(file));
                ++refused;
            }
        }
    });
    CHECK(refused > 500);
}

TEST_CASE("every option that a verb writes to is declared as an output") {
    const AllVerbs verbs;
    std::set<std::string> names;
    verbs.each([&](const CLI::App& app, const std::string&) {
        for (const CLI::Option* option : app.get_options())
            if (output_of(verbs.declared, app, *option) && !option->get_positional()) names.insert(name_of(*option));
    });
    // Inputs that are named like an output of another verb, or whose help text speaks of writing.
    const std::set<std::string> inputs{"fracture-surface --paint", "render --log", "score --task", "snap --paint"};
    std::set<std::string> missing, seen;
    verbs.each([&](const CLI::App& app, const std::string& name) {
        for (const CLI::Option* option : app.get_options()) {
            if (!is_text(*option) || output_of(verbs.declared, app, *option)) continue;
            const std::string about = option->get_description();
            const bool is_said = std::ranges::any_of(
                std::vector<std::string>{"write", "written", "file for the", "folder for", "CSV file with", "a PNG of"},
                [&](const std::string& word) { return about.find(word) != std::string::npos; });
            if (!is_said && !names.contains(name_of(*option))) continue;
            const std::string one = name + " " + name_of(*option);
            if (inputs.contains(one)) seen.insert(one);
            else missing.insert(one);
        }
    });
    CHECK(missing == std::set<std::string>());
    CHECK(seen == inputs);
}

TEST_CASE("a file named for one input or a folder for several is refused when it has the name of the other") {
    const Folder folder;
    fs::create_directory(folder.path / "logs");
    std::string rows = "t_s,a\n";
    for (int n = 0; n < 400; ++n) rows += std::to_string(n * 0.001) + "," + std::to_string(n % 7) + "\n";
    folder.write("logs/a.csv", rows);
    folder.write("logs/b.csv", rows);
    const std::string at = folder.path.string() + "/";
    const auto refused = [&](const std::string& arguments, const std::string& text, const std::string& out) {
        const test::Outcome outcome = folder.tactus(arguments + " " + at + out);
        CAPTURE(arguments, outcome.err);
        CHECK(outcome.code == 2);
        CHECK_THAT(outcome.err, ContainsSubstring(text));
        CHECK_FALSE(fs::exists(folder.path / out));
    };
    refused("spectrum " + at + "logs --csv", "several inputs need a folder", "x.csv");
    refused("spectrum " + at + "logs/a.csv --csv", "of one input a file is written, as .csv", "x");
    refused("spectrum " + at + "logs/a.csv --plot", "of one input a file is written, as .svg", "x");
    refused("compare " + at + "logs " + at + "logs --plot", "several inputs need a folder", "x.svg");
    CHECK(folder.tactus("spectrum " + at + "logs/a.csv --csv /dev/stdout").code == 0);
    CHECK(folder.tactus("spectrum " + at + "logs --csv " + at + "each").code == 0);
    CHECK(fs::exists(folder.path / "each" / "a.csv.csv"));
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
