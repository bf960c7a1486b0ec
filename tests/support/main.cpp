// SPDX-License-Identifier: Apache-2.0
// The main program of all tests: exit code 0 passed, 1 failed, 77 skipped.
#if !__has_include(<catch2/catch_all.hpp>)
#define CATCH_CONFIG_RUNNER
#endif
#include "tests/support/catch.hpp"
#include "tests/support/machine_watch.hpp"
#include "tests/support/skip.hpp"

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <string>

#include <sys/resource.h>

// OpenVDB loses the node that it was reading when a damaged file makes it throw; AddressSanitizer asks for these names.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:RootNode*readTopology\n"; }
extern "C" const char* __lsan_default_options();
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }

namespace {

constexpr int skipped_code = 77;

/// Processor time of this process and of its children that have ended, in s.
double processor_seconds() {
    double sum = 0;
    for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage used{};
        ::getrusage(who, &used);
        for (const timeval& time : {used.ru_utime, used.ru_stime})
            sum += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
    return sum;
}

/// Appends processor seconds (the start of the process included) and the name of the case, as ctest has it, to the file
/// that TACTUS_COSTS names.
void note_cost(const std::string& name) {
    const char* const path = std::getenv("TACTUS_COSTS");
    std::FILE* const file = path ? std::fopen(path, "a") : nullptr;
    if (!file) return;
    std::string room = program_invocation_short_name;  // test_dsp
    if (room.starts_with("test_")) room.erase(0, 5);
    std::fprintf(file, "%.2f\t%s:%s\n", processor_seconds(), room.c_str(), name.c_str());
    std::fclose(file);
}

int cases = 0, skipped_cases = 0;
bool is_skipped = false, is_of_window = false;  // the running case
bool shows_window = false;  // a case that failed

#if __has_include(<catch2/catch_all.hpp>)
using Listener = Catch::EventListenerBase;
#else
using Listener = Catch::TestEventListenerBase;
#endif

struct CountSkipped : Listener {
    using Listener::Listener;
    void testCaseStarting(const Catch::TestCaseInfo& info) override {
        Listener::testCaseStarting(info);
        is_skipped = false;
        is_of_window = info.tagsAsString().find("[display]") != std::string::npos;
    }
    void testCaseEnded(const Catch::TestCaseStats& stats) override {
        Listener::testCaseEnded(stats);
        ++cases;
        skipped_cases += is_skipped;
        note_cost(stats.testInfo.name);
        if (!stats.totals.assertions.allOk()) shows_window = shows_window || is_of_window;
    }
};
CATCH_REGISTER_LISTENER(CountSkipped)

}  // namespace

namespace tactus::test {

void skip(const std::string& why) {
    is_skipped = true;
    WARN("skipped: " << why);
}

}  // namespace tactus::test

int main(int argc, char** argv) {
    // The program that reads DICOM files lies beside the command, not beside the tests.
    ::setenv("TACTUS_SCAN_DECODER", TACTUS_SCAN_DECODER, 0);
    // Nothing that one case keeps may reach another one, or the person's own cache.
    ::setenv("TACTUS_CACHE_LIMIT", "0", 0);
    Catch::Session session;
    if (session.applyCommandLine(argc, argv) != 0) return 1;
#if !__has_include(<catch2/catch_all.hpp>)
    // A name that no test case has is a failure, as in Catch2 3.
    session.configData().warnings = Catch::WarnAbout::NoTests;
#endif
    // Tests in real time that failed again and again: `./dev test` asks at last whether the machine keeps time at all.
    std::optional<tactus::test::MachineWatch> machine;
    if (std::getenv("TACTUS_WATCH_MACHINE")) machine.emplace();
    // Catch2 2 returns the number of failed checks, which may be 77.
    if (session.run() != 0) {
        if (!machine || !machine->excuses(shows_window)) return 1;
        std::cerr << "skipped: this machine " << machine->text() << "; what failed above cannot be judged on it\n";
        return skipped_code;
    }
    return cases > 0 && skipped_cases == cases ? skipped_code : 0;
}
