// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/ring.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <thread>
#include <vector>

using namespace tactus;

TEST_CASE("a ring gives values back in order, across its end") {
    Ring<int> ring(5);
    CHECK(ring.capacity() == 8);
    std::array<int, 6> in{}, out{};
    int next = 0, expected = 0;
    for (int round = 0; round < 50; ++round) {
        for (int& value : in) value = next++;
        REQUIRE(ring.push(in.data(), in.size()) == in.size());
        REQUIRE(ring.pop(out.data(), out.size()) == out.size());
        for (int value : out) REQUIRE(value == expected++);
    }
}

TEST_CASE("a full ring takes only what fits and an empty one gives only what is there") {
    Ring<float> ring(4);
    const std::array<float, 6> in{1, 2, 3, 4, 5, 6};
    CHECK(ring.push(in.data(), in.size()) == 4);
    CHECK(ring.size() == 4);
    CHECK(ring.space() == 0);
    CHECK_FALSE(ring.push(7.0F));
    std::array<float, 6> out{};
    CHECK(ring.pop(out.data(), out.size()) == 4);
    CHECK(out == std::array<float, 6>{1, 2, 3, 4, 0, 0});
    float value = 0.0F;
    CHECK_FALSE(ring.pop(value));
    CHECK(ring.space() == 4);
}

TEST_CASE("nothing is lost, doubled or torn between two threads", "[slow]") {
    struct Twin {
        std::uint64_t a, b;
    };
    Ring<Twin> ring(64);
    constexpr std::uint64_t total = 200'000;
    std::thread writer([&] {
        std::array<Twin, 37> block{};
        for (std::uint64_t sent = 0; sent < total;) {
            const std::size_t count = std::min<std::uint64_t>(1 + sent % block.size(), total - sent);
            for (std::size_t i = 0; i < count; ++i) block[i] = {sent + i, ~(sent + i)};
            const std::size_t taken = ring.push(block.data(), count);
            if (taken == 0) std::this_thread::yield();
            sent += taken;
        }
    });
    std::uint64_t received = 0, wrong = 0;
    std::array<Twin, 23> block{};
    while (received < total) {
        const std::size_t count = ring.pop(block.data(), 1 + received % block.size());
        if (count == 0) std::this_thread::yield();
        for (std::size_t i = 0; i < count; ++i, ++received) wrong += block[i].a != received || block[i].b != ~received;
    }
    writer.join();
    CHECK(wrong == 0);
}
