// SPDX-License-Identifier: Apache-2.0
#include "engine/io/async_sink.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <atomic>
#include <chrono>
#include <cstring>
#include <functional>
#include <memory>
#include <thread>

using namespace tactus;

namespace {

struct Notes : StreamKeeper {
    std::vector<double> taken, saved;
    std::atomic<std::size_t> safe{0}, tries{0};
    std::atomic<bool> is_full{false};
    bool is_finished = false;
    std::thread::id by;

    void open(const std::string&) override {}
    void take(std::int64_t first, const std::byte* values, std::size_t count) override {
        for (std::size_t n = 0; n < count; ++n) {
            double value;
            std::memcpy(&value, values + n * sizeof value, sizeof value);
            taken.push_back(value + 100.0 * static_cast<double>(first));
        }
        by = std::this_thread::get_id();
    }
    void save() override {
        ++tries;
        if (is_full) throw Error("no room");
        saved = taken;
        safe = saved.size();
    }
    void finish() override {
        save();
        is_finished = true;
    }
};

void give(io::AsyncSink& sink, std::int64_t first, std::vector<double> values) {
    sink.take(first, reinterpret_cast<const std::byte*>(values.data()), values.size());
}

bool soon(const std::function<bool()>& is_so) {
    for (int n = 0; n < 3000; ++n) {
        if (is_so()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

}  // namespace

TEST_CASE("what is kept is saved by a thread of its own, in order, without being asked") {
    const auto notes = std::make_shared<Notes>();
    io::AsyncSink sink(notes, sizeof(double));
    give(sink, 1, {1.0, 2.0});
    give(sink, 5, {3.0});
    REQUIRE(soon([&] { return notes->safe == 3; }));
    sink.finish();
    CHECK(notes->saved == std::vector<double>{101.0, 102.0, 503.0});
    CHECK(notes->by != std::this_thread::get_id());
    CHECK(notes->is_finished);
    CHECK(sink.take_message().empty());
}

TEST_CASE("what cannot be saved is said once, tried again, and nothing of it is lost", "[slow]") {
    const auto notes = std::make_shared<Notes>();
    notes->is_full = true;
    io::AsyncSink sink(notes, sizeof(double));
    give(sink, 0, {1.0});
    std::string message;
    REQUIRE(soon([&] { return !(message = sink.take_message()).empty(); }));
    CHECK(message == "no room; it is tried again every second");
    give(sink, 0, {2.0});
    REQUIRE(soon([&] { return notes->tries >= 3; }));
    CHECK(sink.take_message().empty());
    notes->is_full = false;
    REQUIRE(soon([&] { return !(message = sink.take_message()).empty(); }));
    CHECK(notes->safe == 2);
    notes->is_full = true;
    CHECK_THROWS_WITH(sink.finish(), "no room");
}
