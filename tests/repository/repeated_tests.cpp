// SPDX-License-Identifier: Apache-2.0
// Which cases './dev test' runs, and which it repeats, in a folder with a few cases whose outcome is known.
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

namespace {

namespace fs = std::filesystem;
using namespace tactus::test;

/// A checkout whose build does nothing and whose tests write a letter each time that they run.
class Checkout {
public:
    Checkout() {
        fs::create_directories(folder_.path / "build/release");
        fs::create_directories(folder_.path / "bin");
        fs::create_directories(folder_.path / "cmake");
        fs::create_directories(folder_.path / "tests");
        fs::copy_file(source_folder() / "dev", folder_.path / "dev");
        fs::copy_file(source_folder() / "tests/tiers.sh", folder_.path / "tests/tiers.sh");
        folder_.write("tests/costs.tsv", "# none\n");
        folder_.write("cmake/packages.txt", "always nothing reason\n");
        folder_.write("build/release/build.ninja", "");
        program("cmake", "exit 0");
        program("dpkg-query", "printf installed");
        folder_.write("ran", "");
    }

    /// A test that fails in its first runs and passes from then on; 77 as exit code is skipped.
    void add(const std::string& name, const std::string& label, int failures, int code = 1) {
        // "w": the watch over the machine was on.
        const std::string script = "n=$(grep -c '^" + name + "' '" + path("ran") + "'); echo \"" + name +
                                   "${TACTUS_WATCH_MACHINE:+w}\" >> '" + path("ran") + "'; [ $n -ge " +
                                   std::to_string(failures) + " ] || exit " + std::to_string(code);
        tests_ += "add_test(" + name + " \"bash\" \"-c\" [==[" + script + "]==])\nset_tests_properties(" + name +
                  " PROPERTIES LABELS " + label + " SKIP_RETURN_CODE 77)\n";
    }

    /// States the processor time of a case.
    void cost(const std::string& name, int seconds) {
        costs_ += std::to_string(seconds) + "\t" + name + "\n";
        folder_.write("tests/costs.tsv", costs_);
    }

    /// The exit code of './dev test'.
    int test(const std::string& without = {}) {
        for (const char* label : {"fast", "slow", "display", "kernel", "live"})
            if (label != without) add(std::string("some_") + label, label, 0);
        folder_.write("build/release/CTestTestfile.cmake", tests_);
        const std::string line =
            "PATH='" + path("bin") + "':\"$PATH\" bash '" + path("dev") + "' test >'" + path("out") + "' 2>&1";
        const int status = std::system(line.c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

    /// How often a test ran, and whether its last run was watched.
    std::string runs_of(const std::string& name) {
        std::istringstream lines(slurp(folder_.path / "ran"));
        std::string runs;
        for (std::string line; std::getline(lines, line);)
            if (line.starts_with(name)) runs += line.substr(name.size()) + ".";
        return runs;
    }

    std::string printed() { return slurp(folder_.path / "out"); }

private:
    std::string path(const std::string& name) const { return (folder_.path / name).string(); }
    void program(const std::string& name, const std::string& body) {
        folder_.write("bin/" + name, "#!/bin/sh\n" + body + "\n");
        fs::permissions(folder_.path / "bin" / name, fs::perms::owner_all);
    }

    Folder folder_;
    std::string tests_, costs_;
};

}  // namespace

TEST_CASE("a case in real time that failed runs once more, alone, beside a watch over the machine", "[slow]") {
    Checkout checkout;
    checkout.add("early", "fast", 0);
    checkout.add("absent", "slow", 9, 77);
    checkout.add("once", "live", 1);
    checkout.add("window", "live-display", 1);
    checkout.add("process", "kernel", 1);
    checkout.add("matrix", "long-kernel", 1);
    const int code = checkout.test();
    INFO(checkout.printed());
    CHECK(code == 0);
    CHECK(checkout.runs_of("early") == ".");
    CHECK(checkout.runs_of("absent") == ".");
    CHECK(checkout.runs_of("once") == ".w.");
    for (const char* name : {"window", "process", "matrix"}) CHECK(checkout.runs_of(name) == ".w.");
}

TEST_CASE("a case in real time that fails twice fails the landing", "[slow]") {
    Checkout checkout;
    checkout.add("early", "fast", 0);
    checkout.add("never", "live", 2);
    const int code = checkout.test();
    INFO(checkout.printed());
    CHECK(code == 1);
    CHECK(checkout.runs_of("never") == ".w.");
    CHECK(checkout.runs_of("early") == ".");
}

TEST_CASE("a landing fails that has no case of one label", "[slow]") {
    Checkout checkout;
    const int code = checkout.test("display");
    INFO(checkout.printed());
    CHECK(code == 1);
    CHECK(checkout.printed().find("no test has the label 'display'") != std::string::npos);
}

TEST_CASE("no case runs again that is not in real time", "[slow]") {
    Checkout checkout;
    checkout.add("wrong", "fast", 1);
    checkout.add("flawed", "long", 1);
    checkout.add("good", "live", 0);
    const int code = checkout.test();
    INFO(checkout.printed());
    CHECK(code == 1);
    CHECK(checkout.runs_of("wrong") == ".");
    CHECK(checkout.runs_of("flawed") == ".");
    CHECK(checkout.runs_of("good") == ".");
}

TEST_CASE("a landing runs long cases up to three minutes of their processor time", "[slow]") {
    Checkout checkout;
    int run = 0;
    for (int k = 0; k < 10; ++k) {
        checkout.add("long_" + std::string(1, static_cast<char>('a' + k)), "long", 0);
        checkout.cost("long_" + std::string(1, static_cast<char>('a' + k)), 50);
    }
    const int code = checkout.test();
    INFO(checkout.printed());
    CHECK(code == 0);
    for (int k = 0; k < 10; ++k) run += checkout.runs_of("long_" + std::string(1, static_cast<char>('a' + k))) == ".";
    CHECK(run == 3);
    CHECK(checkout.printed().find("s of processor time") != std::string::npos);
}
