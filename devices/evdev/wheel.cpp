// SPDX-License-Identifier: Apache-2.0
#include "devices/evdev/wheel.hpp"

#include "devices/driver/buttons.hpp"
#include "devices/evdev/force_effect.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/lower.hpp"
#include "dsp/core/rotation.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::evdev {

namespace {

constexpr double usual_range = 900.0 * degree;  // of wheels whose driver does not say
constexpr int max_reads = 8;  // a round; more is read in the next one
constexpr std::int64_t longest_refusal_ns = 200'000'000;
// If the torque is not given, assume the strongest wheel on the market: then no wheel exceeds the requested torque.
constexpr double strongest_torque = 30.0;  // N m
constexpr double usual_torque = 2.0;       // N m: what such a wheel is asked for at most

enum class Motion { slide, rim };

struct Settings {
    std::string file, serial;
    double range = 0.0;  ///< rad from stop to stop; 0: as the driver says
    double radius = 0.14, max_torque = strongest_torque;
    double centring_after = 0.0, gain_after = 1.0;  ///< of full, where the wheel's driver does not state what it had
    Motion motion = Motion::slide;
    bool is_reversed = false, states_torque = false;
};

std::string text_of(EventSystem& system, int file, unsigned long request) {
    std::array<char, 256> text{};
    if (system.control(file, request, reinterpret_cast<std::uintptr_t>(text.data())) < 0) return {};
    text.back() = '\0';
    return text.data();
}

std::string name_of(EventSystem& system, int file) { return text_of(system, file, EVIOCGNAME(255)); }

/// What an event device with a constant force is. Joysticks have such forces and the axis X, too: the kernel has no kind of
/// device for wheels.
enum class Kind { other, joystick, wheel };

Kind kind_of(EventSystem& system, int file, const std::string& path) {
    const Bits axes = Bits::of_kind(system, file, EV_ABS), keys = Bits::of_kind(system, file, EV_KEY);
    if (!Bits::of_kind(system, file, EV_FF)[FF_CONSTANT] || !axes[ABS_X]) return Kind::other;
    // Only wheels have a range, a gear lever or a wheel axis; otherwise the device's name decides.
    if (!system.attribute(path, "range").empty() || axes[ABS_WHEEL] || keys[BTN_GEAR_DOWN]) return Kind::wheel;
    const std::string name = lower(name_of(system, file));
    for (const char* word : {"wheel", "racing", "driving", "formula"})
        if (name.find(word) != std::string::npos) return Kind::wheel;
    return axes[ABS_Y] ? Kind::joystick : Kind::wheel;
}

struct Found {
    std::string path;  ///< the first wheel that can be read; empty: none
    std::string absence;
};

Found find_wheel(EventSystem& system) {
    Found found;
    for (const std::string& path : system.devices()) {
        const int file = system.open(path, O_RDONLY | O_NONBLOCK);
        if (file < 0) continue;
        const Kind kind = kind_of(system, file, path);
        const std::string name = name_of(system, file);
        system.close(file);
        if (kind == Kind::wheel) return {path, ""};
        if (kind == Kind::joystick && found.absence.empty())
            found.absence = fmt::format(
                "there is no wheel with force feedback in /dev/input; '{}' seems to be a joystick: if it is a wheel, "
                "give "
                "{} as 'file'",
                name, path);
    }
    if (found.absence.empty())
        found.absence =
            "there is no wheel with force feedback in /dev/input that you may read; plug one in, or give its event "
            "device as 'file'";
    return found;
}

/// Of full strength, as the wheel's driver states it; drivers that do have the range of the events.
std::optional<std::uint16_t> strength_in(const std::string& text) {
    std::uint16_t value = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
    return end.ec == std::errc() ? std::optional(value) : std::nullopt;
}

class Wheel final : public driver::Backend {
public:
    Wheel(EventSystem& system, Settings settings) : system_(system), settings_(std::move(settings)), effect_(system) {}
    ~Wheel() override { close(); }
    Wheel(const Wheel&) = delete;
    Wheel& operator=(const Wheel&) = delete;

