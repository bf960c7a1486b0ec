// SPDX-License-Identifier: Apache-2.0
// The kernel's event devices as a test has them: one device, whose effects belong to the file that uploaded them, end
// after their length, and are erased when it is closed.
#pragma once

#include "devices/evdev/event_system.hpp"
#include "tests/devices/driver/peer.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace tactus::test {

class FakeEvents final : public evdev::EventSystem {
public:
    struct Playing {
        ff_effect effect{};
        std::int64_t until_ns = 0;  ///< on steady_ns
    };

    FakeEvents() = default;
    /// Waits for a driver's thread that was left alone and still has a file of it.
    ~FakeEvents() override;
    int open(const std::string& path, int flags) noexcept override;
    void close(int file) noexcept override;
    int control(int file, unsigned long request, std::uintptr_t argument) noexcept override;
    bool wait(int file, int longest_ms) noexcept override;
    ssize_t read(int file, std::span<input_event> events) noexcept override;
    bool write(int file, const input_event& event) noexcept override;
    std::vector<std::string> devices() override;
    std::string attribute(const std::string& path, const std::string& name) override;

    /// The device says it, to every open file.
    void say(std::uint16_t type, std::uint16_t code, int value);
    /// The system has lost what it said before, and the device says this.
    void drop(std::uint16_t type, std::uint16_t code, int value);
    /// Effects that play now.
    std::vector<ff_effect> playing();
    std::size_t uploaded();  ///< effects that the device holds
    std::size_t open_files();

    // Before it is opened.
    std::string path = "/dev/input/event7", name = "Fake Wheel", serial = "W7", range = "900", stated_centring;
    std::map<unsigned, input_absinfo> axes;
    std::vector<unsigned> keys, effects;
    bool is_read_only = false;

    void unplug(bool on);
    std::atomic<bool> is_hung{false}, refuses{false};  ///< refuses: effects, with EIO
    std::atomic<int> gain{-1}, autocenter{-1}, uploads{0};

private:
    struct File {
        bool is_writable = false, is_lost = false;
        std::deque<input_event> events;
        std::map<int, Playing> effects;
    };
    void hang() const;
    File* find(int file);
    int answer_bits(unsigned kind, unsigned char* into, std::size_t size);
    int answer(File& file, unsigned long request, std::uintptr_t argument);
    int upload(File& file, ff_effect& effect);
    void tell(std::uint16_t type, std::uint16_t code, int value, bool is_dropped);

    std::atomic<bool> is_away_{false};
    std::mutex mutex_;
    std::map<int, File> files_;
    std::map<unsigned, int> held_;
    int next_file_ = 1000, next_effect_ = 0;
};

std::unique_ptr<Peer> make_wheel_peer();

}  // namespace tactus::test
