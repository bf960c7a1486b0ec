// SPDX-License-Identifier: Apache-2.0
// A serial line whose other end reads late, and one that two programs want.
#include "devices/gripper/serial_port.hpp"

#include "tests/support/catch.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <string>
#include <vector>

using namespace tactus;
using gripper::SerialPort;

namespace {

/// A pseudo-terminal: the other end of the line.
struct Line {
    int master = -1;
    std::string path;

    Line() {
        master = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
        REQUIRE(master >= 0);
        ::grantpt(master);
        ::unlockpt(master);
        char name[128] = {};
        ::ptsname_r(master, name, sizeof name);
        path = name;
        termios line{};
        ::tcgetattr(master, &line);
        ::cfmakeraw(&line);
        ::tcsetattr(master, TCSANOW, &line);
    }
    ~Line() {
        if (master >= 0) ::close(master);
    }
    /// Up to `most` bytes that have arrived.
    void read_into(std::vector<std::uint8_t>& all, std::size_t most) const {
        std::vector<std::uint8_t> bytes(most);
        const ssize_t count = ::read(master, bytes.data(), bytes.size());
        if (count > 0) all.insert(all.end(), bytes.begin(), bytes.begin() + count);
    }
};

}  // namespace

TEST_CASE("a message that a full line takes in parts arrives whole, and none is within another") {
    const Line line;
    SerialPort port;
    REQUIRE(port.open(line.path, 115200).empty());
    std::vector<std::uint8_t> arrived;
    std::uint8_t next = 0;  // each message holds its number in all of its ten bytes
    int taken = 0, refused = 0;
    for (int round = 0; round < 20; ++round) {
        for (int again = 0; again < 4;) {
            std::array<std::uint8_t, 10> message;
            message.fill(next);
            if (port.send(message)) {
                ++next;
                ++taken;
            } else {
                ++again;
                ++refused;
            }
            REQUIRE(taken < 1'000'000);
        }
        line.read_into(arrived, 701);
    }
    CHECK(refused >= 80);
    for (int quiet = 0; quiet < 20; ++quiet) {
        const std::size_t before = arrived.size();
        line.read_into(arrived, 4096);
        if (arrived.size() > before) quiet = 0;
        else ::usleep(1000);
        port.send({});  // what was begun is finished
    }
    REQUIRE(arrived.size() == 10 * static_cast<std::size_t>(taken));
    std::size_t broken = 0;
    for (std::size_t i = 0; i < arrived.size(); ++i) broken += arrived[i] == static_cast<std::uint8_t>(i / 10) ? 0 : 1;
    CHECK(broken == 0);
}

TEST_CASE("one line belongs to one driver: another is refused until the first has closed it") {
    const Line line;
    SerialPort first, second;
    REQUIRE(first.open(line.path, 115200).empty());
    CHECK_THAT(second.open(line.path, 115200), Catch::Matchers::ContainsSubstring(line.path + " is in use"));
    CHECK_FALSE(second.is_open());
    CHECK(first.is_open());
    first.close();
    CHECK(second.open(line.path, 115200).empty());
}

TEST_CASE("a line that is lost is closed, and takes nothing") {
    Line line;
    SerialPort port;
    REQUIRE(port.open(line.path, 115200).empty());
    ::close(line.master);
    line.master = -1;
    const std::array<std::uint8_t, 3> message{1, 2, 3};
    CHECK_FALSE(port.send(message));
    CHECK_FALSE(port.is_open());
}
