// SPDX-License-Identifier: Apache-2.0
// An OpenIGTLink server that sends poses to 3D Slicer and other clients.
#pragma once

#include "graph/node/setup.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tactus::openigtlink {

/// A listening server. Several senders use the same one, and a client receives the transforms of all. The server never
/// waits: a client with a backlog of more than `longest_backlog` bytes is skipped.
class TransformServer {
public:
    static constexpr std::size_t longest_backlog = 65536;
    static constexpr std::size_t max_clients = 32;  ///< further ones are disconnected to save descriptors

    /// Returns the server of this process at that address and port; opens it if there is none. Any thread. Throws
    /// Error.
    static std::shared_ptr<TransformServer> at(const std::string& address, int port);
    ~TransformServer();
    TransformServer(const TransformServer&) = delete;
    TransformServer& operator=(const TransformServer&) = delete;

    /// Accepts new clients and sends the message to all. Any thread.
    void send(const std::vector<std::uint8_t>& message);
    int port() const { return port_; }  ///< for port 0: the port that the system assigned

private:
    struct Shared;
    TransformServer(const std::string& address, int port);

    int port_ = 0;
    std::unique_ptr<Shared> shared_;
};

/// Returns a keeper that sends the newest pose of a stream as the transform `name`.
std::shared_ptr<StreamKeeper> make_sender(std::string address, int port, std::string name);

}  // namespace tactus::openigtlink
