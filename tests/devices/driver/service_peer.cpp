// SPDX-License-Identifier: Apache-2.0
#include "tests/devices/driver/service_peer.hpp"

#include "devices/haply/handshake.hpp"
#include "devices/haply/inverse3.hpp"
#include "dsp/core/clock.hpp"

#include <fmt/format.h>

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace tactus::test {

HaplyService::HaplyService(int wanted) {
    listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(wanted));
    const int again = 1;
    ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &again, sizeof again);
    socklen_t size = sizeof address;
    if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 || ::listen(listener_, 4) != 0 ||
        ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
        throw std::runtime_error("no free port on loopback");
    port = ntohs(address.sin_port);
    thread_ = std::thread([this] { run(); });
}

HaplyService::~HaplyService() {
    ends_ = true;
    thread_.join();
    ::close(listener_);
}

std::string HaplyService::frame(const std::string& text) {
    std::string out = "\x81";
    if (text.size() < 126) out += static_cast<char>(text.size());
    else {
        out += static_cast<char>(126);
        out += static_cast<char>(text.size() >> 8);
        out += static_cast<char>(text.size());
    }
    return out + text;
}

std::string HaplyService::state() {
    const std::lock_guard lock(mutex_);
    const auto coordinate = [&](double x) { return is_nan ? std::string("1e400") : fmt::format("{}", x); };
    return fmt::format(
        R"({{"version":"{}","inverse3":[{{"device_id":"049D","config":{{"type":"inverse3","handedness":"right",)"
        R"("basis":{{"permutation":"{}"}}}},"state":{{"cursor_position":{{"x":{},"y":{},"z":{}}},)"
        R"("cursor_velocity":{{"x":0,"y":0,"z":0}}}},"status":{{"ready":true}}}}],"wireless_verse_grip":[{{"device_id":"61",)"
        R"("state":{{"orientation":{{"w":{},"x":{},"y":{},"z":{}}},"buttons":{{"a":{},"b":{},"c":{}}}}}}}]}})",
        version, basis, coordinate(position_.x), position_.y, position_.z, orientation_.w, orientation_.x,
        orientation_.y, orientation_.z, (buttons & 1u) != 0, (buttons & 2u) != 0, (buttons & 4u) != 0);
}

void HaplyService::move(const Vec3& p, const Quat& q) {
    const std::lock_guard lock(mutex_);
    position_ = p;
    orientation_ = q;
}

Vec3 HaplyService::given() {
    const std::lock_guard lock(mutex_);
    return force_;
}

/// A force holds until the next text, and none when texts stop, as the maker's service says.
void HaplyService::accept(const std::string& text) {
    const std::lock_guard lock(mutex_);
    const std::string key = text.find("\"vector\"") != std::string::npos ? "vector" : "values";
    said_key = key;
    const std::size_t at = text.find("\"" + key + "\"");
    if (at == std::string::npos) return;
    for (int i = 0; i < 3; ++i) {
        const std::string name = fmt::format("\"{}\":", "xyz"[i]);
        const std::size_t from = text.find(name, at);
        if (from != std::string::npos) force_[i] = std::strtod(text.c_str() + from + name.size(), nullptr);
    }
    ++texts;
    if (text.find("\"profile\"") != std::string::npos) ++greetings;
    heard_ns_ = steady_ns();
}

