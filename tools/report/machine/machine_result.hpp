// SPDX-License-Identifier: Apache-2.0
// What a machine has as results: 'devices' and 'cache'.
#pragma once

#include "assets/file/cache.hpp"
#include "devices/audio/portaudio.hpp"
#include "devices/haptic/catalogue.hpp"
#include "tools/report/result/fields.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tactus::report {

struct FoundDevices {
    std::vector<haptic::HapticDriver> haptic;
    std::vector<audio::AudioCard> audio;
    std::string no_sound;  ///< why there is no sound card
};
const Fields<FoundDevices>& devices_fields();

struct ShownCache {
    std::string folder;
    file::CacheContent content;
    std::uintmax_t limit;  ///< bytes; 0: the cache is off
};
const Fields<ShownCache>& cache_fields();
/// What was removed.
const Fields<ShownCache>& cleared_cache_fields();

}  // namespace tactus::report
