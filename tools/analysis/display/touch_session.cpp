// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/display/touch_session.hpp"

#include <chrono>
#include <thread>
#include <utility>
#include <vector>

namespace tactus::analysis {

namespace {

constexpr double period = 1e-3;        // s
constexpr int held = static_cast<int>(touch_lasts / period);  // periods per touch
constexpr int patience = 60'000;       // greatest number of periods to wait for a simulated hand

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
    tracked_.reset();
    if (is_good(seen)) tracked_ = seen.pose.position;
    return sample;
}

Touched TipReader::touch(const std::function<bool()>& is_asked, const std::function<void()>& tend) {
    for (int waited = 0;; ++waited) {
        if (!is_real_ && waited > patience)
            throw Error(
                "the simulated hand did not press a button for a minute; its script needs a press for every touch");
        const DeviceSample sample = read();
        const bool pressed = sample.valid && (sample.buttons & button_trigger) != 0;
        const bool begins = pressed && !was_pressed_;
        was_pressed_ = pressed;
        if (waited % 16 == 0 && tend) tend();
        if (begins || (waited % 16 == 0 && is_asked && is_asked())) break;
    }
    std::vector<Vec3> tips, tracked;
    for (int n = 0; n < held; ++n) {
        const DeviceSample sample = read();
        was_pressed_ = sample.valid && (sample.buttons & button_trigger) != 0;
        if (!is_good(sample) || sample.counter == last_counter_) continue;
        last_counter_ = sample.counter;
        tips.push_back(sample.pose.apply(tip_));
        if (tracked_) tracked.push_back(*tracked_);
    }
    return touch_of(tips, tracked);
}

void TouchSession::run(TipReader& tip, TouchLead& lead) const {
    while (!lead.is_done()) {
        show(lead.steps()[lead.due()], lead.due(), lead.steps().size());
        const std::string wrong = lead.take(tip.touch(is_asked, tend));
        if (!wrong.empty()) say(wrong);
    }
}

}  // namespace tactus::analysis
