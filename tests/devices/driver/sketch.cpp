// SPDX-License-Identifier: Apache-2.0
// The sketch for boards, compiled for this machine and told frames by the driver's own side.
#include "devices/board/lines.hpp"
#include "tests/support/catch.hpp"

#include <cstring>
#include <deque>
#include <vector>

namespace sketch {

using byte = std::uint8_t;
constexpr int A2 = 16, HIGH = 1, LOW = 0, OUTPUT = 1;

unsigned long now_ms = 1000;
int sensed = 100, driven = 0, direction = 0;
std::deque<byte> received;
std::vector<byte> sent;

unsigned long millis() { return now_ms; }
int analogRead(int) { return sensed; }
void analogWrite(int, int value) { driven = value; }
void digitalWrite(int, int value) { direction = value; }
void pinMode(int, int) {}
struct Line {
    void begin(long) {}
    int available() { return static_cast<int>(received.size()); }
    int read() {
        const byte first = received.front();
        received.pop_front();
        return first;
    }
    void write(const byte* bytes, std::size_t size) { sent.insert(sent.end(), bytes, bytes + size); }
} Serial;

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#include "devices/board/sketch/tactus_board/tactus_board.ino"
#pragma GCC diagnostic pop

}  // namespace sketch

using namespace tactus;

TEST_CASE("the sketch for boards answers the driver's frames, unwraps its sensor, and lets go after 20 ms") {
    sketch::setup();
    board::FrameProtocol line(1, 115200);
    const auto exchange = [&](double torque) {
        const auto request = line.request({torque, 0.0}, true);
        for (const std::uint8_t noise : {0x00, 0xA5, 0xA5}) sketch::received.push_back(noise);  // a line is never clean
        sketch::received.insert(sketch::received.end(), request.begin(), request.end());
        sketch::loop();
        line.take(sketch::sent, 0);
        sketch::sent.clear();
    };
    exchange(0.015);
    CHECK(line.told().count == 1);
    CHECK(line.told().serial == 1);
    CHECK(line.told().angle[0] == Approx(100 * 0.0000654).margin(1e-6));
    CHECK(sketch::driven == 127);
    CHECK(sketch::direction == 1);
    exchange(-0.03);
    CHECK(sketch::driven == 255);
    CHECK(sketch::direction == 0);
    sketch::sensed = 900;
    sketch::loop();  // through the seam of the magnet
    sketch::sensed = 400;
    sketch::loop();
    exchange(0.0);
    CHECK(line.told().angle[0] == Approx((400 - 1024) * 0.0000654).margin(1e-6));
    exchange(0.03);
    CHECK(sketch::driven == 255);
    sketch::now_ms += 21;
    sketch::loop();
    CHECK(sketch::driven == 0);
    const auto bad = line.request({0.03, 0.0}, true);
    std::vector<std::uint8_t> damaged(bad.begin(), bad.end());
    damaged[11] ^= 1;
    sketch::received.insert(sketch::received.end(), damaged.begin(), damaged.end());
    sketch::loop();
    CHECK(sketch::driven == 0);
}

TEST_CASE("Haply's first board is found again after noise and cut answers, within 20 ms of silence") {
    board::DiyProtocol line({});
    const auto answer = [](float first, float second) {
        std::vector<std::uint8_t> bytes{5};
        for (const float one : {first, second}) {
            std::uint8_t four[4];
            std::memcpy(four, &one, 4);
            bytes.insert(bytes.end(), four, four + 4);
        }
        return bytes;
    };
    constexpr std::int64_t silence = 5'000'000;
    line.take(answer(90.0f, 45.0f), silence);
    CHECK(line.told().count == 0);
    line.take(answer(91.0f, 45.0f), silence);
    CHECK(line.told().count == 1);
    CHECK(line.told().angle[1] == Approx(0.785398).margin(1e-6));
    std::vector<std::uint8_t> cut = answer(91.0f, 44.0f);
    cut.resize(6);
    line.take(cut, silence);
    line.take(answer(92.0f, 44.0f), silence);  // the rest never came: silence begins anew
    CHECK(line.told().count == 2);
    CHECK(line.told().angle[0] == Approx(1.605703).margin(1e-6));
    // A board that answers twice after a pause: what a cut answer and the next one make together is no angle.
    line.take(cut, silence);
    line.take(answer(92.0f, 44.0f), 0);
    CHECK(line.told().count == 2);
    CHECK(line.told().angle[0] == Approx(1.605703).margin(1e-6));
    line.take(answer(92.0f, 44.0f), silence);
    line.take(answer(92.0f, 44.0f), silence);
    CHECK(line.told().count >= 3);
    const auto before = line.told().count;
    line.take(std::vector<std::uint8_t>{7, 7, 7}, silence);
    line.take(answer(92.0f, 44.0f), 0);  // right behind noise: not believed
    CHECK(line.told().count == before);
    line.take(answer(1e9f, 44.0f), silence);
    CHECK(line.told().count == before);
    line.take(answer(1.0f, 1.0f), silence);  // a jump counts when the next answer says the same
    CHECK(line.told().count == before);
    line.take(answer(1.0f, 1.5f), silence);
    CHECK(line.told().count == before + 1);
    CHECK(line.told().angle[0] == Approx(0.017453).margin(1e-6));
}