    driver::Outline outline() const override {
        if (settings_.file.empty()) return {info(), find_wheel(system_).absence};
        const int file = system_.open(settings_.file, O_RDONLY | O_NONBLOCK);
        if (file < 0) return {info(), fmt::format("cannot open {}: {}", settings_.file, std::strerror(errno))};
        system_.close(file);
        return {info(), ""};
    }

    driver::Opened open(driver::OpenMode mode, const std::shared_ptr<driver::Exchange>&,
                        const driver::StepLog& step) override {
        step("look for a wheel");
        const Found found = settings_.file.empty() ? find_wheel(system_) : Found{settings_.file, ""};
        if (found.path.empty()) throw Error(found.absence);
        const std::string& path = found.path;
        step("open " + path);
        gives_ = mode == driver::OpenMode::run;
        file_ = system_.open(path, (gives_ ? O_RDWR : O_RDONLY) | O_NONBLOCK);
        if (file_ < 0)
            throw Error(fmt::format("cannot open {}: {}{}", path, std::strerror(errno),
                                    errno == EACCES ? "; are you in the group 'input'?" : ""));
        step("ask for its axis");
        if (!ask_axis(system_, file_, ABS_X, axis_) || axis_.maximum <= axis_.minimum)
            throw Error(fmt::format("{} states no range of its axis X; is it a wheel?", path));
        value_ = axis_.value;
        step("ask for its range");
        const std::string range = find_range(path);
        step("ask for its buttons");
        find_buttons();
        ask_buttons();
        step("ask for its effects");
        const Bits effects = Bits::of_kind(system_, file_, EV_FF);
        if (!effects[FF_CONSTANT])
            throw Error(fmt::format("{} gives no constant force{}", path,
                                    effects[FF_RUMBLE] ? ", it only rumbles: use the driver 'gamepad'" : ""));
        if (gives_) begin_forces(effects, path, step);
        refused_ns_ = 0;

        driver::Opened opened;
        opened.info = info();
        opened.info.name = name_of(system_, file_);
        if (opened.info.name.empty()) opened.info.name = "wheel";
        opened.serial = settings_.serial.empty() ? text_of(system_, file_, EVIOCGUNIQ(255)) : settings_.serial;
        input_id id{};
        system_.control(file_, EVIOCGID, reinterpret_cast<std::uintptr_t>(&id));
        opened.setup = fmt::format("{:04x}:{:04x}{}", id.vendor, id.product, settings_.is_reversed ? " reversed" : "");
        opened.versions = {
            "event device " + path, range, fmt::format("axis X from {} to {}", axis_.minimum, axis_.maximum),
            fmt::format("full torque {:.3g} N m, {}", settings_.max_torque,
                        settings_.states_torque ? "by option"
                                                : "the strongest sold: give the option 'max_torque'; "
                                                  "without it, a weaker wheel gives less than requested")};
        opened.axes = 1;
        return opened;
    }

    bool round(driver::Exchange& exchange) noexcept override {
        if (!listen()) return false;
        const double angle = this->angle();
        exchange.publish(reading(angle));
        if (!gives_) return true;
        const Wrench wanted = exchange.force();
        const std::int64_t now = steady_ns();
        if (effect_.give(strength(angle, wanted), now)) {
            refused_ns_ = 0;
            return true;
        }
        if (errno == ENODEV) return false;
        if (refused_ns_ == 0) refused_ns_ = now;
        return now - refused_ns_ < longest_refusal_ns;
    }

    void close() noexcept override {
        if (file_ < 0) return;
        effect_.end();
        // Nobody else does: they outlive the file that set them.
        if (centring_before_) set(FF_AUTOCENTER, *std::exchange(centring_before_, std::nullopt));
        if (gain_before_) set(FF_GAIN, *std::exchange(gain_before_, std::nullopt));
        system_.close(std::exchange(file_, -1));
    }

