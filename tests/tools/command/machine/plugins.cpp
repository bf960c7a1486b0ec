// SPDX-License-Identifier: Apache-2.0
// Nodes from outside of the tree, as a user gives them to the command; their sources are in tests/plugins.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace fs = std::filesystem;
using namespace tactus::test;
using Catch::Matchers::ContainsSubstring;
using nlohmann::json;

namespace {

const fs::path plugins = TACTUS_TEST_PLUGINS;

std::string file_of(const std::string& name) { return (plugins / (name + ".so")).string(); }

constexpr const char* folded = R"(wires = ["voice.signal -> fold.in"]
[nodes.voice]
type = "sine"
rate = "48 kHz"
frequency = "100 Hz"
amplitude = "1"
[nodes.fold]
type = "fold"
rate = "48 kHz"
gain = "3"
)";

constexpr const char* counted = R"(wires = ["count.counts -> read.counts", "read.total -> keep.in"]
[nodes.count]
type = "count_ticks"
rate = "1 kHz"
[nodes.read]
type = "read_counts"
rate = "1 kHz"
[nodes.keep]
type = "record"
rate = "1 kHz"
file = "total.csv"
)";

}  // namespace

TEST_CASE("a node from outside runs in a patch, repeats from a take, and the take names its file") {
    const Folder folder;
    const std::string patch = folder.write("p.toml", folded).string(), take = (folder.path / "take").string();
    const Outcome without = folder.tactus("check " + patch);
    CHECK(without.code == 2);
    CHECK_THAT(without.err, ContainsSubstring("unknown node type 'fold'") && ContainsSubstring("--nodes"));

    // In front of the verb or behind it.
    const Outcome checked = folder.tactus("--nodes=" + file_of("fold") + " check " + patch);
    INFO(checked.err);
    CHECK(checked.code == 0);
    const Outcome run = folder.tactus("render " + patch + " --seconds 0.5 --out " + (folder.path / "out").string() +
                                      " --record " + take + " --nodes " + file_of("fold"));
    INFO(run.err);
    REQUIRE(run.code == 0);
    const json about = json::parse(slurp(fs::path(take) / "take.json"));
    REQUIRE(about.at("plugins").size() == 1);
    CHECK(about["plugins"][0].at("name") == "test-fold");
    CHECK(about["plugins"][0].at("version") == "1.2");
    CHECK(about["plugins"][0].at("path") == fs::canonical(file_of("fold")).string());

    CHECK(folder.tactus("replay " + take + " --nodes " + file_of("fold")).code == 0);
    // Nothing is loaded from the path in the take.
    const Outcome alone = folder.tactus("replay " + take);
    CHECK(alone.code == 2);
    CHECK_THAT(alone.err, ContainsSubstring("'test-fold'") && ContainsSubstring("not loaded"));
    // Another file under the same name.
    fs::copy_file(file_of("fold"), folder.path / "fold.so");
    std::ofstream(folder.path / "fold.so", std::ios::app) << "more";
    const Outcome changed = folder.tactus("replay " + take + " --nodes " + (folder.path / "fold.so").string());
    CHECK_THAT(changed.err, ContainsSubstring("'test-fold' has changed"));
}

TEST_CASE("'nodes' lists the nodes from outside with the file and version they are of") {
    const Folder folder;
    const Outcome one = folder.tactus("nodes fold --nodes " + file_of("fold"));
    CHECK_THAT(one.out, ContainsSubstring("test-fold 1.2") && ContainsSubstring(file_of("fold")));
    const json rows = json::parse(folder.tactus("nodes --json --nodes " + file_of("fold")).out).at("rows");
    int outside = 0;
    for (const json& row : rows) outside += row.contains("plugin");
    CHECK(outside == 2);
    CHECK_FALSE(json::parse(folder.tactus("nodes gain --json").out).at("rows")[0].contains("plugin"));
}

