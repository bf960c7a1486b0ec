// SPDX-License-Identifier: Apache-2.0
#include "devices/haptic/mouse.hpp"

#include "devices/haptic/operated.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tactus::haptic {

WindowHand& window_hand() noexcept {
    static WindowHand one;
    return one;
}

namespace {

// A window needs a moment until its first picture of a run.
constexpr std::int64_t longest_start_ns = 10'000'000'000;
constexpr double min_glide_s = 0.004, longest_glide_s = 0.5;
constexpr double farthest_m = 10.0;
constexpr double fastest_m_s = 0.5, fastest_rad_s = 10.0;  // no hand jumps

/// The intended pose: from picture to picture in a straight line, as long as a picture lasts.
struct Gliding {
    Pose from, to;
    double glide_s = min_glide_s, at_s = 0.0;

    Pose here() const noexcept {
        const double share = std::min(at_s / glide_s, 1.0);
        return {glm::mix(from.position, to.position, share), glm::slerp(from.orientation, to.orientation, share)};
    }
    void go_to(const Pose& wanted, double seconds) noexcept {
        from = here();
        to = {wanted.position, glm::normalize(wanted.orientation)};
        glide_s = std::max({std::clamp(seconds, min_glide_s, longest_glide_s),
                            glm::length(to.position - from.position) / fastest_m_s,
                            glm::length(rotation_between(from.orientation, to.orientation)) / fastest_rad_s});
        at_s = 0.0;
    }
    simulate::Intention operator()(double h, const Wrench&, const Pose&) noexcept {
        at_s += 0.5 * h;
        const simulate::Intention intended{here(), velocity()};
        at_s += 0.5 * h;
        return intended;
    }

private:
    Twist velocity() const noexcept {
        if (at_s >= glide_s) return {};
        return {(to.position - from.position) / glide_s, rotation_between(from.orientation, to.orientation) / glide_s};
    }
};

class Mouse final : public HapticDevice {
public:
    Mouse(DeviceInfo info, const simulate::HandDynamics& dynamics, WindowHand& link, std::int64_t (*now_ns)())
        : info_(std::move(info)), link_(link), now_ns_(now_ns) {
        hand_.dynamics = dynamics;
    }
    ~Mouse() override { --link_.devices; }
    Mouse(const Mouse&) = delete;
    Mouse& operator=(const Mouse&) = delete;

    const DeviceInfo& info() const override { return info_; }

    void prepare(double period_s) override {
        max_tick_ = max_tick_of_hand(period_s);
        hand_.pose = {};
        hand_.twist = {};
        intended_ = {};
        told_ = {};
        force_.set({});
        counter_ = 0;
        buttons_ = 0;
        FeltHand before;
        std::uint64_t number = 0;
        link_.felt.read(before, number);
        run_ = before.run + 1;
        heard_ns_ = now_ns_();
        has_heard_ = false;
        tell(false);
    }

    DeviceSample acquire(double elapsed_s) noexcept override {
        listen();
        simulate::advance(hand_, intended_, force_.get(), std::min(elapsed_s, max_tick_));
        const std::int64_t silence = now_ns_() - heard_ns_;
        const bool is_silent = silence > (has_heard_ ? longest_silence_of_window_ns : longest_start_ns);
        tell(is_silent);
        DeviceSample sample{hand_.pose, hand_.twist, is_silent && silence > longest_hold_of_window_ns ? 0u : buttons_,
                            ++counter_, is_good(hand_.pose, hand_.twist)};
        sample.late = is_silent;
        return sample;
    }

    void commit(const Wrench& on_hand) noexcept override { force_.set(on_hand); }

private:
    /// Reads the target that the window sent since the last tick.
    void listen() noexcept {
        WantedHand wanted;
        std::uint64_t number = 0;
        if (!link_.wanted.read(wanted, number) || number == heard_ || wanted.run != run_) return;
        heard_ = number;
        heard_ns_ = std::min(wanted.at_ns, now_ns_());
        has_heard_ = true;
        buttons_ = static_cast<std::uint32_t>(wanted.buttons);
        if (!is_valid(wanted.pose) || glm::length(wanted.pose.position) > farthest_m) return;
        // An unchanged pose is only a sign of life and does not restart the motion.
        if (wanted.pose.position == told_.position && wanted.pose.orientation == told_.orientation) return;
        told_ = wanted.pose;
        intended_.go_to(wanted.pose, static_cast<double>(wanted.picture_ns) * 1e-9);
    }

    void tell(bool is_silent) noexcept {
        link_.felt.write({hand_.pose, force_.get(), run_, now_ns_(), is_silent ? 1 : 0});
    }

    DeviceInfo info_;
    WindowHand& link_;
    std::int64_t (*now_ns_)();
    simulate::Hand hand_;
    Gliding intended_;
    Pose told_;
    SharedWrench force_;
    std::uint32_t buttons_ = 0;
    std::uint64_t heard_ = 0;
    std::int64_t counter_ = 0, run_ = 0, heard_ns_ = 0;
    double max_tick_ = 0.0;  // s
    bool has_heard_ = false;
};

}  // namespace

std::unique_ptr<HapticDevice> open_mouse(Options& options, WindowHand& link, std::int64_t (*now_ns)()) {
    const bool is_given = options.has("grip") || options.has("stiffness");
    simulate::HandDynamics hand = read_hand(options);
    if (!is_given) hand.stiffness = 2000.0;
    if (!is_given && !options.has("damping")) hand.damping = 30.0;
    DeviceInfo info = read_info_without_motors(options, hand, "hand at the window");
    options.finish();
    if (link.devices.fetch_add(1) > 0) {
        --link.devices;
        throw Error(options.where(), fmt::format("{}: the window has one hand, and another device with the driver "
                                                 "'mouse' is that already; give this one another driver",
                                                 options.owner()));
    }
    return std::make_unique<Mouse>(std::move(info), hand, link, now_ns);
}

std::unique_ptr<HapticDevice> open_mouse(Options& options, const PathResolver&) {
    return open_mouse(options, window_hand(), steady_ns);
}

}  // namespace tactus::haptic
