// SPDX-License-Identifier: Apache-2.0
#include "tests/devices/driver/event_peer.hpp"

#include "devices/evdev/wheel.hpp"
#include "dsp/core/clock.hpp"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numbers>
#include <thread>

namespace tactus::test {

namespace {

int fail(int why) {
    errno = why;
    return -1;
}

}  // namespace

FakeEvents::~FakeEvents() {
    is_hung = false;
    for (int i = 0; i < 2000 && open_files() > 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

void FakeEvents::hang() const {
    while (is_hung) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

FakeEvents::File* FakeEvents::find(int file) {
    const auto found = files_.find(file);
    return found == files_.end() ? nullptr : &found->second;
}

int FakeEvents::open(const std::string& wanted, int flags) noexcept {
    hang();
    const std::lock_guard lock(mutex_);
    if (is_away_ || wanted != path) return fail(ENOENT);
    const bool writes = (flags & O_ACCMODE) == O_RDWR;
    if (writes && is_read_only) return fail(EACCES);
    files_[next_file_].is_writable = writes;
    return next_file_++;
}

void FakeEvents::close(int file) noexcept {
    const std::lock_guard lock(mutex_);
    files_.erase(file);  // with its effects
}

int FakeEvents::answer_bits(unsigned kind, unsigned char* into, std::size_t size) {
    const auto set = [&](unsigned code) {
        if (code / 8 < size) into[code / 8] = static_cast<unsigned char>(into[code / 8] | 1u << (code % 8));
    };
    std::memset(into, 0, size);
    if (kind == EV_FF)
        for (const unsigned code : effects) set(code);
    if (kind == EV_KEY)
        for (const unsigned code : keys) set(code);
    if (kind == EV_ABS)
        for (const auto& [code, info] : axes) set(code);
    return 0;
}

int FakeEvents::upload(File& file, ff_effect& effect) {
    if (!file.is_writable) return fail(EBADF);
    if (refuses) return fail(EIO);
    bool is_known = false;
    for (const unsigned code : effects) is_known = is_known || code == effect.type;
    if (!is_known) return fail(EINVAL);
    if (effect.id == -1) effect.id = static_cast<std::int16_t>(next_effect_++);
    else if (!file.effects.contains(effect.id)) return fail(EINVAL);
    ++uploads;
    file.effects[effect.id].effect = effect;  // one that plays goes on with its new strength, no longer than before
    return 0;
}

int FakeEvents::answer(File& file, unsigned long request, std::uintptr_t argument) {
    auto* const out = reinterpret_cast<unsigned char*>(argument);
    const std::size_t size = _IOC_SIZE(request);
    const unsigned number = _IOC_NR(request);
    const auto text = [&](const std::string& said) {
        if (said.empty()) return fail(ENOENT);
        std::memcpy(out, said.c_str(), std::min(size, said.size() + 1));
        return static_cast<int>(said.size());
    };
    if (request == EVIOCSFF) return upload(file, *reinterpret_cast<ff_effect*>(argument));
    if (request == EVIOCRMFF) return file.effects.erase(static_cast<int>(argument)) == 1 ? 0 : fail(EINVAL);
    if (request == EVIOCGID) {
        const input_id id{BUS_USB, 0x046D, 0xC24F, 0x111};
        std::memcpy(out, &id, sizeof id);
        return 0;
    }
    if (number == _IOC_NR(EVIOCGNAME(0))) return text(name);
    if (number == _IOC_NR(EVIOCGUNIQ(0))) return text(serial);
    if (number == _IOC_NR(EVIOCGKEY(0))) {
        std::memset(out, 0, size);
        for (const auto& [code, value] : held_)
            if (value != 0 && code / 8 < size)
                out[code / 8] = static_cast<unsigned char>(out[code / 8] | 1u << code % 8);
        return 0;
    }
    if (number >= 0x20 && number < 0x40) return answer_bits(number - 0x20, out, size);
    if (number >= 0x40 && number < 0x80) {
        const auto found = axes.find(number - 0x40);
        if (found == axes.end()) return fail(EINVAL);
        std::memcpy(out, &found->second, sizeof(input_absinfo));
        return 0;
    }
    return fail(EINVAL);
}

int FakeEvents::control(int file, unsigned long request, std::uintptr_t argument) noexcept {
    hang();
    const std::lock_guard lock(mutex_);
    File* const found = find(file);
    if (!found) return fail(EBADF);
    return found->is_lost ? fail(ENODEV) : answer(*found, request, argument);
}

bool FakeEvents::wait(int file, int longest_ms) noexcept {
    for (int waited = 0; waited < longest_ms; ++waited) {
        hang();
        {
            const std::lock_guard lock(mutex_);
            const File* const found = find(file);
            if (!found || found->is_lost || !found->events.empty()) return true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

ssize_t FakeEvents::read(int file, std::span<input_event> events) noexcept {
    hang();
    const std::lock_guard lock(mutex_);
    File* const found = find(file);
    if (!found) return fail(EBADF);
    if (found->is_lost) return fail(ENODEV);
    if (found->events.empty()) return fail(EAGAIN);
    std::size_t count = 0;
    for (; count < events.size() && !found->events.empty(); ++count) {
        events[count] = found->events.front();
        found->events.pop_front();
    }
    return static_cast<ssize_t>(count * sizeof(input_event));
}

bool FakeEvents::write(int file, const input_event& event) noexcept {
    hang();
    const std::lock_guard lock(mutex_);
    File* const found = find(file);
    if (!found || !found->is_writable || event.type != EV_FF) return fail(EBADF) == 0;
    if (found->is_lost) return fail(ENODEV) == 0;
    if (event.code == FF_GAIN) gain = event.value;
    else if (event.code == FF_AUTOCENTER) autocenter = event.value;
    else if (const auto effect = found->effects.find(event.code); effect != found->effects.end())
        effect->second.until_ns =
            event.value == 0 ? 0 : steady_ns() + effect->second.effect.replay.length * 1'000'000LL;
    return true;
}

std::vector<std::string> FakeEvents::devices() {
    return is_away_ ? std::vector<std::string>{} : std::vector<std::string>{path};
}

std::string FakeEvents::attribute(const std::string&, const std::string& wanted) {
    if (wanted == "range") return range;
    return wanted == "autocenter" ? stated_centring : "";
}

void FakeEvents::tell(std::uint16_t type, std::uint16_t code, int value, bool is_dropped) {
    const std::lock_guard lock(mutex_);
    if (type == EV_ABS) axes[code].value = value;
    if (type == EV_KEY) held_[code] = value;
    const auto event = [](std::uint16_t a, std::uint16_t b, int c) {
        input_event made{};
        made.type = a;
        made.code = b;
        made.value = c;
        return made;
    };
    for (auto& [number, file] : files_) {
        if (is_dropped) file.events.assign(1, event(EV_SYN, SYN_DROPPED, 0));
        else file.events.push_back(event(type, code, value));
        file.events.push_back(event(EV_SYN, SYN_REPORT, 0));
    }
}

void FakeEvents::say(std::uint16_t type, std::uint16_t code, int value) { tell(type, code, value, false); }
void FakeEvents::drop(std::uint16_t type, std::uint16_t code, int value) { tell(type, code, value, true); }

std::vector<ff_effect> FakeEvents::playing() {
    const std::lock_guard lock(mutex_);
    std::vector<ff_effect> found;
    const std::int64_t now = steady_ns();
    for (const auto& [number, file] : files_)
        for (const auto& [id, one] : file.effects)
            if (!file.is_lost && now < one.until_ns) found.push_back(one.effect);
    return found;
}

std::size_t FakeEvents::uploaded() {
    const std::lock_guard lock(mutex_);
    std::size_t count = 0;
    for (const auto& [number, file] : files_) count += file.effects.size();
    return count;
}

std::size_t FakeEvents::open_files() {
    const std::lock_guard lock(mutex_);
    return files_.size();
}

void FakeEvents::unplug(bool on) {
    const std::lock_guard lock(mutex_);
    is_away_ = on;
    if (on)
        for (auto& [number, file] : files_) file.is_lost = true;
}

namespace {

constexpr double radius = 0.14, max_torque = 2.0, range = 900.0 * std::numbers::pi / 180.0;
constexpr int most = 65535;

class WheelPeer final : public Peer {
public:
    WheelPeer() {
        turns = twists = false;
        moves_along = 1;
        exact = 0.5 * radius * range / most * 1.0001;
        exact_force = 0.5 * max_torque / radius / 32767.0 * 1.0001;
        events_.axes[ABS_X] = {.value = most / 2, .minimum = 0, .maximum = most, .fuzz = 0, .flat = 0, .resolution = 0};
        events_.keys = {BTN_TRIGGER, BTN_THUMB, BTN_THUMB2, BTN_TOP, BTN_TOP2};
        events_.effects = {FF_CONSTANT, FF_GAIN, FF_AUTOCENTER};
    }
    std::unique_ptr<driver::Backend> backend() override {
        Options options = options_of({{"max_torque", "2 N m", {}}});
        return evdev::make_wheel_of(events_, options);
    }
    void place(const Vec3& position, const Quat&) override {
        count_ = static_cast<int>(std::lround((position.x / radius / range + 0.5) * most));
        if (!is_nan_) events_.say(EV_ABS, ABS_X, count_);
    }
    void press(std::uint32_t mask) override {
        for (unsigned i = 0; i < 5; ++i)
            events_.say(EV_KEY, static_cast<std::uint16_t>(BTN_TRIGGER + i), mask >> i & 1);
    }
    /// Effects push to the left, and add.
    Wrench given() override {
        double share = 0.0;
        for (const ff_effect& one : events_.playing())
            if (one.type == FF_CONSTANT && one.direction == 0x4000) share -= one.u.constant.level / 32767.0;
        return {{share * max_torque / radius, 0.0, 0.0}, {}};
    }
    void hang(bool on) override { events_.is_hung = on; }
    void unplug(bool on) override { events_.unplug(on); }
    /// A count has no way to say that a number is none: it is beyond what the wheel states.
    void send_nan(bool on) override {
        is_nan_ = on;
        events_.say(EV_ABS, ABS_X, on ? most + 1 : count_);
    }
    void burst() override {
        for (int i = 0; i < 2000; ++i) events_.say(EV_ABS, ABS_X, count_);
        events_.drop(EV_ABS, ABS_X, count_);
    }

private:
    FakeEvents events_;
    int count_ = most / 2;
    bool is_nan_ = false;
};

}  // namespace

std::unique_ptr<Peer> make_wheel_peer() { return std::make_unique<WheelPeer>(); }

}  // namespace tactus::test
