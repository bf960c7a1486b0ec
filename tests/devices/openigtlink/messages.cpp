// SPDX-License-Identifier: Apache-2.0
// Messages as libopenigtlink 1.11 writes them: the pose 0.5 rad about z at (12.5, -40, 250.25) mm.
#include "devices/openigtlink/message.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

using namespace tactus;
using namespace tactus::openigtlink;

namespace {

using Bytes = std::vector<std::uint8_t>;

const std::string transform =
    "00015452414e53464f524d0000005374796c7573546f547261636b657200000000006553f1003fffffff0000000000000030"
    "543f2587cc2f89543f60a9403ef5774400000000bef577443f60a9400000000000000000000000003f80000041480000c220"
    "0000437a4000";
const std::string position =
    "0001504f534954494f4e000000004e6565646c6500000000000000000000000000006553f1003fffffff000000000000001c"
    "19e60bd1660bb6c041480000c2200000437a400000000000000000003e7d57773f780aa5";
const std::string short_position =
    "0001504f534954494f4e000000004e6565646c6500000000000000000000000000006553f1003fffffff0000000000000018"
    "023b1ccac342a08b41480000c2200000437a400000000000000000003e7d5777";
const std::string tracking =
    "0001544441544100000000000000547261636b6572000000000000000000000000006553f1003fffffff000000000000008c"
    "38f25728e4d6b32b4f7468657200000000000000000000000000000002003f8000000000000000000000000000003f800000"
    "0000000000000000000000003f8000000000000000000000000000005374796c7573546f547261636b657200000000000200"
    "3f60a9403ef5774400000000bef577443f60a9400000000000000000000000003f80000041480000c2200000437a4000";

Bytes bytes_of(const std::string& hex) {
    Bytes bytes;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
        bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
    return bytes;
}

std::optional<Message> only(const Bytes& bytes) {
    MessageReader reader;
    reader.take(bytes);
    return reader.next();
}

void check_pose(const std::optional<Pose>& pose) {
    REQUIRE(pose);
    CHECK(glm::length(pose->position - Vec3(0.0125, -0.04, 0.25025)) < 1e-9);
    CHECK(pose->orientation.z == Approx(std::sin(0.25)).margin(1e-6));
    CHECK(pose->orientation.w == Approx(std::cos(0.25)).margin(1e-6));
}

/// A body of version 2 about that of `message`: extended header, content, metadata with one entry.
Bytes with_metadata(Bytes message, const std::string& key, const std::string& value) {
    const auto append = [](Bytes& to, std::uint64_t number, std::size_t size) {
        for (std::size_t i = size; i-- > 0;) to.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
    };
    Bytes body;
    append(body, 12, 2);                          // size of the extended header
    append(body, 2 + 8, 2);                       // of the metadata's header
    append(body, key.size() + value.size(), 4);   // of its texts
    append(body, 7, 4);                           // number of the message
    body.insert(body.end(), message.begin() + 58, message.end());
    append(body, 1, 2);
    append(body, key.size(), 2);
    append(body, 3, 2);
    append(body, value.size(), 4);
    body.insert(body.end(), key.begin(), key.end());
    body.insert(body.end(), value.begin(), value.end());
    Bytes whole(message.begin(), message.begin() + 42);
    whole[1] = 2;
    append(whole, body.size(), 8);
    append(whole, crc64(body), 8);
    whole.insert(whole.end(), body.begin(), body.end());
    return whole;
}

}  // namespace

TEST_CASE("the checksum is CRC-64 of ECMA-182") {
    const std::string digits = "123456789";
    CHECK(crc64({reinterpret_cast<const std::uint8_t*>(digits.data()), digits.size()}) == 0x6C40DF5F0B497347u);
}

TEST_CASE("libopenigtlink's checksum of any bytes is ours") {
    void* const library = ::dlopen("libOpenIGTLink.so.1.11", RTLD_NOW | RTLD_LOCAL);
    if (!library) return tactus::test::skip("libopenigtlink1.11 is not installed");
    const auto theirs =
        reinterpret_cast<std::uint64_t (*)(unsigned char*, std::uint64_t, std::uint64_t)>(::dlsym(library, "crc64"));
    REQUIRE(theirs);
    const Random random{5};
    for (std::size_t i = 0; i < 1000; ++i) {
        Bytes bytes(i);
        for (std::size_t k = 0; k < i; ++k) bytes[k] = static_cast<std::uint8_t>(random.bits(1000 * i + k));
        REQUIRE(crc64(bytes) == theirs(bytes.data(), bytes.size(), 0));
    }
}

TEST_CASE("poses of another program's messages are read: transforms, positions, several tools") {
    check_pose(pose_in(*only(bytes_of(transform)), ""));
    check_pose(pose_in(*only(bytes_of(transform)), "StylusToTracker"));
    CHECK_FALSE(pose_in(*only(bytes_of(transform)), "Stylus"));
    check_pose(pose_in(*only(bytes_of(position)), "Needle"));
    check_pose(pose_in(*only(bytes_of(short_position)), "Needle"));
    check_pose(pose_in(*only(bytes_of(tracking)), "StylusToTracker"));
    CHECK(pose_in(*only(bytes_of(tracking)), "")->position == Vec3(0.0));  // the first tool
    CHECK_FALSE(pose_in(*only(bytes_of(tracking)), "Tracker"));
}

