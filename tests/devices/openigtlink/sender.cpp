// SPDX-License-Identifier: Apache-2.0
#include "devices/openigtlink/sender.hpp"

#include "devices/openigtlink/message.hpp"
#include "devices/openigtlink/tracker.hpp"
#include "dsp/core/error.hpp"
#include "tests/devices/driver/peer.hpp"
#include "tests/devices/hosted/with_host.hpp"
#include "tests/support/catch.hpp"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>
#include <array>
#include <string>
#include <utility>
#include <vector>

using namespace tactus;
using namespace tactus::test;
using openigtlink::TransformServer;

namespace {

int connected(int port) {
    const int file = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    REQUIRE(::connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    return file;
}

/// This process's connections from and to a port: how many there are, and how many ask whether a silent peer is there.
std::pair<int, int> kept_alive(int port, bool is_own_end) {
    int all = 0, alive = 0;
    for (int file = 0; file < 1024; ++file) {
        sockaddr_in own{}, other{};
        socklen_t own_size = sizeof own, other_size = sizeof other;
        if (::getsockname(file, reinterpret_cast<sockaddr*>(&own), &own_size) != 0 || own.sin_family != AF_INET ||
            ::getpeername(file, reinterpret_cast<sockaddr*>(&other), &other_size) != 0)
            continue;
        if (ntohs((is_own_end ? own : other).sin_port) != port) continue;
        ++all;
        std::array<int, 4> told{};
        const std::array<std::pair<int, int>, 4> asked{{{SOL_SOCKET, SO_KEEPALIVE},
                                                        {IPPROTO_TCP, TCP_KEEPIDLE},
                                                        {IPPROTO_TCP, TCP_KEEPINTVL},
                                                        {IPPROTO_TCP, TCP_KEEPCNT}}};
        for (std::size_t i = 0; i < asked.size(); ++i) {
            socklen_t size = sizeof told[i];
            ::getsockopt(file, asked[i].first, asked[i].second, &told[i], &size);
        }
        alive += told[0] != 0 && told[1] + told[2] * told[3] <= 5 ? 1 : 0;  // s
    }
    return {all, alive};
}

Pose at(double x) {
    Pose pose;
    pose.position = {x, 0.0, -0.1};
    return pose;
}

void put(StreamKeeper& sender, const std::vector<Pose>& poses) {
    sender.take(0, reinterpret_cast<const std::byte*>(poses.data()), poses.size());
    sender.save();
}

}  // namespace

TEST_CASE("each client gets the newest pose of every sender at the port") {
    const int port = TransformServer::at("127.0.0.1", 0)->port();
    const auto needle = openigtlink::make_sender("127.0.0.1", port, "Needle");
    const auto bone = openigtlink::make_sender("127.0.0.1", port, "Bone");
    needle->open({});
    bone->open({});
    const int one = connected(port), two = connected(port);
    put(*needle, {at(0.1), at(0.2), at(0.3)});
    put(*bone, {at(0.7)});
    put(*bone, {});  // nothing new, nothing sent
    needle->finish();
    bone->finish();
    for (const int file : {one, two}) {
        openigtlink::MessageReader reader;
        std::uint8_t bytes[4096];
        for (ssize_t n; (n = ::read(file, bytes, sizeof bytes)) > 0;) reader.take({bytes, static_cast<std::size_t>(n)});
        std::vector<std::string> got;
        while (const auto message = reader.next())
            got.push_back(message->device + " " + std::to_string(pose_in(*message, "")->position.x));
        CHECK(got == std::vector<std::string>{"Needle 0.300000", "Bone 0.700000"});
        ::close(file);
    }
}

TEST_CASE("a client that does not read or goes away holds nobody up") {
    const auto server = TransformServer::at("127.0.0.1", 0);
    const int lazy = connected(server->port()), gone = connected(server->port());
    const std::vector<std::uint8_t> message = openigtlink::transform_message("Needle", at(0.1), 0.0);
    server->send(message);
    ::close(gone);
    // The system keeps some megabytes for a client; then the backlog counts.
    for (int i = 0; i < 200'000; ++i) server->send(message);
    const int other = connected(server->port());
    server->send(message);
    std::uint8_t bytes[256];
    CHECK(::read(other, bytes, sizeof bytes) == static_cast<ssize_t>(message.size()));
    ::close(other);
    ::close(lazy);
}

TEST_CASE("a port that another program has is named") {
    const auto server = TransformServer::at("127.0.0.1", 0);
    const auto sender = openigtlink::make_sender("0.0.0.0", server->port(), "Needle");
    CHECK_THROWS_WITH(sender->open({}), Catch::Matchers::ContainsSubstring("cannot serve OpenIGTLink at 0.0.0.0:" +
                                                                           std::to_string(server->port())));
    CHECK_THROWS_WITH(openigtlink::make_sender("here", 0, "Needle")->open({}),
                      Catch::Matchers::ContainsSubstring("'here' is no address"));
}

TEST_CASE("what one program sends another follows", "[kernel]") {
    const auto server = TransformServer::at("127.0.0.1", 0);
    Options options = options_of({{"port", std::to_string(server->port()), {}}});
    driver::ThreadedDevice device(openigtlink::make_tracker(options), {.driver = "openigtlink"});
    device.prepare(1e-3);
    CHECK(wait_until([&] {
        server->send(openigtlink::transform_message("Needle", at(0.25), 0.0));
        const DeviceSample sample = device.acquire(1e-3);
        return sample.valid && glm::length(sample.pose.position - at(0.25).position) < 1e-7;
    }));
}

TEST_CASE("a server that too many connect to hangs up on the rest, and goes on to serve the first ones") {
    const auto server = TransformServer::at("127.0.0.1", 0);
    const auto message = openigtlink::transform_message("Needle", at(0.1), 0.0);
    std::vector<int> files;
    for (std::size_t i = 0; i < TransformServer::max_clients + 8; ++i) {
        files.push_back(connected(server->port()));
        server->send(message);
    }
    for (std::size_t i = 0; i < files.size(); ++i) {
        std::uint8_t bytes[4096];
        CHECK((::recv(files[i], bytes, sizeof bytes, 0) > 0) == (i < TransformServer::max_clients));
        ::close(files[i]);
    }
}

TEST_CASE("both ends of OpenIGTLink ask whether a silent peer is still there") {
    const auto server = TransformServer::at("127.0.0.1", 0);
    Options options = options_of({{"port", std::to_string(server->port()), {}}});
    const auto tracker = openigtlink::make_tracker(options);
    tracker->open(driver::OpenMode::run, std::make_shared<driver::Exchange>(), [](const std::string&) {});
    const int plain = connected(server->port());
    server->send(openigtlink::transform_message("Needle", at(0.1), 0.0));  // takes who has come
    CHECK(wait_until([&] { return kept_alive(server->port(), true).first == 2; }));
    CHECK(kept_alive(server->port(), true) == std::pair(2, 2));
    CHECK(kept_alive(server->port(), false) == std::pair(2, 1));  // of the two clients, the tracker
    tracker->close();
    ::close(plain);
}
