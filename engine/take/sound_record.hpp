// SPDX-License-Identifier: Apache-2.0
// Recorded samples of a sound input in a record of the timing log. They are stored in the numbers of its DeviceSample,
// so that all records have one size; flags stay false.
#pragma once

#include "graph/node/device.hpp"

#include <array>
#include <cstddef>
#include <cstring>

namespace tactus::take {

/// Number of samples per record: two in each word of eight bytes.
inline constexpr int sound_record_samples = 40;

namespace detail {

template <class Sample, class Visit>
void each_word(Sample& s, Visit visit) noexcept {
    for (int i = 0; i < 3; ++i) visit(s.pose.position[i]);
    visit(s.pose.orientation.w);
    visit(s.pose.orientation.x);
    visit(s.pose.orientation.y);
    visit(s.pose.orientation.z);
    for (int i = 0; i < 3; ++i) visit(s.twist.linear[i]);
    for (int i = 0; i < 3; ++i) visit(s.twist.angular[i]);
    visit(s.counter);
    for (auto& finger : s.fingers) {
        visit(finger.position);
        visit(finger.force);
        visit(finger.state);
    }
}

}  // namespace detail

/// Packs `count` samples, at most sound_record_samples. Real-time safe.
inline DeviceSample pack_sound(const float* samples, int count) noexcept {
    std::array<float, sound_record_samples> all{};
    std::memcpy(all.data(), samples, sizeof(float) * static_cast<std::size_t>(count));
    DeviceSample packed;
    const float* at = all.data();
    detail::each_word(packed, [&](auto& word) {
        static_assert(sizeof word == 2 * sizeof(float));
        std::memcpy(&word, at, sizeof word);
        at += 2;
    });
    return packed;
}

inline std::array<float, sound_record_samples> unpack_sound(const DeviceSample& packed) noexcept {
    std::array<float, sound_record_samples> all{};
    float* at = all.data();
    detail::each_word(packed, [&](const auto& word) {
        std::memcpy(at, &word, sizeof word);
        at += 2;
    });
    return all;
}

}  // namespace tactus::take
