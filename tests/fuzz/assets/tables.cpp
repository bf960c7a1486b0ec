// SPDX-License-Identifier: Apache-2.0
// All that is a table of numbers: any text is read as each of them or refused with one message, and what is read is
// finite.
#include "assets/display/touch_file.hpp"
#include "assets/sound/response_file.hpp"
#include "assets/table/deflection_file.hpp"
#include "assets/table/trajectory.hpp"
#include "dsp/core/error.hpp"
#include "tests/fuzz/memory_file.hpp"

#include <cmath>
#include <cstdlib>

namespace {

template <typename Load>
void try_reader(const std::filesystem::path& path, Load load) {
    try {
        load(path);
    } catch (const tactus::Error& error) {
        if (error.message().empty() || error.message().find('\n') != std::string::npos) std::abort();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tactus;
    const MemoryFile file(data, size, "table.csv");
    try_reader(file.path(), [](const auto& path) {
        for (const TrajectorySample& sample : read_trajectory(path).samples)
            if (!is_finite(sample.pose.position)) std::abort();
    });
    try_reader(file.path(), [](const auto& path) {
        for (const Vec3& place : load_places(path))
            if (!is_finite(place)) std::abort();
    });
    try_reader(file.path(), [](const auto& path) { load_touches(path); });
    try_reader(file.path(), [](const auto& path) { load_response(path); });
    try_reader(file.path(), [](const auto& path) { load_deflection_table(path); });
    try_reader(file.path(), [](const auto& path) {
        if (!std::isfinite(load_force_calibration(path).slope)) std::abort();
    });
    return 0;
}
