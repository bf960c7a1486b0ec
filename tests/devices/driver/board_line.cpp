// SPDX-License-Identifier: Apache-2.0
// Boards on a line that loses, delays and adds bytes.
#include "dsp/core/clock.hpp"
#include "tests/devices/driver/board_peer.hpp"
#include "tests/devices/hosted/with_host.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <vector>

using namespace tactus;
using namespace tactus::test;

namespace {

const Vec3 place{0.012, -0.1, 0.0};

std::vector<PeerKind> boards() { return {{"serial_board", make_frame_board_peer}, {"haply_2diy", make_diy_peer}}; }

bool waits_for_valid(HapticDevice& device) {
    return wait_until([&] {
        device.commit({});
        return device.acquire(1e-3).valid;
    });
}

}  // namespace

TEST_CASE("a line that cuts, drops, delays and adds bytes costs samples of a board, never truth", "[kernel]") {
    for (const PeerKind& kind : boards()) {
        CAPTURE(kind.driver);
        const auto board = kind.make();
        board->place(place, {1.0, 0.0, 0.0, 0.0});
        const auto device = open_peer(*board);
        REQUIRE(waits_for_valid(*device));
        LineFaults& faults = faults_of(*board);
        faults.cut_percent = faults.drop_percent = faults.noise_percent = 10;
        faults.late_answers = 1;
        int valid = 0;
        double off = 0.0;
        const std::int64_t before = device->published();
        for (int i = 0; i < 700; ++i) {
            device->commit({});
            if (const DeviceSample sample = device->acquire(1e-3); sample.valid) {
                ++valid;
                off = std::max(off, glm::length(sample.pose.position - place));
            }
            sleep_until(steady_ns() + ms);
        }
        CHECK(off < 1e-6);
        CHECK(valid > 50);  // how many is a matter of the machine, too
        CHECK(device->published() - before > 50);
        CHECK(device->returns() == 0);
        faults.cut_percent = faults.drop_percent = faults.noise_percent = 0;
        faults.late_answers = 0;
        CHECK(waits_for_valid(*device));
    }
}

TEST_CASE("a board is understood again within 20 ms after noise on its line", "[live]") {
    for (const PeerKind& kind : boards()) {
        CAPTURE(kind.driver);
        const auto board = kind.make();
        board->place(place, {1.0, 0.0, 0.0, 0.0});
        const auto device = open_peer(*board);
        REQUIRE(waits_for_valid(*device));
        std::vector<std::int64_t> took;
        for (int i = 0; i < 11; ++i) {
            faults_of(*board).burst = 64;
            const std::int64_t begin = steady_ns();
            while (faults_of(*board).burst != 0 && steady_ns() - begin < 500 * ms) sleep_until(steady_ns() + ms / 8);
            // The first answer may have been on its way before the noise.
            const std::int64_t heard = device->published();
            while (device->published() < heard + 3 && steady_ns() - begin < 500 * ms) {
                device->commit({});
                sleep_until(steady_ns() + ms / 8);
            }
            took.push_back(steady_ns() - begin);
        }
        std::ranges::sort(took);
        CAPTURE(took.front(), took.back());
        CHECK(took[took.size() / 2] < 20 * ms);  // one that is late shows a loaded machine
        CHECK(device->returns() == 0);
    }
}

TEST_CASE("torques do not wait in a slow line: a board at 115200 baud gives a new force within 40 ms", "[live]") {
    for (const PeerKind& kind : boards()) {
        CAPTURE(kind.driver);
        const auto board = kind.make();
        board->place(place, {1.0, 0.0, 0.0, 0.0});
        faults_of(*board).bytes_per_s = 11'520;
        // The energy cap counts on two exchanges of both frames, 54 bytes of 10 bits, and a round of 1 ms.
        CHECK(board->backend()->outline().info.delay ==
              Approx(kind.driver == std::string("serial_board") ? 1080.0 / 115'200.0 + 1e-3 : 3e-3));
        const auto device = open_peer(*board);
        REQUIRE(waits_for_valid(*device));
        std::vector<std::int64_t> took;
        for (int i = 0; i < 3; ++i) {
            const double wanted = i % 2 == 0 ? 0.3 : -0.3;
            const std::int64_t begin = steady_ns();
            // For long enough that a line which is told too often would be full.
            std::int64_t given = 0;
            while (steady_ns() - begin < 400 * ms) {
                device->commit({{0.0, wanted, 0.0}, {}});
                device->acquire(1e-3);
                if (given == 0 && board->given().force.y * wanted > 0.02) given = steady_ns() - begin;
                sleep_until(steady_ns() + ms);
            }
            took.push_back(given == 0 ? 400 * ms : given);
        }
        std::ranges::sort(took);
        CAPTURE(took.front(), took.back());
        CHECK(took[took.size() / 2] < 40 * ms);  // one that is late shows a loaded machine
    }
}
