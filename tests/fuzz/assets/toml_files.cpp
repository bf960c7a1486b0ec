// SPDX-License-Identifier: Apache-2.0
// All that is written in TOML beside patches: any text is read as each of them or refused with one message.
#include "assets/display/display_file.hpp"
#include "assets/sound/equaliser_file.hpp"
#include "assets/sound/recording_set.hpp"
#include "assets/table/thresholds.hpp"
#include "assets/training/task_file.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/read_or_refuse.hpp"
#include "tools/analysis/rig_matrix.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const tactus::MemoryFile file(data, size, "file.toml");
    tactus::read_or_refuse(file.path(), [](const auto& path) { tactus::display::load_display_file(path); });
    tactus::read_or_refuse(file.path(), [](const auto& path) { tactus::analysis::load_rig_matrix(path); });
    tactus::read_or_refuse(file.path(), [](const auto& path) { tactus::table::load_thresholds(path); });
    tactus::read_or_refuse(file.path(), [](const auto& path) { tactus::sound::load_equaliser(path); });
    tactus::read_or_refuse(file.path(), [](const auto& path) { tactus::sound::load_recording_set(path); });
    tactus::read_or_refuse(file.path(), [](const auto& path) { tactus::training::load_task_file(path); });
    return 0;
}
