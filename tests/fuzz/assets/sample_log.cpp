// SPDX-License-Identifier: Apache-2.0
// read_sample_log and regularise: any text is an even record of finite numbers or
// one Error.
#include "assets/table/sample_log.hpp"

#include "dsp/core/error.hpp"
#include "dsp/signal/filter/regularise.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const tactus::table::SampleLog log =
            tactus::table::read_sample_log({reinterpret_cast<const char*>(data), size}, "l.csv", {});
        for (const auto& column : log.columns)
            if (column.size() != log.times.size()) std::abort();
        std::vector<std::vector<double>> columns;
        for (const auto& column : log.columns) columns.push_back(column.values());
        const tactus::signal::EvenRecord even = tactus::signal::regularise(log.times.values(), columns);
        if (!(even.rate > 0.0)) std::abort();
    } catch (const tactus::Error& error) {
        if (std::string_view(error.what()).empty()) std::abort();
    }
    return 0;
}
