// SPDX-License-Identifier: Apache-2.0
#include "devices/evdev/force_effect.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::evdev {

namespace {

constexpr std::uint16_t to_the_left = 0x4000;
constexpr double max_constant = 0x7FFF, max_rumble = 0xFFFF;

}  // namespace

void ForceEffect::set(int level) noexcept {
    level_ = level;
    if (effect_.type == FF_CONSTANT) effect_.u.constant.level = static_cast<std::int16_t>(level);
    else effect_.u.rumble.strong_magnitude = effect_.u.rumble.weak_magnitude = static_cast<std::uint16_t>(level);
}

bool ForceEffect::upload() noexcept {
    return system_->control(file_, EVIOCSFF, reinterpret_cast<std::uintptr_t>(&effect_)) >= 0;
}

bool ForceEffect::play(int times) noexcept {
    input_event event{};
    event.type = EV_FF;
    event.code = static_cast<std::uint16_t>(effect_.id);
    event.value = times;
    return system_->write(file_, event);
}

bool ForceEffect::begin(int file, std::uint16_t type) noexcept {
    file_ = file;
    effect_ = {};
    effect_.type = type;
    effect_.id = -1;
    effect_.direction = to_the_left;
    effect_.replay.length = lasts_ms;
    set(0);
    played_ns_ = 0;
    is_told_ = upload();
    if (!is_told_) file_ = -1;
    return is_told_;
}

bool ForceEffect::give(double strength, std::int64_t now) noexcept {
    if (file_ < 0) return false;
    const bool is_constant = effect_.type == FF_CONSTANT;
    const double share = std::isfinite(strength) ? std::clamp(strength, is_constant ? -1.0 : 0.0, 1.0) : 0.0;
    const int level = static_cast<int>(std::lround(share * (is_constant ? max_constant : max_rumble)));
    // The same id again changes the effect while it plays.
    if (level != level_ || !is_told_) {
        set(level);
        is_told_ = upload();
        if (!is_told_) return false;
    }
    if (level == 0 || (played_ns_ != 0 && now - played_ns_ < told_again_ns)) return true;
    if (!play(1)) return false;
    played_ns_ = now;
    return true;
}

void ForceEffect::end() noexcept {
    if (file_ < 0) return;
    set(0);
    upload();
    play(0);
    system_->control(file_, EVIOCRMFF, static_cast<std::uintptr_t>(effect_.id));
    file_ = -1;
}

}  // namespace tactus::evdev
