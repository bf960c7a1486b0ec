// SPDX-License-Identifier: Apache-2.0
// Which tests './dev test' runs again, in a folder with a few tests whose outcome is known.
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
        fs::copy_file(source_folder() / "dev", folder_.path / "dev");
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

    /// The exit code of './dev test'.
    int test() {
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
    std::string tests_;
};

}  // namespace

TEST_CASE("a test in real time that failed runs again alone, the second time beside a watch over the machine",
          "[slow]") {
    Checkout checkout;
    checkout.add("early", "fast", 0);
    checkout.add("absent", "slow", 9, 77);
    checkout.add("once", "live", 1);
    checkout.add("twice", "live-display", 2);
    const int code = checkout.test();
    INFO(checkout.printed());
    CHECK(code == 0);
    CHECK(checkout.runs_of("early") == ".");
    CHECK(checkout.runs_of("absent") == ".");
    CHECK(checkout.runs_of("once") == "..");
    CHECK(checkout.runs_of("twice") == "..w.");
}

TEST_CASE("a test in real time that never passes fails after three runs", "[slow]") {
    Checkout checkout;
    checkout.add("early", "fast", 0);
    checkout.add("never", "live", 9);
    const int code = checkout.test();
    INFO(checkout.printed());
    CHECK(code == 1);
    CHECK(checkout.runs_of("never") == "..w.");
    CHECK(checkout.runs_of("early") == ".");
}

TEST_CASE("no test runs again when one that is not in real time failed", "[slow]") {
    Checkout checkout;
    checkout.add("wrong", "fast", 1);
    checkout.add("late", "live", 1);
    const int code = checkout.test();
    INFO(checkout.printed());
    CHECK(code == 1);
    CHECK(checkout.runs_of("wrong") == ".");
    CHECK(checkout.runs_of("late") == ".");
}
