// SPDX-License-Identifier: Apache-2.0
// The commands of README and the tutorials run as written; those of all other pages name verbs and options that exist.
#include "tests/repository/markdown.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using namespace tactus::test;

/// One command of a block, continued lines joined.
struct Line {
    std::string text;
    int number = 0;
};

std::vector<Line> commands_of(const MarkdownBlock& block) {
    std::vector<Line> lines;
    std::istringstream stream(block.text);
    bool continues = false;
    int number = block.line;
    for (std::string text; std::getline(stream, text);) {
        ++number;
        const bool goes_on = text.ends_with('\\');
        if (goes_on) text.pop_back();
        if (continues) lines.back().text += text;
        else if (text.find_first_not_of(" \t") != std::string::npos && text.front() != '#')
            lines.push_back({text, number});
        continues = goes_on;
    }
    return lines;
}

/// What the page says the command exits with: "# exit code 1: …", else 0.
int promised_code(const std::string& line) {
    std::smatch found;
    static const std::regex code("#.*exit code ([0-9])");
    return std::regex_search(line, found, code) ? std::stoi(found[1]) : 0;
}

std::vector<std::string> words_of(const std::string& text) {
    std::istringstream stream(text.substr(0, text.find(" #")));
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

void check_dev_verb(const Line& line) {
    const auto words = words_of(line.text);
    const std::string usage = slurp(source_folder() / "dev");
    CAPTURE(line.number, line.text);
    CHECK((words.size() > 1 && usage.find("\n  " + words[1] + " ") != std::string::npos));
}

/// Runs the Python of a page as one program, where numpy is installed.
void run_python(const fs::path& page, const Folder& folder, const fs::path& built) {
    std::string program;
    for (const MarkdownBlock& block : blocks_of(page))
        if (block.language == "python" && !block.remark("not run")) program += block.text + "\n";
    if (program.empty() || std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0) return;
    folder.write("page.py", program);
    const std::string command = "cd '" + folder.path.string() + "' && PYTHONDONTWRITEBYTECODE=1 PYTHONPATH='" +
                                (source_folder() / "tools/python").string() + "' TACTUS_SO='" +
                                (built / "libtactus.so").string() + "' TACTUS_COMMAND='" + (built / "tactus").string() +
                                "' /usr/bin/python3 page.py >.stdout 2>.stderr";
    const int status = std::system(command.c_str());
    CAPTURE(page.string(), slurp(folder.path / ".stdout"), slurp(folder.path / ".stderr"));
    REQUIRE(status == 0);
}

/// Runs the blocks of one page in order, in one folder that looks like the root of a checkout after the build.
void run_page(const fs::path& page) {
    const Folder folder;
    const fs::path built = fs::path(command()).parent_path();
    fs::create_directories(folder.path / "build");
    fs::create_directory_symlink(built, folder.path / "build/release");
    const std::string prefix = "cd '" + folder.path.string() + "' && PATH='" + built.string() + "':\"$PATH\" && ";
    for (const MarkdownBlock& block : blocks_of(page)) {
        if (const auto name = block.remark("file")) folder.write(*name, block.text);
        if (block.language != "sh") continue;
        for (const Line& line : commands_of(block)) {
            if (line.text.starts_with("./dev ")) {
                check_dev_verb(line);
                continue;
            }
            if (block.remark("not run")) continue;
            CAPTURE(page.string(), line.number, line.text);
            // Other programs may be missing where the tests run.
            REQUIRE(line.text.starts_with("tactus "));
            const fs::path out = folder.path / ".stdout", err = folder.path / ".stderr";
            const std::string redirected =
                prefix + "{ " + line.text + "\n} >'" + out.string() + "' 2>'" + err.string() + "'";
            const int status = std::system(redirected.c_str());
            CAPTURE(slurp(out), slurp(err));
            // What follows needs the files that this one makes.
            REQUIRE(WIFEXITED(status));
            REQUIRE(WEXITSTATUS(status) == promised_code(line.text));
        }
    }
    run_python(page, folder, built);
}

void run_tutorial(const std::string& page) { run_page(source_folder() / "docs/tutorial" / (page + ".md")); }

/// The verb of "tactus plan snap …", with the second word where the verb has verbs of its own.
std::string verb_of(const std::vector<std::string>& words) {
    const bool is_twofold = words.size() > 2 && (words[1] == "plan" || words[1] == "bench" ||
                                                 words[1] == "experiment" || words[1] == "sweep");
    return is_twofold ? words[1] + " " + words[2] : words[1];
}

}  // namespace

