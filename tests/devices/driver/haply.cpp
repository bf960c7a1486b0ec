// SPDX-License-Identifier: Apache-2.0
// Haply's service: its messages, a WebSocket that is cut, flooded or far too long, and both names of a force.
#include "devices/board/serial_board.hpp"
#include "devices/haply/handshake.hpp"
#include "devices/haply/inverse3.hpp"
#include "devices/haply/inverse_messages.hpp"
#include "devices/haply/web_socket.hpp"
#include "devices/haptic/catalogue.hpp"
#include "dsp/core/clock.hpp"
#include "tests/devices/driver/service_peer.hpp"
#include "tests/devices/hosted/with_host.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/lateness_control.hpp"

#include <cmath>

using namespace tactus;
using namespace tactus::test;
using Catch::Matchers::ContainsSubstring;
using haply::MessageReader;

namespace {

std::string frame(int first, const std::string& payload) {
    std::string out(1, static_cast<char>(first));
    out += static_cast<char>(payload.size());
    return out + payload;
}

void add(MessageReader& reader, const std::string& bytes) { reader.add({bytes.data(), bytes.size()}); }

std::unique_ptr<driver::ThreadedDevice> open(const HaplyService& service, std::vector<OptionText> more = {}) {
    more.push_back({"port", std::to_string(service.port), {}});
    Options options = options_of(more);
    driver::DeviceOptions how{.driver = "haply", .is_untested = false};
    how.reopen_every = std::chrono::milliseconds(20);
    auto device = std::make_unique<driver::ThreadedDevice>(haply::make_inverse3(options), how);
    device->prepare(1e-3);
    return device;
}

}  // namespace