TEST_CASE("a transform is written as another program writes it") {
    Pose pose;
    pose.position = {0.0125, -0.04, 0.25025};
    pose.orientation = {std::cos(0.25), 0.0, 0.0, std::sin(0.25)};
    const Bytes mine = transform_message("StylusToTracker", pose, 1700000000.25), theirs = bytes_of(transform);
    REQUIRE(mine.size() == theirs.size());
    // All but the last bits of the time's fraction, of cosine and sine, and hence the checksum.
    for (const auto& [begin, end] : {std::pair{0, 38}, {42, 50}})
        CHECK(std::equal(mine.begin() + begin, mine.begin() + end, theirs.begin() + begin));
    check_pose(pose_in(*only(mine), "StylusToTracker"));
}

TEST_CASE("a tool that the tracker does not see has no pose") {
    const Bytes plain = bytes_of(transform);
    check_pose(pose_in(*only(with_metadata(plain, "StylusToTrackerStatus", "OK")), ""));
    check_pose(pose_in(*only(with_metadata(plain, "Colour", "MISSING")), ""));
    CHECK_FALSE(pose_in(*only(with_metadata(plain, "StylusToTrackerStatus", "MISSING")), ""));
}

TEST_CASE("messages are put together from any pieces, and one with a wrong checksum is left out") {
    Bytes stream = bytes_of(transform), broken = stream;
    broken[80] ^= 1;
    stream.insert(stream.end(), broken.begin(), broken.end());
    const Bytes last = bytes_of(position);
    stream.insert(stream.end(), last.begin(), last.end());
    for (std::size_t piece = 1; piece < 200; piece += 7) {
        MessageReader reader;
        std::string types;
        for (std::size_t at = 0; at < stream.size(); at += piece) {
            reader.take(std::span(stream).subspan(at, std::min(piece, stream.size() - at)));
            while (const auto message = reader.next()) types += message->type + " ";
        }
        CHECK(types == "TRANSFORM POSITION ");
        CHECK(reader.bad_checksums() == 1);
    }
}

TEST_CASE("a matrix that is no rotation, a length beyond reason and another protocol are refused") {
    const auto with_cell = [](std::size_t cell, float value) {
        Bytes message = bytes_of(transform);
        const auto bits = std::bit_cast<std::uint32_t>(value);
        for (std::size_t i = 0; i < 4; ++i)
            message[58 + 4 * cell + i] = static_cast<std::uint8_t>(bits >> (24 - 8 * i));
        const std::uint64_t sum = crc64(std::span(message).subspan(58));
        for (std::size_t i = 0; i < 8; ++i) message[50 + i] = static_cast<std::uint8_t>(sum >> (56 - 8 * i));
        return pose_in(*only(message), "");
    };
    CHECK(with_cell(11, 1.0f));
    CHECK_FALSE(with_cell(8, -1.0f));  // a mirror
    CHECK_FALSE(with_cell(0, 0.2f));
    CHECK_FALSE(with_cell(4, NAN));
    CHECK_FALSE(with_cell(9, INFINITY));
    Bytes huge = bytes_of(transform);
    huge[43] = 0x7f;
    MessageReader reader;
    reader.take(huge);
    CHECK_FALSE(reader.next());
    CHECK(reader.is_broken());
    MessageReader web;
    const std::string request = "GET / HTTP/1.1\r\nHost: here\r\nUser-Agent: somebody who is lost\r\n\r\n";
    web.take({reinterpret_cast<const std::uint8_t*>(request.data()), request.size()});
    CHECK_FALSE(web.next());
    CHECK(web.is_broken());
}

TEST_CASE("damaged messages give a valid pose or none") {
    const Random random{7};
    std::uint64_t draw = 0;
    const std::vector<Bytes> seeds{bytes_of(transform), bytes_of(position), bytes_of(tracking),
                                   with_metadata(bytes_of(transform), "ToolStatus", "OK")};
    for (int round = 0; round < 20'000; ++round) {
        Bytes bytes = seeds[static_cast<std::size_t>(round) % seeds.size()];
        for (std::uint64_t i = random.bits(draw++) % 4 + 1; i > 0; --i) {
            const std::size_t at = random.bits(draw++) % bytes.size();
            bytes[at] = static_cast<std::uint8_t>(random.bits(draw++));
        }
        // With the right sum, so that the content is read.
        const std::uint64_t sum = crc64(std::span(bytes).subspan(58));
        for (std::size_t i = 0; i < 8; ++i) bytes[50 + i] = static_cast<std::uint8_t>(sum >> (56 - 8 * i));
        MessageReader reader;
        reader.take(bytes);
        while (const auto message = reader.next())
            if (const auto pose = pose_in(*message, "")) CHECK(is_valid(*pose));
    }
}
