// SPDX-License-Identifier: Apache-2.0
#include "devices/driver/exchange.hpp"

#include "dsp/core/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::driver {

namespace {

// Samples that arrive in a burst give no velocity, because their time stamps are those of the transmission.
constexpr std::int64_t min_step_ns = 100'000, longest_step_ns = 50'000'000;

void put(const Vec3& v, double (&into)[3]) noexcept {
    for (int i = 0; i < 3; ++i) into[i] = v[i];
}

Vec3 get(const double (&from)[3]) noexcept { return {from[0], from[1], from[2]}; }

}  // namespace

void Exchange::begin(const ForceLimits& limits, double noise, double angular_noise) noexcept {
    gate_ = {};
    gate_.fade_ns = force_fade_ns;
    gate_.is_felt = limits.is_felt;
    gate_.bounds = {limits.force, limits.torque};
    noise_ = noise;
    angular_noise_ = angular_noise;
    windowed_ns_ = 0;
}

void Exchange::estimate(Reading& reading, std::int64_t now) noexcept {
    const std::int64_t step = now - windowed_ns_;
    if (windowed_ns_ == 0 || step < 0 || step > longest_step_ns) {
        speed_.prepare(noise_);
        spin_.prepare(angular_noise_);
        turned_from_ = reading.pose.orientation;
        turned_ = Vec3(0.0);
        speed_(reading.pose.position, 0.0);
        spin_(turned_, 0.0);
        twist_ = {};
        windowed_ns_ = now;
    } else if (step >= min_step_ns) {
        const double elapsed = static_cast<double>(step) * 1e-9;
        // The way turned, summed from small rotations: it has no seam at half a turn.
        turned_ += rotation_between(turned_from_, reading.pose.orientation);
        turned_from_ = reading.pose.orientation;
        twist_ = {speed_(reading.pose.position, elapsed), spin_(turned_, elapsed)};
        windowed_ns_ = now;
    }
    reading.twist = twist_;
}

void Exchange::store(const Reading& reading, std::int64_t now) noexcept {
    Stored stored{};
    put(reading.pose.position, stored.position);
    const Quat& q = reading.pose.orientation;
    stored.orientation[0] = q.w;
    stored.orientation[1] = q.x;
    stored.orientation[2] = q.y;
    stored.orientation[3] = q.z;
    put(reading.twist.linear, stored.linear);
    put(reading.twist.angular, stored.angular);
    stored.counter = ++counter_;
    stored.at_ns = now;
    stored.buttons = reading.buttons;
    // While the gate suppresses the force, the sample is invalid, so that the engine releases and re-engages.
    stored.is_valid = reading.is_valid && !gate_.holds() ? 1 : 0;
    sample_.write(stored);
    published_.store(counter_, std::memory_order_relaxed);
}

void Exchange::publish(const Reading& given) noexcept {
    const std::int64_t now = now_();
    Reading reading = given;
    reading.is_valid = reading.is_valid && tactus::is_valid(reading.pose);
    if (reading.is_valid) {
        reading.pose.orientation = glm::normalize(reading.pose.orientation);
        if (!reading.has_twist) estimate(reading, now);
        reading.is_valid = is_good(reading.pose, reading.twist);
    } else windowed_ns_ = 0;
    store(reading, now);
}

void Exchange::publish_loss() noexcept {
    Reading none;
    none.is_valid = false;
    publish(none);
}

Wrench Exchange::force() noexcept {
    const std::int64_t now = now_();
    force_.read(committed_, commit_number_);
    gate_.limit_ns = oldest_ns_.load(std::memory_order_relaxed);
    return gate_.give(committed_, commit_number_, now);
}

DeviceSample Exchange::newest() noexcept {
    // One that is being written for ever is as old as the one before.
    sample_.read(newest_, number_);
    DeviceSample sample;
    sample.pose.position = get(newest_.position);
    sample.pose.orientation =
        Quat(newest_.orientation[0], newest_.orientation[1], newest_.orientation[2], newest_.orientation[3]);
    sample.twist = {get(newest_.linear), get(newest_.angular)};
    sample.buttons = static_cast<std::uint32_t>(newest_.buttons);
    sample.counter = newest_.counter;
    sample.valid = newest_.is_valid == 1 && hosted::is_young(newest_.at_ns, now_(), oldest_sample_ns);
    return sample;
}

void Exchange::commit(const Wrench& on_hand) noexcept { force_.write(hosted::pack(on_hand, now_())); }

void Exchange::expect(double period_s) noexcept {
    oldest_ns_.store(std::max<std::int64_t>(oldest_force_ns, std::llround(3e9 * period_s)), std::memory_order_relaxed);
}

}  // namespace tactus::driver
