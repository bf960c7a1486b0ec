// SPDX-License-Identifier: Apache-2.0
#include "engine/io/channel_gather.hpp"
#include "tests/support/catch.hpp"

#include <vector>

using namespace tactus;

namespace {

/// The frames of the block that is complete, with its first activation in front; empty when there is none.
std::vector<float> put(io::ChannelGather& gather, int channel, std::int64_t first, std::vector<float> values) {
    std::vector<float> out;
    const auto take = [&] {
        std::int64_t at = 0;
        const auto block = gather.take(at);
        out.push_back(static_cast<float>(at));
        out.insert(out.end(), block.begin(), block.end());
    };
    if (gather.is_blocked(channel, first, values.size())) take();
    if (gather.put(channel, first, values.data(), values.size(), sizeof(float))) take();
    return out;
}

using Frames = std::vector<float>;

}  // namespace

TEST_CASE("channels come out as frames when all have written their block") {
    io::ChannelGather gather;
    gather.resize(3, 4);
    gather.expect(0);
    gather.expect(2);
    CHECK(put(gather, 2, 100, {5, 6}).empty());
    CHECK(put(gather, 0, 100, {1, 2}) == Frames{100, 1, 0, 5, 2, 0, 6});
    CHECK(put(gather, 0, 102, {3}).empty());
    CHECK(put(gather, 2, 102, {7}) == Frames{102, 3, 0, 7});
}

TEST_CASE("a channel that is gone is waited for once, and is silent") {
    io::ChannelGather gather;
    gather.resize(2, 4);
    gather.expect(0);
    gather.expect(1);
    put(gather, 0, 0, {1});
    CHECK(put(gather, 1, 0, {2}) == Frames{0, 1, 2});
    CHECK(put(gather, 0, 1, {3}).empty());
    CHECK(put(gather, 0, 2, {4}) == Frames{1, 3, 0, 2, 4, 0});
}

TEST_CASE("a channel that is new misses one block and is in step from then on") {
    io::ChannelGather gather;
    gather.resize(2, 4);
    gather.expect(0);
    CHECK(put(gather, 0, 10, {1, 1}) == Frames{10, 1, 0, 1, 0});
    CHECK(put(gather, 1, 10, {9, 9}).empty());
    CHECK(put(gather, 0, 12, {2}).empty());
    CHECK(put(gather, 1, 12, {8}) == Frames{12, 2, 8});
}

TEST_CASE("a channel takes its samples from values that lie apart") {
    io::ChannelGather gather;
    gather.resize(1, 2);
    gather.expect(0);
    const float values[] = {1, -1, 2, -1};
    CHECK(gather.put(0, 0, values, 2, 2 * sizeof(float)));
    std::int64_t first = 0;
    const auto block = gather.take(first);
    CHECK(Frames(block.begin(), block.end()) == Frames{1, 2});
}
