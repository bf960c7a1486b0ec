// SPDX-License-Identifier: Apache-2.0
// All that is a table of numbers: any text is read as each of them or refused with one message, and what is read is
// finite.
#include "assets/display/touch_file.hpp"
#include "assets/sound/response_file.hpp"
#include "assets/table/deflection_file.hpp"
#include "assets/table/trajectory.hpp"
#include "assets/vessel/course_file.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/read_or_refuse.hpp"

#include <cmath>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tactus;
    const MemoryFile file(data, size, "table.csv");
    read_or_refuse(file.path(), [](const auto& path) {
        for (const auto& sample : table::read_trajectory(path).samples)
            if (!is_finite(sample.pose.position)) std::abort();
    });
    read_or_refuse(file.path(), [](const auto& path) {
        for (const Vec3& place : display::load_places(path))
            if (!is_finite(place)) std::abort();
    });
    read_or_refuse(file.path(), [](const auto& path) {
        for (const Vec3& place : vessel::load_course(path).points)
            if (!is_finite(place)) std::abort();
    });
    read_or_refuse(file.path(), [](const auto& path) { display::load_touches(path); });
    read_or_refuse(file.path(), [](const auto& path) { sound::load_response(path); });
    read_or_refuse(file.path(), [](const auto& path) { table::load_deflection_table(path); });
    read_or_refuse(file.path(), [](const auto& path) {
        if (!std::isfinite(table::load_force_calibration(path).slope)) std::abort();
    });
    return 0;
}
