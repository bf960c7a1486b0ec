// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/hostile_peer.hpp"

#include "devices/board/board_frames.hpp"
#include "devices/gripper/frame.hpp"
#include "devices/haply/handshake.hpp"
#include "devices/openigtlink/message.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>

namespace tactus::bench {

namespace {

constexpr std::int64_t ms = 1'000'000, behaves_ns = 100 * ms;
constexpr std::size_t huge_bytes = std::size_t{16} << 20;

std::string state_of_service(double x) {
    return fmt::format(
        R"({{"version":"3.5.0","inverse3":[{{"device_id":"049D","config":{{"type":"inverse3","handedness":"right"}},)"
        R"("state":{{"cursor_position":{{"x":{},"y":-0.1,"z":0.05}},"cursor_velocity":{{"x":0,"y":0,"z":0}}}},)"
        R"("status":{{"ready":true}}}}]}})",
        x);
}

std::string text_frame(const std::string& text) {
    std::string out = "\x81";
    out += static_cast<char>(126);
    out += static_cast<char>(text.size() >> 8);
    out += static_cast<char>(text.size());
    return out + text;
}

std::string text_of(std::span<const std::uint8_t> bytes) { return {bytes.begin(), bytes.end()}; }

void pause_ms(int n) { std::this_thread::sleep_for(std::chrono::milliseconds(n)); }

}  // namespace

/// One whole message each time.
struct HostilePeer::Speaker {
    explicit Speaker(Line spoken) : line(spoken) {}

    Line line;
    gripper::FrameReader reader;
    std::uint16_t sequence = 0;
    std::string held;
    bool is_greeted = false;

    void begin() {
        held.clear();
        is_greeted = line != Line::web_socket;
    }
    std::string message() {
        const double x = 0.01 * std::sin(1e-9 * static_cast<double>(steady_ns()));
        if (line == Line::web_socket) return text_frame(state_of_service(x));
        if (line == Line::openigtlink) return text_of(openigtlink::transform_message("Tool", {{x, 0.0, 0.0}, {}}, 0.0));
        board::JointsFrame joints;
        joints.angle[0] = x;
        joints.serial = 7;
        const gripper::FrameBytes frame = gripper::encode(board::pack(joints, ++sequence));
        return text_of({frame.bytes.data(), frame.size});
    }
    /// The beginning of a message that claims to be huge.
    std::string huge_head() const {
        if (line == Line::web_socket) return {"\x81\x7f\0\0\0\0\1\0\0\0", 10};
        if (line == Line::serial) return {};
        std::string head = text_of(openigtlink::transform_message("Tool", {}, 0.0)).substr(0, 58);
        head.replace(42, 8, std::string("\0\0\0\0\1\0\0\0", 8));
        return head;
    }
};

HostilePeer::HostilePeer(Line line, Attack attack, int priority)
    : line_(line), attack_(attack), priority_(priority), speaker_(std::make_unique<Speaker>(line)) {
    if (line == Line::serial) {
        file_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
        std::array<char, 128> name{};
        if (file_ < 0 || ::grantpt(file_) != 0 || ::unlockpt(file_) != 0 ||
            ::ptsname_r(file_, name.data(), name.size()) != 0)
            throw Error("no free terminal");
        path_ = name.data();
        termios settings{};
        ::tcgetattr(file_, &settings);
        ::cfmakeraw(&settings);
        ::tcsetattr(file_, TCSANOW, &settings);
        thread_ = std::thread([this] { run_terminal(); });
        return;
    }
    file_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    if (file_ < 0 || ::bind(file_, any, size) != 0 || ::listen(file_, 4) != 0 || ::getsockname(file_, any, &size) != 0)
        throw Error("no free port on loopback");
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { run_server(); });
}

HostilePeer::~HostilePeer() {
    stop();
    ::close(file_);
}

void HostilePeer::stop() {
    ends_ = true;
    if (thread_.joinable()) thread_.join();
}