TEST_CASE("a folder and the environment give nodes, too, each file once") {
    const Folder folder;
    fs::create_directory(folder.path / "some");
    for (const char* name : {"fold", "read_counts"})
        fs::copy_file(file_of(name), folder.path / "some" / (name + std::string(".so")));
    const std::string patch = folder.write("p.toml", counted).string(), some = (folder.path / "some").string();
    CHECK(folder.tactus("check " + patch + " --nodes " + some).code == 0);
    ::setenv("TACTUS_NODES", (some + ":" + some + "/fold.so").c_str(), 1);
    CHECK(folder.tactus("check " + patch).code == 0);
    ::setenv("TACTUS_NODES", (some + "/nothing.so").c_str(), 1);
    const Outcome missing = folder.tactus("check " + patch);
    ::unsetenv("TACTUS_NODES");
    CHECK(missing.code == 2);
    CHECK_THAT(missing.err, ContainsSubstring("nothing.so"));
}

TEST_CASE("two plug-ins share a value type by its name and layout, and one of another layout is refused") {
    const Folder folder;
    const std::string patch = folder.write("p.toml", counted).string();
    const Outcome same = folder.tactus("render " + patch + " --seconds 0.02 --out " + (folder.path / "out").string() +
                                       " --record " + (folder.path / "take").string() + " --nodes " + file_of("fold") +
                                       " --nodes " + file_of("read_counts"));
    INFO(same.err);
    CHECK(same.code == 0);
    const std::string totals = slurp(folder.path / "out/total.csv");
    CHECK(totals.ends_with(",20\n"));
    const Outcome other =
        folder.tactus("check " + patch + " --nodes " + file_of("fold") + " --nodes " + file_of("read_other_counts"));
    CHECK(other.code == 2);
    CHECK_THAT(other.err, ContainsSubstring("of another layout"));
}

TEST_CASE("each fault of a plug-in gives one error that names the file and what to do") {
    const Folder folder;
    const auto refused = [&](const std::string& path, const std::string& first, const std::string& second) {
        const Outcome seen = folder.tactus("nodes --nodes " + path);
        INFO(path << "\n" << seen.err);
        CHECK(seen.code == 2);
        CHECK(seen.out.empty());
        CHECK(std::ranges::count(seen.err, '\n') == 1);
        CHECK_THAT(seen.err, ContainsSubstring(path) && ContainsSubstring(first) && ContainsSubstring(second));
    };
    refused(file_of("faulty_other_headers"), "0.0.9-0123456789abcdef", "Rebuild");
    refused(file_of("faulty_other_compiler"), "GCC 4", "Rebuild");
    refused(file_of("faulty_no_entry"), "tactus_plugin", "TACTUS_PLUGIN");
    refused(file_of("faulty_undefined"), "tactus::not_in_this_version(double)", "rebuild");
    refused(file_of("faulty_clash"), "Tactus has a node type 'gain' already", "another name");
    refused(file_of("faulty_range"), "parameter 'depth'", "outside of 0 … 1");
    refused(file_of("faulty_unit"), "'faulty'", "parsecs");
    refused(file_of("faulty_throws"), "'faulty'", "the laboratory is closed");
    refused(file_of("faulty_reserved"), "'rate'", "key of every node");
    // The same file twice is one plug-in; a copy of it has the same names.
    CHECK(folder.tactus("nodes --nodes " + file_of("faulty_none") + " --nodes " + file_of("faulty_none")).code == 0);
    fs::copy_file(file_of("faulty_none"), folder.path / "copy.so");
    const Outcome twice =
        folder.tactus("nodes --nodes " + file_of("faulty_none") + " --nodes " + (folder.path / "copy.so").string());
    CHECK(twice.code == 2);
    CHECK_THAT(twice.err, ContainsSubstring("a node type 'faulty' already"));
}

