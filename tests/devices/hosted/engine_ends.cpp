// SPDX-License-Identifier: Apache-2.0
// An engine that ends without a word, seen from the device: what was on the hand, by the clock of the device's process.
#include "dsp/core/clock.hpp"
#include "tests/devices/hosted/with_host.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;
using namespace tactus::test;

namespace {

/// An engine of its own that wants 4 N for ever.
class Engine {
public:
    explicit Engine(const WatchedHost& host, const std::string& fault = "none", int at = 0) {
        process_ = ::fork();
        if (process_ != 0) return;
        try {
            const auto device = host.open(fault, at);
            tick(*device, 4.0, [](const DeviceSample&) { return false; });
        } catch (...) {
        }
        ::_exit(0);
    }
    ~Engine() { end(SIGKILL); }
    void signal(int number) const { ::kill(process_, number); }
    void end(int number) {
        if (process_ < 0) return;
        ::kill(process_, number);
        ::waitpid(process_, nullptr, 0);
        process_ = -1;
    }

private:
    pid_t process_ = -1;
};

/// The exit code of a device's process whose engine is gone; −1 when it does not end.
int exit_code_of(pid_t process) {
    int status = 0;
    if (!wait_until([&] { return ::waitpid(process, &status, WNOHANG) == process; })) return -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -2;
}

}  // namespace

TEST_CASE("an engine that is killed leaves no force after 20 ms, and the device is closed", "[live]") {
    const WatchedHost host;
    Engine engine(host);
    REQUIRE(wait_until([&] { return host.log->last() == 4.0; }));
    const std::int64_t killed = boot_ns();
    engine.end(SIGKILL);
    CHECK(exit_code_of(host.log->process()) == 0);
    CHECK(host.log->is_closed());
    CHECK(host.log->last() == 0.0);
    CHECK(host.log->last_force_ns() - killed <= 20 * ms);
    CHECK(host.leaves_nothing());
}

TEST_CASE("an engine that is stopped leaves no force after 20 ms, and the device is closed after a second", "[live]") {
    const WatchedHost host;
    Engine engine(host);
    REQUIRE(wait_until([&] { return host.log->last() == 4.0; }));
    const std::int64_t stopped = boot_ns();
    engine.signal(SIGSTOP);
    CHECK(wait_until([&] { return host.log->last() == 0.0; }));
    CHECK(host.log->last_force_ns() - stopped <= 20 * ms);
    CHECK_FALSE(host.log->is_closed());
    CHECK(wait_until([&] { return host.log->is_closed(); }, 3'000));
    CHECK(host.log->max_after(stopped + 20 * ms) == 0.0);
    engine.end(SIGKILL);
    CHECK(exit_code_of(host.log->process()) == 0);
    CHECK(host.leaves_nothing());
}

TEST_CASE("an engine that was stopped for a moment gives no force without small ones first", "[kernel]") {
    const WatchedHost host;
    Engine engine(host);
    REQUIRE(wait_until([&] { return host.log->last() == 4.0; }));
    engine.signal(SIGSTOP);
    REQUIRE(wait_until([&] { return host.log->last() == 0.0; }));
    const std::int64_t gone = boot_ns();
    const std::uint64_t count = host.log->count();
    engine.signal(SIGCONT);
    CHECK(wait_until([&] { return host.log->count() > count + 400; }));
    CHECK(host.log->max_after(gone) == 0.0);
    CHECK_FALSE(host.log->is_closed());
    engine.end(SIGKILL);
    CHECK(exit_code_of(host.log->process()) == 0);
}

TEST_CASE("a device's process whose driver never returns ends after its engine", "[kernel]") {
    for (const std::string fault : {"hang in acquire", "hang in open", "hang in close"}) {
        CAPTURE(fault);
        const WatchedHost host;
        Engine engine(host, fault, 100);
        REQUIRE(wait_until([&] { return host.log->process() != 0; }));
        if (fault != "hang in open") REQUIRE(wait_until([&] { return host.log->count() >= 100; }));
        engine.end(SIGKILL);
        CHECK(exit_code_of(host.log->process()) == 3);
        CHECK(host.leaves_nothing());
    }
}