void HaplyService::serve(int client) {
    const auto send = [&](const std::string& bytes) {
        return ::send(client, bytes.data(), bytes.size(), MSG_NOSIGNAL) > 0;
    };
    std::string held;
    bool is_greeted = false;
    while (!ends_ && !is_away) {
        {
            const std::lock_guard lock(mutex_);
            if (steady_ns() - heard_ns_ > 10'000'000) force_ = Vec3(0.0);
        }
        pollfd one{client, POLLIN, 0};
        if (::poll(&one, 1, 1) <= 0) continue;
        if (is_silent) continue;
        std::array<char, 4096> bytes;
        const ssize_t count = ::recv(client, bytes.data(), bytes.size(), 0);
        if (count <= 0) break;
        held.append(bytes.data(), static_cast<std::size_t>(count));
        if (!is_greeted) {
            const std::size_t end = held.find("\r\n\r\n");
            if (end == std::string::npos) continue;
            const std::string name = "Sec-WebSocket-Key: ";
            const std::size_t from = held.find(name) + name.size();
            const std::string key = held.substr(from, held.find("\r\n", from) - from);
            held.erase(0, end + 4);
            is_greeted = true;
            if (slow_greeting.exchange(false)) {  // a byte now and then, for ever
                for (int i = 0; i < 400 && !ends_ && send("H"); ++i)
                    std::this_thread::sleep_for(std::chrono::milliseconds(10));
                break;
            }
            send(
                "HTTP/1.1 101 Switching Protocols\r\nupgrade: WebSocket\r\nConnection: keep-alive, Upgrade\r\n"
                "Sec-WebSocket-Accept: " +
                (is_impostor ? "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=" : haply::accept_for(key)) + "\r\n\r\n" + frame(state()));
        }
        while (held.size() >= 6) {
            std::size_t size = held[1] & 0x7F, head = 2;
            if (size == 126) {
                size = static_cast<std::size_t>(static_cast<std::uint8_t>(held[2])) << 8 |
                       static_cast<std::uint8_t>(held[3]);
                head = 4;
            }
            if (held.size() < head + 4 + size) break;
            std::string text = held.substr(head + 4, size);
            for (std::size_t i = 0; i < size; ++i) text[i] ^= held[head + i % 4];
            const int opcode = held[0] & 0x0F;
            held.erase(0, head + 4 + size);
            if (opcode != 1) continue;
            accept(text);
            std::string answer = frame(state());
            const Trouble now = lasts ? trouble.load() : trouble.exchange(Trouble::none);
            if (now == Trouble::huge) {
                answer = std::string("\x81\x7f\0\0\0\0\1\0\0\0", 10);  // 16 MB
                for (int i = 0; i < 256 && send(answer); ++i) answer.assign(65536, 'x');
                continue;
            } else if (now == Trouble::bad_json) answer = frame("{\"inverse3\":[{");
            else if (now == Trouble::half) answer.resize(answer.size() / 2);
            else if (now == Trouble::flood)
                for (int i = 0; i < 2000 && send(answer); ++i) {
                }
            if (!send(answer)) break;
        }
    }
    ::close(client);
}

void HaplyService::run() {
    while (!ends_) {
        pollfd one{listener_, POLLIN, 0};
        if (::poll(&one, 1, 5) <= 0) continue;
        const int client = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
        if (client < 0) continue;
        if (is_away) {
            ::close(client);
            continue;
        }
        const int at_once = 1;
        ::setsockopt(client, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
        serve(client);
        const std::lock_guard lock(mutex_);
        force_ = Vec3(0.0);
    }
}

namespace {

class HaplyPeer final : public Peer {
public:
    HaplyPeer() {
        buttons = 3;
        exact_force = 1e-9;
    }
    std::unique_ptr<driver::Backend> backend() override {
        Options options = options_of({{"port", std::to_string(service_.port), {}}});
        return haply::make_inverse3(options);
    }
    void place(const Vec3& position, const Quat& orientation) override { service_.move(position, orientation); }
    void press(std::uint32_t mask) override { service_.buttons = mask; }
    Wrench given() override { return {service_.given(), {}}; }
    void hang(bool on) override { service_.is_silent = on; }
    void unplug(bool on) override { service_.is_away = on; }
    void send_nan(bool on) override { service_.is_nan = on; }
    void burst() override { service_.trouble = HaplyService::Trouble::flood; }

private:
    HaplyService service_;
};

}  // namespace

std::unique_ptr<Peer> make_haply_peer() { return std::make_unique<HaplyPeer>(); }

}  // namespace tactus::test