TEST_CASE("what is no shared object, no file or no folder is refused as nodes") {
    const Folder folder;
    const std::string text = folder.write("text.so", "no shared object").string();
    const Outcome seen = folder.tactus("nodes --nodes " + text);
    CHECK(seen.code == 2);
    CHECK_THAT(seen.err, ContainsSubstring(text) && ContainsSubstring("not a plug-in"));
    CHECK(folder.tactus("nodes --nodes " + folder.write("empty.so", "").string()).code == 2);
    CHECK(folder.tactus("nodes --nodes /dev/null").code == 2);
    const std::string whole = slurp(file_of("fold"));
    for (const std::size_t kept :
         {std::size_t{10}, std::size_t{64}, std::size_t{200}, std::size_t{2000}, std::size_t{4096}, whole.size() / 3}) {
        INFO(kept << " bytes");
        const Outcome cut = folder.tactus("nodes --nodes " + folder.write("cut.so", whole.substr(0, kept)).string());
        CHECK(cut.code == 2);
        CHECK_THAT(cut.err, ContainsSubstring("cut.so") && ContainsSubstring("not a plug-in"));
    }
    CHECK(folder.tactus("nodes --nodes").code == 2);
    const Outcome missing = folder.tactus("nodes --nodes " + (folder.path / "none.so").string());
    CHECK(missing.code == 2);
    CHECK_THAT(missing.err, ContainsSubstring("no such file"));
    // A folder without any adds none.
    fs::create_directory(folder.path / "bare");
    CHECK(folder.tactus("nodes --nodes " + (folder.path / "bare").string()).code == 0);
}

TEST_CASE("'tactus-check-node' finds each fault of a node, also a crash, and none in good ones", "[slow]") {
    const Folder folder;
    const auto checked = [&](const std::string& arguments) {
        const std::string program = (fs::path(command()).parent_path() / "tactus-check-node").string();
        const fs::path said = folder.path / "said";
        const int status = std::system((program + " " + arguments + " >" + said.string() + " 2>&1").c_str());
        return Outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, slurp(said), ""};
    };
    for (const char* good : {"fold", "read_counts", "faulty_none"}) {
        const Outcome seen = checked(file_of(good));
        INFO(seen.out);
        CHECK(seen.code == 0);
        CHECK(seen.out.find("FAILED") == std::string::npos);
        CHECK_THAT(seen.out, ContainsSubstring(" ns a call"));
    }
    const auto fails = [&](const std::string& name, const std::string& check, const std::string& text) {
        const Outcome seen = checked(file_of(name));
        INFO(name << "\n" << seen.out);
        CHECK(seen.code == 1);
        const std::size_t line = seen.out.find("  " + check);
        REQUIRE(line != std::string::npos);
        CHECK_THAT(seen.out.substr(line, seen.out.find('\n', line) - line),
                   ContainsSubstring("FAILED: ") && ContainsSubstring(text));
    };
    fails("faulty_allocates", "real time", "allocations");
    fails("faulty_blocks", "blocks", "blocks of other lengths");
    fails("faulty_nan", "extreme values", "depth = 1");
    fails("faulty_shares", "two at once", "static variable");
    fails("faulty_crashes", "bad values", "crashed");
    CHECK(checked(file_of("fold") + " count_ticks").out.find("\nfold\n") == std::string::npos);
    CHECK(checked(file_of("fold") + " unfold").code == 2);
    CHECK(checked(file_of("faulty_other_headers")).code == 2);
    CHECK(checked("").code == 2);
}

TEST_CASE("the project of a new node is refused under a name that a type cannot have or one has, and over a folder") {
    const Folder folder;
    const auto made = [&](const std::string& name) {
        const std::string line =
            "cd " + folder.path.string() + " && " + command() + " nodes --new " + name + " >said 2>&1";
        const int status = std::system(line.c_str());
        return Outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, slurp(folder.path / "said"), ""};
    };
    CHECK_THAT(made("gain").out, ContainsSubstring("already") && ContainsSubstring("my_gain"));
    for (const char* wrong :
         {"Gain", "my-gain", "../gain", "a_2", "_gain", "gain_", "''", "my__gain", "1gain", "test"}) {
        INFO(wrong);
        CHECK(made(wrong).code == 2);
    }
    CHECK(std::distance(fs::directory_iterator(folder.path), {}) == 1);  // what was said
    CHECK(made("my_gain").code == 0);
    CHECK_THAT(slurp(folder.path / "my_gain/my_gain.cpp"), ContainsSubstring("TACTUS_NODE(MyGain, in, out, factor)"));
    const Outcome again = made("my_gain");
    CHECK(again.code == 2);
    CHECK_THAT(again.out, ContainsSubstring("already"));
}
