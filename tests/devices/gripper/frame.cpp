// SPDX-License-Identifier: Apache-2.0
#include "devices/gripper/frame.hpp"

#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

using namespace tactus;

namespace {

std::vector<std::uint8_t> bytes_of(const gripper::Frame& frame) {
    const gripper::FrameBytes all = gripper::encode(frame);
    return {all.bytes.begin(), all.bytes.begin() + static_cast<std::ptrdiff_t>(all.size)};
}

gripper::SampleFrame sample(std::uint64_t n) {
    const Random random{n};
    gripper::SampleFrame s;
    s.slips = {(n & 1) != 0, (n & 2) != 0};
    s.limited = {(n & 4) != 0, (n & 8) != 0};
    s.holds = (n & 16) != 0;
    s.fingers = static_cast<std::uint8_t>(1 + n % 2);
    s.answers = static_cast<std::uint16_t>(random.bits(1));
    s.encoder = {static_cast<std::int32_t>(random.bits(2)), static_cast<std::int32_t>(random.bits(3))};
    s.gauge = {static_cast<std::int32_t>(random.bits(4)), static_cast<std::int32_t>(random.bits(5))};
    return s;
}

bool same(const gripper::SampleFrame& a, const gripper::SampleFrame& b) {
    return a.slips == b.slips && a.limited == b.limited && a.holds == b.holds && a.fingers == b.fingers &&
           a.answers == b.answers && a.encoder == b.encoder && a.gauge == b.gauge;
}

}  // namespace

TEST_CASE("the checksum is CRC-32") {
    const std::string_view check = "123456789";
    CHECK(gripper::crc32({reinterpret_cast<const std::uint8_t*>(check.data()), check.size()}) == 0xCBF43926u);
}

TEST_CASE("frames come back as they were sent, one after the other") {
    gripper::FrameReader reader;
    std::uint64_t seen = 0;
    for (std::uint64_t n = 0; n < 200; ++n) {
        for (const std::uint8_t byte : bytes_of(gripper::pack(sample(n), static_cast<std::uint16_t>(n)))) {
            if (!reader.take(byte)) continue;
            gripper::SampleFrame back;
            REQUIRE(gripper::unpack(reader.frame(), back));
            CHECK(same(back, sample(n)));
            CHECK(reader.frame().sequence == n);
            ++seen;
        }
    }
    CHECK(seen == 200);
    CHECK(reader.counts().good == 200);
    CHECK(reader.counts().skipped_bytes == 0);
    const gripper::DriveFrame drive{true, true, {-70000, 12345}, -25000};
    gripper::DriveFrame back;
    REQUIRE(gripper::unpack(gripper::pack(drive, 7), back));
    CHECK((back.run && back.free && back.speed_um_s == drive.speed_um_s && back.cord_um == -25000));
    gripper::SampleFrame wrong;
    CHECK_FALSE(gripper::unpack(gripper::pack(drive, 7), wrong));
}

TEST_CASE("of 100 000 broken frames none gets through, and the good ones between them all do") {
    const Random random{11};
    gripper::FrameReader reader;
    std::uint64_t draw = 0, good_sent = 0, good_seen = 0, foreign = 0;
    const auto next = [&] { return random.bits(draw++); };
    const auto feed = [&](const std::vector<std::uint8_t>& bytes) {
        for (const std::uint8_t byte : bytes) {
            if (!reader.take(byte)) continue;
            gripper::SampleFrame back;
            const std::uint64_t n = reader.frame().sequence;
            if (gripper::unpack(reader.frame(), back) && same(back, sample(n))) ++good_seen;
            else ++foreign;
        }
    };
    for (std::uint64_t n = 0; n < 100'000; ++n) {
        std::vector<std::uint8_t> broken =
            bytes_of(gripper::pack(sample(n % 5000), static_cast<std::uint16_t>(n % 5000)));
        const std::vector<std::uint8_t> whole = broken;
        switch (next() % 5) {
            case 0:  // bits flip
                for (std::uint64_t k = 1 + next() % 6; k > 0; --k) {
                    const std::size_t at = next() % broken.size();
                    broken[at] ^= static_cast<std::uint8_t>(1u << next() % 8);
                }
                break;
            case 1: broken.resize(next() % broken.size()); break;  // cut off
            case 2:                                                             // bytes are lost
                broken.erase(broken.begin() + static_cast<std::ptrdiff_t>(next() % broken.size()));
                break;
            case 3:  // bytes come in between
            {
                const auto at = static_cast<std::ptrdiff_t>(1 + next() % (broken.size() - 1));
                broken.insert(broken.begin() + at, static_cast<std::uint8_t>(next()));
            } break;
            default:  // noise that begins like a frame
                for (std::size_t i = 2 + next() % 6; i < broken.size(); ++i)
                    broken[i] = static_cast<std::uint8_t>(next());
        }
        // One that was lengthened at its start still holds a whole frame.
        if (!std::ranges::search(broken, whole).empty()) continue;
        feed(broken);
        if (n % 10 != 9) continue;
        // Long enough a pause that what is left of a broken frame cannot swallow the good one.
        feed(std::vector<std::uint8_t>(gripper::max_payload + gripper::frame_overhead, 0));
        feed(bytes_of(gripper::pack(sample(n % 5000), static_cast<std::uint16_t>(n % 5000))));
        ++good_sent;
    }
    CHECK(foreign == 0);
    // A few broken ones are made whole by chance: the byte that was cut off is the first of the next frame.
    CHECK(good_seen >= good_sent);
    CHECK(good_seen < good_sent + 100);
    CHECK(reader.counts().bad_checksum > 10'000);
    CHECK(reader.counts().bad_header > 1'000);
}