    std::int64_t round_ns() const noexcept override { return 2'000'000; }

private:
    double range() const { return range_ > 0.0 ? range_ : settings_.range > 0.0 ? settings_.range : usual_range; }

    DeviceInfo info() const {
        DeviceInfo info;
        info.name = "wheel";
        info.max_force = (settings_.states_torque ? settings_.max_torque : usual_torque) / settings_.radius;
        info.max_stiffness = 300.0;
        info.senses_rotation = settings_.motion == Motion::rim;
        info.angular_resolution = axis_.maximum > axis_.minimum ? range() / steps() : 1e-3;
        info.resolution = info.angular_resolution * settings_.radius;
        info.delay = 8e-3;  // a transfer each way
        return info;
    }

    double steps() const { return static_cast<double>(axis_.maximum) - axis_.minimum; }

    /// From the option, the driver in the kernel, or as most wheels have it; returns a notice, or "".
    std::string find_range(const std::string& path) {
        range_ = settings_.range;
        if (range_ > 0.0) return fmt::format("range {:.0f} deg, by option", range_ / degree);
        const std::string stated = system_.attribute(path, "range");
        double degrees = 0.0;
        const auto end = std::from_chars(stated.data(), stated.data() + stated.size(), degrees).ec;
        if (end == std::errc() && degrees >= 10.0 && degrees <= 10'000.0) {
            range_ = degrees * degree;
            return fmt::format("range {:.0f} deg, by its driver", degrees);
        }
        range_ = usual_range;
        return fmt::format("range {:.0f} deg, assumed: give the option 'range'", range_ / degree);
    }

    void find_buttons() {
        keys_.fill(0);
        const Bits keys = Bits::of_kind(system_, file_, EV_KEY);
        std::size_t found = 0;
        for (unsigned code = BTN_JOYSTICK; code <= KEY_MAX && found < keys_.size(); ++code)
            if (keys[code]) keys_[found++] = static_cast<std::uint16_t>(code);
    }

    void ask_buttons() noexcept {
        mask_ = 0;
        const Bits held = Bits::of_held_keys(system_, file_);
        for (std::size_t i = 0; i < keys_.size(); ++i)
            if (keys_[i] != 0 && held[keys_[i]]) mask_ |= 1u << i;
    }

    bool set(std::uint16_t code, int value) noexcept {
        input_event event{};
        event.type = EV_FF;
        event.code = code;
        event.value = value;
        return system_.write(file_, event);
    }

    void begin_forces(const Bits& effects, const std::string& path, const driver::StepLog& step) {
        step("switch centring off");
        const auto begin = [&](std::uint16_t code, int value, const char* stated, double otherwise) {
            std::optional<std::uint16_t> before;
            if (!effects[code]) return before;
            // The event interface cannot read the previous value.
            before = strength_in(stated ? system_.attribute(path, stated) : "");
            if (!before) before = static_cast<std::uint16_t>(std::lround(0xFFFF * otherwise));
            if (!set(code, value)) throw Error(fmt::format("the wheel refused a setting: {}", std::strerror(errno)));
            return before;
        };
        centring_before_ = begin(FF_AUTOCENTER, 0, "autocenter", settings_.centring_after);
        // The attribute 'gain' of some drivers is another one, which multiplies this one.
        gain_before_ = begin(FF_GAIN, 0xFFFF, nullptr, settings_.gain_after);
        step("upload a force");
        if (!effect_.begin(file_, FF_CONSTANT))
            throw Error(fmt::format("the wheel takes no constant force: {}", std::strerror(errno)));
    }

    /// False when the wheel is lost.
    bool listen() noexcept {
        std::array<input_event, 64> events;
        for (int i = 0; i < max_reads; ++i) {
            const ssize_t got = system_.read(file_, events);
            if (got < 0 && (errno == EAGAIN || errno == EINTR)) return true;
            if (got < static_cast<ssize_t>(sizeof(input_event))) return false;
            const std::size_t count = static_cast<std::size_t>(got) / sizeof(input_event);
            for (std::size_t n = 0; n < count; ++n) take(events[n]);
            if (count < events.size()) return true;
        }
        return true;
    }

