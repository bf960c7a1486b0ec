// SPDX-License-Identifier: Apache-2.0
#include "devices/openigtlink/sender.hpp"

#include "devices/driver/peer_socket.hpp"
#include "devices/openigtlink/message.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

namespace tactus::openigtlink {

namespace {

struct Client {
    int file = -1;
    std::vector<std::uint8_t> waiting;  ///< a message that was sent in part comes first
};

class Sender final : public StreamKeeper {
public:
    Sender(std::string address, int port, std::string name)
        : address_(std::move(address)), port_(port), name_(std::move(name)) {}

    void open(const std::string&) override { server_ = TransformServer::at(address_, port_); }
    void take(std::int64_t, const std::byte* values, std::size_t count) override {
        if (count == 0) return;
        newest_.emplace();
        std::memcpy(&*newest_, values + (count - 1) * sizeof(Pose), sizeof(Pose));
    }
    void save() override {
        if (!newest_ || !server_) return;
        const std::chrono::duration<double> now = std::chrono::system_clock::now().time_since_epoch();
        if (is_valid(*newest_)) server_->send(transform_message(name_, *newest_, now.count()));
        newest_.reset();
    }
    void finish() override { server_.reset(); }

private:
    std::string address_;
    int port_;
    std::string name_;
    std::shared_ptr<TransformServer> server_;
    std::optional<Pose> newest_;
};

}  // namespace

struct TransformServer::Shared {
    std::mutex mutex;
    int listener = -1;
    std::vector<Client> clients;

    void take_new() {
        for (int file; (file = ::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK)) >= 0;) {
            if (clients.size() >= max_clients) {
                ::close(file);
                continue;
            }
            driver::keep_alive(file);
            const int at_once = 1;
            ::setsockopt(file, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
            clients.push_back({file, {}});
        }
    }
    /// False: the client is gone, or does not read.
    static bool give(Client& client, const std::vector<std::uint8_t>& message) {
        if (client.waiting.size() + message.size() > longest_backlog) return false;
        client.waiting.insert(client.waiting.end(), message.begin(), message.end());
        while (!client.waiting.empty()) {
            const ssize_t sent = ::send(client.file, client.waiting.data(), client.waiting.size(), MSG_NOSIGNAL);
            if (sent < 0) return errno == EAGAIN || errno == EINTR;
            client.waiting.erase(client.waiting.begin(), client.waiting.begin() + sent);
        }
        return true;
    }
};

std::shared_ptr<TransformServer> TransformServer::at(const std::string& address, int port) {
    static std::mutex mutex;
    static std::map<std::pair<std::string, int>, std::weak_ptr<TransformServer>> servers;
    const std::lock_guard lock(mutex);
    std::weak_ptr<TransformServer>& known = servers[{address, port}];
    if (std::shared_ptr<TransformServer> server = known.lock()) return server;
    std::shared_ptr<TransformServer> server(new TransformServer(address, port));
    if (port != 0) known = server;
    return server;
}

TransformServer::TransformServer(const std::string& address, int port) : shared_(std::make_unique<Shared>()) {
    sockaddr_in where{};
    where.sin_family = AF_INET;
    where.sin_port = htons(static_cast<std::uint16_t>(port));
    if (::inet_pton(AF_INET, address.c_str(), &where.sin_addr) != 1)
        throw Error(fmt::format("'{}' is no address such as 127.0.0.1", address));
    shared_->listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    const int again = 1;
    ::setsockopt(shared_->listener, SOL_SOCKET, SO_REUSEADDR, &again, sizeof again);
    if (::bind(shared_->listener, reinterpret_cast<const sockaddr*>(&where), sizeof where) != 0 ||
        ::listen(shared_->listener, 8) != 0) {
        const std::string why = std::strerror(errno);
        ::close(shared_->listener);
        throw Error(fmt::format("cannot serve OpenIGTLink at {}:{}: {}", address, port, why));
    }
    socklen_t size = sizeof where;
    ::getsockname(shared_->listener, reinterpret_cast<sockaddr*>(&where), &size);
    port_ = ntohs(where.sin_port);
}

TransformServer::~TransformServer() {
    for (const Client& client : shared_->clients) ::close(client.file);
    ::close(shared_->listener);
}

void TransformServer::send(const std::vector<std::uint8_t>& message) {
    const std::lock_guard lock(shared_->mutex);
    shared_->take_new();
    std::erase_if(shared_->clients, [&](Client& client) {
        if (Shared::give(client, message)) return false;
        ::close(client.file);
        return true;
    });
}

std::shared_ptr<StreamKeeper> make_sender(std::string address, int port, std::string name) {
    return std::make_shared<Sender>(std::move(address), port, std::move(name));
}

}  // namespace tactus::openigtlink
