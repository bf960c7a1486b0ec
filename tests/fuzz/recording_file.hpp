// SPDX-License-Identifier: Apache-2.0
// What the fuzz targets of all kinds of recordings try.
#pragma once

#include "assets/table/recording.hpp"
#include "dsp/core/error.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <string_view>

namespace tactus {

/// Aborts unless `read` makes of the bytes channels of which a log can be made, or throws tactus::Error with a text.
template <typename Read>
void log_or_refuse(const std::uint8_t* data, std::size_t size, Read read) {
    try {
        const table::Recording recording = read(std::string_view(reinterpret_cast<const char*>(data), size), "r");
        for (const table::RecordedChannel& channel : recording.channels) {
            table::LogSelection how;
            how.columns = {channel.name};
            try {
                const table::SampleLog log = table::log_of_recording(recording, "r", how);
                if (log.columns.at(0).size() != log.times.size()) std::abort();
            } catch (const Error&) {
                // Some channels have no usable times.
            }
        }
    } catch (const Error& error) {
        if (std::string_view(error.what()).empty()) std::abort();
    } catch (const std::bad_alloc&) {
        // Packed data may need more memory than the limit.
    }
}

}  // namespace tactus
