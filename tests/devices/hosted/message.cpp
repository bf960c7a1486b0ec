// SPDX-License-Identifier: Apache-2.0
#include "devices/hosted/message.hpp"

#include "tests/support/catch.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <string>

using namespace tactus;
using namespace tactus::hosted;
using namespace std::chrono_literals;

namespace {

struct Pair {
    Pair() { REQUIRE(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) == 0); }
    ~Pair() {
        for (const int end : ends)
            if (end >= 0) ::close(end);
    }
    int ends[2] = {-1, -1};
};

}  // namespace

TEST_CASE("words arrive as they were sent, empty and binary ones too") {
    const Pair pair;
    const Words words{"open", "", std::string("a\0b\n", 4), std::string(50'000, 'x')};
    send(pair.ends[0], words);
    const Received heard = receive(pair.ends[1], 0ms);
    CHECK(heard.kind == Received::words);
    CHECK(heard.said == words);
    CHECK(receive(pair.ends[1], 0ms).kind == Received::nothing);
}

TEST_CASE("a packet that is no list of words counts as a closed socket") {
    for (const std::string& garbage : {std::string("\xff\xff\xff\xffopen", 8), std::string("\x05\0\0\0open", 8),
                                       std::string("ab"), std::string("\x04\0\0\0open\x01", 9)}) {
        const Pair pair;
        REQUIRE(::send(pair.ends[0], garbage.data(), garbage.size(), 0) == static_cast<ssize_t>(garbage.size()));
        CHECK(receive(pair.ends[1], 0ms).kind == Received::closed);
    }
    Pair pair;
    ::close(pair.ends[0]);
    pair.ends[0] = -1;
    CHECK(receive(pair.ends[1], 10s).kind == Received::closed);
    CHECK_NOTHROW(send(pair.ends[1], {"to nobody"}));
}

TEST_CASE("words that are too long for a message are an error, not a part of one") {
    const Pair pair;
    CHECK_THROWS_AS(send(pair.ends[0], {std::string(longest_message, 'x')}), Error);
    CHECK(receive(pair.ends[1], 0ms).kind == Received::nothing);
}

TEST_CASE("an error keeps its place on the way to the engine") {
    const Error there({"p.toml", 3, 12}, "no such thing"), nowhere("no place");
    CHECK(std::string(error_of(error_words(there)).what()) == "p.toml:3:12: no such thing");
    CHECK(std::string(error_of(error_words(nowhere)).what()) == "no place");
    CHECK_THROWS_AS(error_of({say_error, "p.toml"}), Error);
    CHECK_THROWS_AS(error_of({say_error, "p.toml", "three", "1", "x"}), Error);
}
