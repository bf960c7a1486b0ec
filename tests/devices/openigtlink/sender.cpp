// SPDX-License-Identifier: Apache-2.0
#include "devices/openigtlink/sender.hpp"

#include "devices/openigtlink/message.hpp"
#include "devices/openigtlink/tracker.hpp"
#include "dsp/core/error.hpp"
#include "tests/devices/driver/peer.hpp"
#include "tests/devices/hosted/with_host.hpp"
#include "tests/support/catch.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>
#include <string>
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

TEST_CASE("what one program sends another follows", "[live]") {
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
    for (std::size_t i = 0; i < TransformServer::most_clients + 8; ++i) {
        files.push_back(connected(server->port()));
        server->send(message);
    }
    for (std::size_t i = 0; i < files.size(); ++i) {
        std::uint8_t bytes[4096];
        CHECK((::recv(files[i], bytes, sizeof bytes, 0) > 0) == (i < TransformServer::most_clients));
        ::close(files[i]);
    }
}
