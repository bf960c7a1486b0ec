// SPDX-License-Identifier: Apache-2.0
#include "devices/openigtlink/tracker.hpp"

#include "devices/driver/peer_socket.hpp"
#include "devices/openigtlink/message.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/rotation.hpp"

#include <fmt/format.h>

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

namespace tactus::openigtlink {

namespace {

constexpr int longest_connect_ms = 2000;

struct Settings {
    std::string host, transform;
    int port = 18944;
    std::int64_t oldest_ns = 100'000'000;
    DeviceInfo info;
};

/// A connected socket. Throws Error.
int connect_to(const std::string& host, int port) {
    const std::string where = fmt::format("{}:{}", host, port);
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (const int code = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found); code != 0)
        throw Error(fmt::format("no host '{}': {}", host, ::gai_strerror(code)));
    const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> list(found, ::freeaddrinfo);
    std::string why = "it has no address";
    for (const addrinfo* one = found; one; one = one->ai_next) {
        const int file = ::socket(one->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
        if (file < 0) continue;
        int error = ::connect(file, one->ai_addr, one->ai_addrlen) == 0 ? 0 : errno;
        if (error == EINPROGRESS) {
            pollfd line{file, POLLOUT, 0};
            socklen_t size = sizeof error;
            if (::poll(&line, 1, longest_connect_ms) <= 0) error = ETIMEDOUT;
            else ::getsockopt(file, SOL_SOCKET, SO_ERROR, &error, &size);
        }
        if (error == 0) return file;
        why = std::strerror(error);
        ::close(file);
    }
    throw Error(fmt::format("no answer at {}: {}; is its OpenIGTLink server on?", where, why));
}

class Tracker final : public driver::Backend {
public:
    explicit Tracker(Settings settings) : settings_(std::move(settings)) {}
    ~Tracker() override { close(); }
    Tracker(const Tracker&) = delete;
    Tracker& operator=(const Tracker&) = delete;

    driver::Outline outline() const override { return {settings_.info, ""}; }

    driver::Opened open(driver::OpenMode, const std::shared_ptr<driver::Exchange>&,
                        const driver::StepLog& step) override {
        const std::string where = fmt::format("{}:{}", settings_.host, settings_.port);
        step("connect to " + where);
        file_ = connect_to(settings_.host, settings_.port);
        driver::keep_alive(file_);  // nothing is ever sent there
        reader_ = {};
        motion_.clear();
        driver::Opened opened;
        opened.info = settings_.info;
        opened.serial = where;
        opened.versions = {"OpenIGTLink at " + where};
        return opened;
    }

    bool round(driver::Exchange& exchange) noexcept override {
        if (!read()) return false;
        driver::Reading reading;
        reading.has_twist = true;
        reading.is_valid = motion_.at(boot_ns(), settings_.oldest_ns, reading.pose, reading.twist);
        exchange.publish(reading);
        return true;
    }

    void close() noexcept override {
        if (file_ >= 0) ::close(std::exchange(file_, -1));
    }

    std::int64_t round_ns() const noexcept override { return 1'000'000; }
    bool is_peer() const noexcept override { return true; }

private:
    /// False: the peer is gone, or speaks something else.
    bool read() noexcept {
        std::array<std::uint8_t, 16384> bytes;
        const std::optional<std::size_t> count = driver::read_now(file_, bytes);
        if (!count) return false;
        try {
            reader_.take(std::span(bytes).first(*count));
            while (const std::optional<Message> message = reader_.next())
                if (const std::optional<Pose> pose = pose_in(*message, settings_.transform))
                    motion_.add(*pose, boot_ns());
        } catch (...) {  // no memory
            return false;
        }
        return !reader_.is_broken();
    }

    Settings settings_;
    int file_ = -1;
    MessageReader reader_;
    Interpolation motion_;
};

}  // namespace

void Interpolation::add(const Pose& pose, std::int64_t at_ns) noexcept {
    Twist twist;
    Pose here = pose;
    if (count_ > 0) {
        at(at_ns, INT64_MAX, here, twist);
        from_ns_ = arrived_ns_;
    }
    from_ = here;
    to_ = pose;
    arrived_ns_ = at_ns;
    count_ = std::min(count_ + 1, 2);
}

bool Interpolation::at(std::int64_t now_ns, std::int64_t oldest_ns, Pose& pose, Twist& twist) const noexcept {
    if (count_ == 0 || now_ns - arrived_ns_ > oldest_ns) return false;
    pose = to_;
    twist = {};
    // After a pause the hand goes on at once instead of taking as long again.
    const std::int64_t between = std::clamp<std::int64_t>(arrived_ns_ - from_ns_, 1'000'000, 100'000'000);
    if (count_ < 2 || now_ns - arrived_ns_ >= between) return true;
    const double part = static_cast<double>(now_ns - arrived_ns_) / static_cast<double>(between);
    const double seconds = static_cast<double>(between) * 1e-9;
    Quat turn = to_.orientation;
    if (glm::dot(from_.orientation, turn) < 0.0) turn = -turn;
    pose.position = from_.position + part * (to_.position - from_.position);
    pose.orientation = glm::normalize(glm::slerp(from_.orientation, turn, part));
    twist.linear = (to_.position - from_.position) / seconds;
    twist.angular = rotation_between(from_.orientation, to_.orientation) / seconds;
    return true;
}

std::unique_ptr<driver::Backend> make_tracker(Options& options) {
    Settings settings;
    settings.host = options.text("host", "127.0.0.1");
    const double port = options.quantity("port", "18944", "1", "65535");
    settings.port = static_cast<int>(port);
    if (settings.port != port)
        throw Error(options.where("port"), fmt::format("{}: option 'port' is a whole number", options.owner()));
    settings.transform = options.text("transform", "");
    settings.oldest_ns = static_cast<std::int64_t>(1e9 * options.quantity("timeout", "100 ms", "5 ms", "2 s"));
    settings.info.name = fmt::format("tracker at {}:{}", settings.host, settings.port);
    settings.info.without_motors = true;
    return std::make_unique<Tracker>(std::move(settings));
}

}  // namespace tactus::openigtlink
