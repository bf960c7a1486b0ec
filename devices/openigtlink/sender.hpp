// SPDX-License-Identifier: Apache-2.0
// Poses for 3D Slicer and others that connect: a server of OpenIGTLink.
#pragma once

#include "graph/node/setup.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tactus::openigtlink {

/// Where clients connect. Several senders share one: a client gets the transforms of all. It never waits: a client that
/// does not read is left out after `longest_backlog` bytes.
class TransformServer {
public:
    static constexpr std::size_t longest_backlog = 65536;
    static constexpr std::size_t most_clients = 32;  ///< further ones are hung up: files are left to the run

    /// The server of this process at that address and port; opened when there is none. Any thread. Throws Error.
    static std::shared_ptr<TransformServer> at(const std::string& address, int port);
    ~TransformServer();
    TransformServer(const TransformServer&) = delete;
    TransformServer& operator=(const TransformServer&) = delete;

    /// Takes new clients, and sends the message to all. Any thread.
    void send(const std::vector<std::uint8_t>& message);
    int port() const { return port_; }  ///< of a server at port 0: the one it got

private:
    struct Shared;
    TransformServer(const std::string& address, int port);

    int port_ = 0;
    std::unique_ptr<Shared> shared_;
};

/// Sends the newest pose of a stream as the transform `name`.
std::shared_ptr<StreamKeeper> make_sender(std::string address, int port, std::string name);

}  // namespace tactus::openigtlink