    void take(const input_event& event) noexcept {
        // The system lost events: what follows up to the report is incomplete (evdev's SYN_DROPPED).
        if (event.type == EV_SYN && event.code == SYN_DROPPED) has_lost_ = true;
        if (has_lost_) {
            if (event.type != EV_SYN || event.code != SYN_REPORT) return;
            has_lost_ = false;
            if (input_absinfo now{}; ask_axis(system_, file_, ABS_X, now)) value_ = now.value;
            ask_buttons();
        } else if (event.type == EV_ABS && event.code == ABS_X) value_ = event.value;
        else if (event.type == EV_KEY)
            for (std::size_t i = 0; i < keys_.size(); ++i)
                if (keys_[i] == event.code) mask_ = event.value != 0 ? mask_ | 1u << i : mask_ & ~(1u << i);
    }

    /// rad, clockwise as the user sees it, from the middle.
    double angle() const noexcept { return ((static_cast<double>(value_) - axis_.minimum) / steps() - 0.5) * range_; }

    driver::Reading reading(double angle) const noexcept {
        driver::Reading reading;
        reading.is_valid = value_ >= axis_.minimum && value_ <= axis_.maximum;
        reading.buttons = driver::buttons_of_mask(mask_);
        const double r = settings_.radius;
        if (settings_.motion == Motion::slide) {
            reading.pose.position = {r * angle, 0.0, 0.0};
            return reading;
        }
        // The axle points away from the user. The hand is at rest at the top of the rim.
        reading.pose.position = {r * std::sin(angle), 0.0, r * (std::cos(angle) - 1.0)};
        reading.pose.orientation = rotation_by(Vec3(0.0, angle, 0.0));
        return reading;
    }

    /// Of the effect, from the work of the force when the wheel turns a little.
    double strength(double angle, const Wrench& on_hand) const noexcept {
        if (value_ < axis_.minimum || value_ > axis_.maximum) return 0.0;
        const double r = settings_.radius;
        const double clockwise = settings_.motion == Motion::slide
                                     ? r * on_hand.force.x
                                     : r * (std::cos(angle) * on_hand.force.x - std::sin(angle) * on_hand.force.z);
        return (settings_.is_reversed ? 1.0 : -1.0) * clockwise / settings_.max_torque;
    }

    EventSystem& system_;
    Settings settings_;
    ForceEffect effect_;
    int file_ = -1;
    input_absinfo axis_{};
    std::int32_t value_ = 0;
    std::array<std::uint16_t, 4> keys_{};
    std::optional<std::uint16_t> centring_before_, gain_before_;  ///< while they are ours
    std::uint32_t mask_ = 0;
    double range_ = 0.0;
    std::int64_t refused_ns_ = 0;
    bool gives_ = false, has_lost_ = false;
};

}  // namespace

std::unique_ptr<driver::Backend> make_wheel_of(EventSystem& system, Options& options) {
    static const std::vector<std::string> motions{"slide", "rim"};
    Settings settings;
    settings.file = options.text("file", "");
    settings.serial = options.text("serial", "");
    if (options.has("range")) settings.range = options.quantity("range", "900 deg", "10 deg", "10000 deg");
    settings.radius = options.quantity("radius", "140 mm", "10 mm", "500 mm");
    settings.states_torque = options.has("max_torque");
    settings.max_torque = options.quantity("max_torque", "30 N m", "0.1 N m", "30 N m");
    settings.motion = options.choice("moves", motions, "slide") == 0 ? Motion::slide : Motion::rim;
    settings.is_reversed = options.flag("reversed", false);
    settings.centring_after = options.quantity("centring_after", "0", "0", "1");
    settings.gain_after = options.quantity("gain_after", "1", "0", "1");
    return std::make_unique<Wheel>(system, std::move(settings));
}

std::unique_ptr<driver::Backend> make_wheel(Options& options) { return make_wheel_of(linux_events(), options); }

}  // namespace tactus::evdev
