// SPDX-License-Identifier: Apache-2.0
// Sweep files and logs of rows: any text is read as a sweep or refused with one message; a sweep has a list of points, each
// with its words; a log has rows, each of which is found again.
#include "assets/sweep/row_log.hpp"
#include "assets/sweep/sweep_file.hpp"
#include "assets/sweep/task_list.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/read_or_refuse.hpp"

#include <algorithm>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const tactus::MemoryFile file(data, size, "file.toml");
    tactus::read_or_refuse(file.path(), [](const auto& path) {
        const tactus::sweep::Sweep sweep = tactus::sweep::load_sweep(path, {}, "/nowhere");
        if (sweep.point_count() > 1000) return;
        const tactus::sweep::TaskList list(sweep, [](const auto&) { return std::uint64_t{1}; });
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (list.find(list.id(i)) != i) std::abort();
            for (const tactus::sweep::Step& step : sweep.steps)
                if (tactus::sweep::words_of(sweep, step, list.point(i), list.id(i), "/out", "/tactus").size() !=
                    step.words.size())
                    std::abort();
        }
    });
    tactus::read_or_refuse(file.path(), [](const auto& path) {
        const tactus::sweep::LogReader log(path);
        log.worker();
        log.scan([&](const tactus::sweep::RowHead& head, std::uint64_t at, std::uint32_t length) {
            try {
                const tactus::sweep::Row row = tactus::sweep::read_row(log.line(at, length));
                if (row.point != head.point || row.output != head.output || row.is_ok != head.is_ok) std::abort();
            } catch (const tactus::Error&) {
                // Its head is right, and its rest is no JSON.
            }
        });
    });
    return 0;
}
