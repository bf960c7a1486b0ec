// SPDX-License-Identifier: Apache-2.0
#include "graph/node/notice.hpp"

#include "graph/node/setup.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <memory>
#include <string>
#include <vector>

using namespace tactus;

namespace {

/// Of a run whose nodes only tell.
class QuietHost : public Host {
public:
    DevicePort& device(const std::string&, DeviceUse, const SourceLocation& where) override { refuse(where); }
    RecordStream& record(const StreamFormat&, const SourceLocation& where) override { refuse(where); }
    RecordStream& audio(const StreamFormat&, const SoundPlace& place) override { refuse(place.where); }

private:
    [[noreturn]] static void refuse(const SourceLocation& where) { throw Error(where, "not of this host"); }
};

Setup setup_of(const char* name, Host& host) {
    Setup setup;
    setup.name = name;
    setup.host = &host;
    return setup;
}

}  // namespace

TEST_CASE("graph: what a tick tells is taken once, by the run of its node, and telling allocates nothing") {
    QuietHost host, other;
    const auto one = std::make_unique<Notice>("the first text");
    auto two = std::make_unique<Notice>("the second text");
    Notice elsewhere("of another run"), loose("of no run");
    one->attach(setup_of("scene", host));
    two->attach(setup_of("matcher", host));
    elsewhere.attach(setup_of("scene", other));
    CHECK(take_notices(host).empty());
    const RealtimeViolations seen = watch([&] {
        for (int n = 0; n < 1000; ++n) one->tell();
        elsewhere.tell();
        loose.tell();
    });
    CHECK(seen.describe() == "none");
    CHECK(take_notices(host) == std::vector<std::string>{"scene: the first text"});
    CHECK(take_notices(host).empty());
    two->tell();
    one->tell();
    CHECK(take_notices(host) == std::vector<std::string>{"scene: the first text", "matcher: the second text"});
    CHECK(take_notices(other) == std::vector<std::string>{"scene: of another run"});
    // A node that an edit removed tells nothing any more.
    two->tell();
    two.reset();
    CHECK(take_notices(host).empty());
}