// Costly: whole runs and analyses, as a reader would start them.
TEST_CASE("the commands of README run as written", "[kernel]") { run_page(source_folder() / "README.md"); }

// A case for each page: they wait for runs in real time, and together would end long after all other cases.
TEST_CASE("the commands of the tutorial 'experiment' run as written", "[kernel]") { run_tutorial("experiment"); }
TEST_CASE("the commands of the tutorial 'first-node' run as written", "[kernel]") { run_tutorial("first-node"); }
TEST_CASE("the commands of the tutorial 'first-patch' run as written", "[kernel]") { run_tutorial("first-patch"); }
// Costly: whole runs and analyses, as a reader would start them.
TEST_CASE("the commands of the tutorial 'first-plan' run as written", "[kernel]") { run_tutorial("first-plan"); }
// Costly: whole runs and analyses, as a reader would start them.
TEST_CASE("the commands of the tutorial 'own-ct-and-saw' run as written", "[kernel]") {
    run_tutorial("own-ct-and-saw");
}
// Costly: whole runs and analyses, as a reader would start them.
TEST_CASE("the commands of the tutorial 'plan-guide-saw' run as written", "[kernel]") {
    run_tutorial("plan-guide-saw");
}
TEST_CASE("the commands of the tutorial 'python' run as written", "[kernel]") { run_tutorial("python"); }
// Costly: whole runs and analyses, as a reader would start them.
TEST_CASE("the commands of the tutorial 'reconstruction' run as written", "[kernel]") {
    run_tutorial("reconstruction");
}
TEST_CASE("the commands of the tutorial 'window' run as written", "[kernel]") { run_tutorial("window"); }

TEST_CASE("every tutorial has a case that runs its commands") {
    const std::string cases = slurp(source_folder() / "tests/repository/documented_commands.cpp");
    for (const fs::path& page : markdown_files()) {
        if (page.parent_path() != source_folder() / "docs/tutorial") continue;
        CAPTURE(page.string());
        CHECK(cases.find(" run_tutorial(\"" + page.stem().string() + "\");") != std::string::npos);
    }
}

TEST_CASE("documented commands name verbs and options that exist", "[slow]") {
    const Folder folder;
    std::map<std::string, Outcome> help;
    static const std::regex option("^--[a-z-]+");
    // --nodes and --memory, up to the list of verbs.
    const std::string whole = folder.tactus("--help").out,
                      of_program = whole.substr(0, whole.find("\n\nRun and patch:"));
    for (const fs::path& page : markdown_files())
        for (const MarkdownBlock& block : blocks_of(page)) {
            if (block.language != "sh") continue;
            for (const Line& line : commands_of(block)) {
                const auto words = words_of(line.text);
                if (words.size() < 2 || words[0] != "tactus") continue;
                const std::string verb = verb_of(words);
                if (!help.contains(verb)) help[verb] = folder.tactus(verb + " --help");
                const std::string text = help[verb].out + of_program;
                CAPTURE(page.string(), line.number, line.text);
                CHECK(help[verb].code == 0);
                for (const std::string& word : words) {
                    std::smatch found;
                    if (!std::regex_search(word, found, option)) continue;
                    CAPTURE(word);
                    // Followed by what may end a name, so that --out is not found in --output.
                    CHECK(std::regex_search(text, std::regex(found.str() + "[ ,{\n]")));
                }
            }
        }
}