TEST_CASE("a WebSocket opens only with the answer to its own greeting") {
    // FIPS 180-4's "abc", and the example of RFC 6455, section 1.3.
    const auto sum = haply::sha1("abc");
    CHECK(sum[0] == 0xA9);
    CHECK(sum[1] == 0x99);
    CHECK(sum[19] == 0x9D);
    CHECK(haply::accept_for("dGhlIHNhbXBsZSBub25jZQ==") == "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
    CHECK(haply::handshake_key().size() == 24);
    CHECK(haply::handshake_key() != haply::handshake_key());
    const std::string key = haply::handshake_key();
    const auto answer = [](const std::string& accept, const std::string& more) {
        return "HTTP/1.1 101 Switching Protocols\r\nUPGRADE: WebSocket\r\nconnection: keep-alive, Upgrade\r\n"
               "Sec-WebSocket-Accept:  " +
               accept + " \r\n" + more;
    };
    CHECK(haply::refusal(answer(haply::accept_for(key), ""), key).empty());
    CHECK_THAT(haply::refusal(answer("s3pPLMBiTxaQ9kYGzzhZRbK+xOo=", ""), key), ContainsSubstring("Sec-WebSocket"));
    CHECK_THAT(haply::refusal("HTTP/1.1 101 x\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n", key),
               ContainsSubstring("Sec-WebSocket"));
    CHECK_THAT(haply::refusal("HTTP/1.1 101 x\r\n", key), ContainsSubstring("no WebSocket"));
    CHECK_THAT(haply::refusal("HTTP/1.1 400 Bad\r\n", key), ContainsSubstring("'HTTP/1.1 400 Bad'"));
    CHECK_THAT(haply::refusal(answer(haply::accept_for(key), "Sec-WebSocket-Extensions: permessage-deflate\r\n"), key),
               ContainsSubstring("extension"));
}

TEST_CASE("a server that answers another greeting, or never to the end, is no service", "[kernel]") {
    HaplyService impostor;
    impostor.is_impostor = true;
    CHECK_THROWS_WITH(open(impostor), ContainsSubstring("answers another greeting"));
    HaplyService slow;
    slow.slow_greeting = true;
    const std::int64_t begin = steady_ns();
    CHECK_THROWS_WITH(open(slow), ContainsSubstring("no service at"));
    CHECK(steady_ns() - begin < 4000 * ms);
}

TEST_CASE("who finds no service, no board or nothing to probe is told what to do") {
    const auto opened = [](std::unique_ptr<driver::Backend> backend) {
        driver::ThreadedDevice device(std::move(backend), {.driver = "test"});
    };
    Options service = options_of({{"port", "1", {}}}), board = options_of({{"port", "/dev/null", {}}});
    CHECK_THROWS_WITH(opened(haply::make_inverse3(service)), ContainsSubstring("is Haply's Inverse Service running?"));
    CHECK_THROWS_WITH(opened(board::make_serial_board(board)),
                      ContainsSubstring("/dev/null is not a serial line; ") && ContainsSubstring("/dev/ttyUSB"));
    Options none = options_of({});
    CHECK_THROWS_WITH(
        haptic::open_to_look("gamepad", none, driver::OpenMode::reading),
        ContainsSubstring("can only be tried in a run; --probe and --verify know: force_dimension, touch"));
}

TEST_CASE("a port that is no whole number is refused, not rounded") {
    Options options = options_of({{"port", "10001.5", {}}});
    CHECK_THROWS_WITH(haply::make_inverse3(options), ContainsSubstring("'port' is a whole number"));
}

TEST_CASE("messages of a WebSocket are put together from any pieces and any parts") {
    const std::string all =
        frame(0x01, "one ") + frame(0x89, "ping") + frame(0x00, "two ") + frame(0x80, "three") + frame(0x81, "next");
    MessageReader reader;
    std::vector<std::string> found;
    for (const char byte : all) {
        reader.add({&byte, 1});
        for (auto what = reader.next(); what != MessageReader::Found::nothing; what = reader.next()) {
            REQUIRE((what == MessageReader::Found::message || what == MessageReader::Found::ping));
            found.push_back(reader.text());
        }
    }
    CHECK(found == std::vector<std::string>{"ping", "one two three", "next"});
}

TEST_CASE("what no server may send breaks a WebSocket at once") {
    for (const std::string& bad :
         {std::string("\x81\x7f\0\0\0\0\1\0\0\0", 10), frame(0xC1, "x"), std::string("\x81\x81", 2), frame(0x80, "x"),
          std::string("\x09\x01", 2) + "x", std::string("\x89\x7e\x00\x80", 4), frame(0x83, "x")}) {
        MessageReader reader;
        add(reader, bad);
        CHECK(reader.next() == MessageReader::Found::broken);
        add(reader, frame(0x81, "good"));
        CHECK(reader.next() == MessageReader::Found::broken);
    }
    MessageReader parts;
    for (int i = 0; i < 2000; ++i) {
        add(parts, frame(i == 0 ? 0x01 : 0x00, std::string(100, 'x')));
        if (parts.next() == MessageReader::Found::broken) return;
    }
    FAIL("a message in parts has no end");
}

TEST_CASE("a client's frame is masked, and its length is written in the right form") {
    for (const std::size_t size : {std::size_t(5), std::size_t(125), std::size_t(126), std::size_t(70'000)}) {
        const std::string text(size, 'a'), out = haply::client_frame(1, text, 0x01020304u);
        const std::size_t head = out.size() - size;
        CHECK(head == (size < 126 ? 6u : size < 65536 ? 8u : 14u));
        CHECK((out[1] & 0x80) != 0);
        CHECK((out[head] ^ out[head - 4]) == 'a');
        CHECK((out[head + 3] ^ out[head - 1]) == 'a');
    }
}

TEST_CASE("a state of the Inverse Service is read, and changed axes are noticed") {
    const auto state = haply::read_inverse(
        R"({"version":"3.1.2","inverse3":[{"device_id":"A1","config":{"type":"minverse","mount":{"position":{"x":0,"y":0,"z":0}}},)"
        R"("state":{"cursor_position":{"x":0.01,"y":-0.02,"z":0.03}}}],)"
        R"("wireless_verse_grip":[{"state":{"orientation":{"w":0,"x":1,"y":0,"z":0},"buttons":{"a":false,"b":true,"c":true}}}]})");
    REQUIRE(state);
    CHECK(state->device == "A1");
    CHECK(state->type == "minverse");
    CHECK(state->version == "3.1.2");
    CHECK(state->has_pose);
    CHECK(state->reading.pose.position == Vec3(0.01, -0.02, 0.03));
    CHECK(state->reading.pose.orientation.x == 1.0);
    CHECK(state->reading.buttons == (4u | 8u));
    CHECK(state->changed_axes.empty());
    const auto changed = [](const std::string& config) {
        return haply::read_inverse(R"({"inverse3":[{"device_id":"A","config":{)" + config + "}}]}")->changed_axes;
    };
    CHECK(changed(R"("basis":{"permutation":"XZY"})") == "basis XZY");
    CHECK(changed(R"("mount":{"rotation":{"w":0.7,"x":0.7,"y":0,"z":0}})") == "a mount that is turned");
    CHECK(changed(R"("mount":{"position":{"x":0.1,"y":0,"z":0}})") == "a mount that is moved");
    for (const std::string bad : {"", "[]", "{", "{\"inverse3\":7}", "{\"inverse3\":[]}", "{\"inverse3\":[1e999]}"})
        CHECK_FALSE(haply::read_inverse(bad));
    CHECK_FALSE(
        haply::read_inverse(R"({"inverse3":[{"device_id":"A","state":{"cursor_position":{"x":"1"}}}]})")->has_pose);
}

TEST_CASE("a force is told by the name that the service's version knows") {
    CHECK(haply::force_key_of("3.1.0") == haply::ForceKey::values);
    CHECK(haply::force_key_of("3.5") == haply::ForceKey::vector);
    CHECK(haply::force_key_of("10.0.1") == haply::ForceKey::vector);
    CHECK(haply::force_key_of("") == haply::ForceKey::vector);
    CHECK(
        haply::force_text("A\"1", {0.5, -1.25, 0.0}, haply::ForceKey::vector, false) ==
        R"({"inverse3":[{"device_id":"A\"1","commands":{"set_cursor_force":{"vector":{"x":0.5,"y":-1.25,"z":0}}}}]})");
    CHECK_THAT(haply::force_text("A", {}, haply::ForceKey::values, true), ContainsSubstring("\"name\":\"tactus\""));
}

