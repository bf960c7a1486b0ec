// SPDX-License-Identifier: Apache-2.0
// Any bytes are channels of which a log can be made, or a tactus::Error.
#include "assets/table/recording.hpp"
#include "dsp/core/error.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const tactus::table::Recording recording =
            tactus::table::read_matlab_file({reinterpret_cast<const char*>(data), size}, "r");
        for (const tactus::table::RecordedChannel& channel : recording.channels) {
            tactus::table::LogSelection how;
            how.columns = {channel.name};
            try {
                const tactus::table::SampleLog log = tactus::table::log_of_recording(recording, "r", how);
                if (log.columns.at(0).size() != log.times.size()) std::abort();
            } catch (const tactus::Error&) {
                // Some channels have no usable times.
            }
        }
    } catch (const tactus::Error& error) {
        if (std::string_view(error.what()).empty()) std::abort();
    } catch (const std::bad_alloc&) {
        // Packed data may need more memory than the limit.
    }
    return 0;
}