bool HostilePeer::send(int file, const std::string& bytes) {
    for (std::size_t sent = 0; sent < bytes.size() && !ends_;) {
        // A driver that hangs up ends no benchmark.
        const ssize_t count = line_ == Line::serial
                                  ? ::write(file, bytes.data() + sent, bytes.size() - sent)
                                  : ::send(file, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
        if (count > 0) {
            sent += static_cast<std::size_t>(count);
            bytes_ += static_cast<std::uint64_t>(count);
            continue;
        }
        if (errno != EAGAIN && errno != EINTR) return false;
        pollfd one{file, POLLOUT, 0};
        ::poll(&one, 1, 10);
        if ((one.revents & (POLLERR | POLLNVAL)) != 0) return false;
    }
    return !ends_;
}

void HostilePeer::answer(int file, const std::string& heard) {
    Speaker& speaker = *speaker_;
    if (line_ == Line::serial) {
        for (const char byte : heard)
            if (speaker.reader.take(static_cast<std::uint8_t>(byte))) send(file, speaker.message());
        return;
    }
    speaker.held += heard;
    if (!speaker.is_greeted) {
        const std::size_t end = speaker.held.find("\r\n\r\n"), from = speaker.held.find("Sec-WebSocket-Key: ");
        if (end == std::string::npos || from == std::string::npos) return;
        const std::string key = speaker.held.substr(from + 19, speaker.held.find("\r\n", from) - from - 19);
        send(file,
             "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
             "Sec-WebSocket-Accept: " +
                 haply::accept_for(key) + "\r\n\r\n" + speaker.message());
        speaker.is_greeted = true;
    } else {
        if (told_ns_ != 0) replies_ns_.push_back(steady_ns() - told_ns_);
        if (send(file, speaker.message())) ++answers_;
        told_ns_ = steady_ns();
    }
    speaker.held.clear();
}

/// False: the connection ends.
bool HostilePeer::attack(int file) {
    const std::string message = speaker_->message();
    switch (attack_) {
        case Attack::none: return true;
        case Attack::half: {
            const bool is_there = send(file, message.substr(0, message.size() / 2));
            pause_ms(20);
            return is_there && line_ == Line::serial;
        }
        case Attack::huge: {
            bool is_there = send(file, speaker_->huge_head());
            const std::string piece(65536, 'x');
            for (std::size_t sent = 0; is_there && sent < huge_bytes; sent += piece.size())
                is_there = send(file, piece);
            return is_there;
        }
        case Attack::slow: {
            for (const char byte : message) {
                if (!send(file, {byte})) return false;
                pause_ms(10);
            }
            return true;
        }
        case Attack::flood: {
            for (int i = 0; i < 200; ++i)
                if (!send(file, message)) return false;
            return true;
        }
    }
    return true;
}

void HostilePeer::serve(int client) {
    speaker_->begin();
    told_ns_ = 0;
    const std::int64_t begin = steady_ns();
    std::int64_t told = begin;
    std::array<char, 4096> bytes;
    while (!ends_) {
        if (attack_ != Attack::none && steady_ns() - begin > behaves_ns && speaker_->is_greeted) {
            if (!attack(client)) return;
            while (::read(client, bytes.data(), bytes.size()) > 0) {
            }
            continue;
        }
        pollfd one{client, POLLIN, 0};
        ::poll(&one, 1, 5);
        ran_ns_ = steady_ns();
        const ssize_t count = ::read(client, bytes.data(), bytes.size());
        if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR && errno != EIO)) return;
        if (count > 0) answer(client, {bytes.data(), static_cast<std::size_t>(count)});
        if (line_ == Line::openigtlink && steady_ns() - told > 15 * ms) {
            told = steady_ns();
            if (!send(client, speaker_->message())) return;
        }
    }
}

void HostilePeer::run_server() {
    if (priority_ > 0) {
        sched_param parameters{};
        parameters.sched_priority = priority_;
        ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters);
    }
    while (!ends_) {
        pollfd one{file_, POLLIN, 0};
        if (::poll(&one, 1, 5) <= 0) continue;
        const int client = ::accept4(file_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
        if (client < 0) continue;
        ++connections_;
        const int at_once = 1;
        ::setsockopt(client, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
        serve(client);
        ::close(client);
    }
}

void HostilePeer::run_terminal() {
    while (!ends_) {
        // Nobody has it open while reads fail.
        pollfd one{file_, POLLIN, 0};
        if (::poll(&one, 1, 5) <= 0 || (one.revents & POLLIN) == 0) {
            if ((one.revents & POLLHUP) != 0) pause_ms(1);
            continue;
        }
        ++connections_;
        serve(file_);
    }
}

}  // namespace tactus::bench
