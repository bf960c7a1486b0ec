// SPDX-License-Identifier: Apache-2.0
// TimingLog::load: any bytes are a log, whole or cut off, or are refused with one message.
#include "engine/take/timing_log.hpp"
#include "dsp/core/error.hpp"
#include "tests/fuzz/memory_file.hpp"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const tactus::MemoryFile file(data, size, "timing.log");
    for (const bool may_be_cut : {false, true}) try {
            const tactus::take::TimingLog log = tactus::take::TimingLog::load(file.path(), may_be_cut);
            if (!log.is_whole && !may_be_cut) std::abort();
            for (std::size_t group = 0; group < log.groups.size(); ++group)
                if (log.end_of(group, 705600) < 0) std::abort();
            for (std::size_t group = 0; group < log.groups.size(); ++group) {
                tactus::take::GroupRecords records(log, group);
                for (std::int64_t i = 0; i < log.groups[group].records; ++i)
                    if (!records.at(static_cast<std::size_t>(i))) std::abort();
            }
        } catch (const tactus::Error& error) {
            if (error.message().empty() || error.message().find('\n') != std::string::npos) std::abort();
        }
    return 0;
}
