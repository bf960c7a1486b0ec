// SPDX-License-Identifier: Apache-2.0
// Haply's Inverse Service as a test has it: a WebSocket on loopback that says one state for each text.
#pragma once

#include "tests/devices/driver/peer.hpp"

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace tactus::test {

class HaplyService {
public:
    enum class Trouble { none, huge, bad_json, half, flood };

    /// `wanted`: a port, or 0 for any. Throws when another program has it.
    explicit HaplyService(int wanted = 0);
    ~HaplyService();

    void move(const Vec3& position, const Quat& orientation);
    Vec3 given();

    int port = 0;
    std::atomic<std::uint32_t> buttons{0};
    std::atomic<bool> is_silent{false}, is_away{false}, is_nan{false};
    std::atomic<bool> is_impostor{false};     ///< answers a greeting that nobody sent
    std::atomic<bool> slow_greeting{false};  ///< of the next connection: its answer never ends
    std::atomic<Trouble> trouble{Trouble::none};  ///< of the next answer
    std::atomic<bool> lasts{false};               ///< of all that follow, too
    std::atomic<std::uint64_t> texts{0}, greetings{0};
    std::string version = "3.5.0", basis = "XYZ";  ///< before the driver opens it
    std::string said_key;                          ///< "vector" or "values", of the last text

private:
    static std::string frame(const std::string& text);
    std::string state();
    void accept(const std::string& text);
    void serve(int client);
    void run();

    int listener_ = -1;
    std::mutex mutex_;
    Vec3 position_{0.0}, force_{0.0};
    Quat orientation_{1.0, 0.0, 0.0, 0.0};
    std::int64_t heard_ns_ = 0;
    std::atomic<bool> ends_{false};
    std::thread thread_;
};

std::unique_ptr<Peer> make_haply_peer();

}  // namespace tactus::test
