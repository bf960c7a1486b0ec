// SPDX-License-Identifier: Apache-2.0
#include "tools/touch_session.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>
#include <vector>

namespace tactus {

namespace {

constexpr double period = 1e-3;        // s
constexpr int held = 200;              // periods that a touch is read
constexpr int patience = 60'000;       // periods that a simulated hand may take
constexpr double most_moved = 1e-3;    // m, while it is read
constexpr int most_tries = 3;

/// One part is a device, the mirror, or one screen.
bool same_part(const RigTouch& a, const RigTouch& b) { return a.of == b.of && a.screen == b.screen; }

}  // namespace

TipReader::TipReader(std::unique_ptr<HapticDevice> device, bool is_real, const Vec3& tip,
                     std::unique_ptr<HapticDevice> tracker)
    : device_(std::move(device)), tracker_(std::move(tracker)), is_real_(is_real), tip_(tip) {
    device_->prepare(period);
    if (tracker_) tracker_->prepare(period);
}

DeviceSample TipReader::read() {
    if (is_real_) std::this_thread::sleep_for(std::chrono::duration<double>(period));
    const double elapsed = std::exchange(has_begun_, true) ? period : 0.0;
    const DeviceSample sample = device_->acquire(elapsed);
    device_->commit({});
    if (!tracker_) return sample;
    const DeviceSample seen = tracker_->acquire(elapsed);
    tracker_->commit({});
    if (seen.valid) tracked_ = seen.pose.position;
    return sample;
}

TipReader::Touched TipReader::touch(const std::function<bool()>& is_asked, const std::function<void()>& tend) {
    for (int waited = 0;; ++waited) {
        if (!is_real_ && waited > patience)
            throw Error("the simulated hand pressed no button for a minute; its script needs a press for every touch");
        const DeviceSample sample = read();
        const bool pressed = sample.valid && (sample.buttons & button_trigger) != 0;
        const bool begins = pressed && !was_pressed_;
        was_pressed_ = pressed;
        if (waited % 16 == 0 && tend) tend();
        if (begins || (waited % 16 == 0 && is_asked && is_asked())) break;
    }
    std::vector<Vec3> places;
    Touched touched;
    for (int n = 0; n < held; ++n) {
        const DeviceSample sample = read();
        was_pressed_ = sample.valid && (sample.buttons & button_trigger) != 0;
        if (!sample.valid || !is_valid(sample.pose) || sample.counter == last_counter_) continue;
        last_counter_ = sample.counter;
        places.push_back(sample.pose.apply(tip_));
        touched.tip += places.back();
        touched.tracked += tracked_;
    }
    if (places.size() < 10)
        throw Error(
            "the device gave no valid samples while it touched; is it plugged in, and does 'tactus devices' list it?");
    touched.tip /= static_cast<double>(places.size());
    touched.tracked /= static_cast<double>(places.size());
    for (const Vec3& place : places) touched.moved = std::max(touched.moved, glm::length(place - touched.tip));
    return touched;
}

void TouchSession::run(TipReader& tip, std::vector<RigTouch>& steps, bool has_tracker) const {
    std::vector<int> tries(steps.size(), 0);
    const auto fill = [&](std::size_t i) {
        for (;; ++tries[i]) {
            show(steps[i], i, steps.size());
            const TipReader::Touched touched = tip.touch(is_asked, tend);
            if (touched.moved <= most_moved) {
                steps[i].reading = touched.tip;
                if (has_tracker && steps[i].of == RigTouch::Of::workspace) steps[i].place = touched.tracked;
                return;
            }
            const std::string moved = fmt::format(
                "the tip moved by {:.1f} mm while it touched; hold it still for a "
                "fifth of a second and press again",
                touched.moved * 1e3);
            if (tries[i] + 1 >= most_tries) throw Error(moved);
            say(moved);
        }
    };
    for (std::size_t i = 0; i < steps.size(); ++i) {
        fill(i);
        if (i + 1 < steps.size() && same_part(steps[i], steps[i + 1])) continue;
        for (;;) {
            try {
                check(std::span(steps).first(i + 1));
                break;
            } catch (const BadTouch& bad) {
                if (++tries[bad.touch] >= most_tries) throw;
                say(bad.message());
                fill(bad.touch);
            }
        }
    }
}

}  // namespace tactus