TEST_CASE("the service hears its own words, and the program's name once", "[kernel]") {
    for (const std::string version : {"3.5.0", "3.1.0"}) {
        HaplyService service;
        service.version = version;
        const auto device = open(service);
        CHECK(wait_until([&] { return service.texts > 20; }));
        CHECK(service.greetings == 1);
        CHECK(service.said_key == (version == "3.5.0" ? "vector" : "values"));
        CHECK(device->info().name == "Haply inverse3");
    }
    HaplyService turned;
    turned.basis = "XZY";
    CHECK_THROWS_WITH(open(turned), ContainsSubstring("the service has basis XZY"));
}

TEST_CASE("a service that lies, floods or hangs up is invalid for less than a second and delays no tick", "[live]") {
    using Trouble = HaplyService::Trouble;
    for (const Trouble trouble : {Trouble::huge, Trouble::bad_json, Trouble::half, Trouble::flood}) {
        CAPTURE(static_cast<int>(trouble));
        HaplyService service;
        const auto device = open(service);
        REQUIRE(wait_until([&] { return device->acquire(1e-3).valid; }));
        service.trouble = trouble;
        std::int64_t longest = 0;
        for (int i = 0; i < 300; ++i) {
            const std::int64_t begin = steady_ns();
            device->commit({});
            device->acquire(1e-3);
            longest = std::max(longest, steady_ns() - begin);
            sleep_until(steady_ns() + ms / 4);
        }
        CHECK(longest < 20 * ms);
        CHECK(wait_until([&] { return device->acquire(1e-3).valid; }, 1000));
    }
}

TEST_CASE("a service that stays silent, cut, far too long or no JSON is invalid, and back within a second", "[live]") {
    using Trouble = HaplyService::Trouble;
    for (const Trouble trouble : {Trouble::none, Trouble::huge, Trouble::bad_json, Trouble::half}) {
        CAPTURE(static_cast<int>(trouble));
        HaplyService service;
        Options options = options_of({{"port", std::to_string(service.port), {}}});
        // As a run has it, opened again four times a second.
        driver::ThreadedDevice device(haply::make_inverse3(options), {.driver = "haply", .is_untested = false});
        device.prepare(1e-3);
        REQUIRE(wait_until([&] { return device.acquire(1e-3).valid; }));
        service.lasts = true;
        service.trouble = trouble;
        service.is_silent = trouble == Trouble::none;
        const LatenessControl control;
        const std::int64_t begin = steady_ns();
        REQUIRE(wait_until([&] { return !device.acquire(1e-3).valid; }, 1000));
        const std::int64_t took = steady_ns() - begin;
        // 20 ms, one answer on the way, and each of the three threads may be as late as one that only sleeps.
        INFO("a sleeping thread was " << control.longest_ns() * 1e-6 << " ms late at most");
        CHECK(took < 40 * ms + 3 * control.longest_ns());
        int valid = 0;
        for (int i = 0; i < 300; ++i) {
            device.commit({});
            valid += device.acquire(1e-3).valid;
            sleep_until(steady_ns() + ms);
        }
        CHECK(valid == 0);
        service.lasts = service.is_silent = false;
        service.trouble = Trouble::none;
        CHECK(wait_until(
            [&] {
                device.commit({});
                return device.acquire(1e-3).valid;
            },
            1000));
    }
}
