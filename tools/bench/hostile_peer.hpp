// SPDX-License-Identifier: Apache-2.0
// Programs at the other end of a socket or a line that behave badly on purpose.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace tactus::bench {

enum class Line { web_socket, openigtlink, serial };
enum class Attack {
    none,   ///< it behaves
    half,   ///< messages that stop in the middle; a connection is closed then
    huge,   ///< 16 MB that claim to be one message
    slow,   ///< a byte each 10 ms, for ever
    flood,  ///< whole messages as fast as the line takes them
};

/// Behaves for a tenth of a second after each connection, so that a driver opens it, and attacks then.
class HostilePeer {
public:
    /// `priority`: real-time, of its thread, where the system permits it; 0: none. Throws Error when there is no free port
    /// or terminal.
    HostilePeer(Line line, Attack attack, int priority = 0);
    ~HostilePeer();
    HostilePeer(const HostilePeer&) = delete;
    HostilePeer& operator=(const HostilePeer&) = delete;

    int port() const { return port_; }  ///< on loopback
    const std::string& path() const { return path_; }  ///< of the terminal
    std::uint64_t bytes() const { return bytes_; }  ///< sent
    std::uint64_t connections() const { return connections_; }
    std::int64_t answers() const { return answers_; }  ///< to what a driver asked of a WebSocket
    /// When its thread ran last, on steady_ns. It runs every 5 ms unless the machine does not let it.
    std::int64_t ran_ns() const { return ran_ns_; }
    /// Ends its thread.
    void stop();
    /// After `stop`, of a WebSocket: ns from each message to what the driver says next.
    const std::vector<std::int64_t>& replies_ns() const { return replies_ns_; }

private:
    void run_server();
    void run_terminal();
    void serve(int client);
    bool send(int file, const std::string& bytes);
    /// What is answered to what came; for the protocol.
    void answer(int file, const std::string& heard);
    bool attack(int file);

    Line line_;
    Attack attack_;
    int priority_;
    int file_ = -1, port_ = 0;
    std::string path_;
    struct Speaker;
    std::unique_ptr<Speaker> speaker_;
    std::atomic<bool> ends_{false};
    std::atomic<std::uint64_t> bytes_{0}, connections_{0};
    std::atomic<std::int64_t> answers_{0}, ran_ns_{0};
    std::int64_t told_ns_ = 0;
    std::vector<std::int64_t> replies_ns_;
    std::thread thread_;
};

}  // namespace tactus::bench
