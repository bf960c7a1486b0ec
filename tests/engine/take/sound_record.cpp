// SPDX-License-Identifier: Apache-2.0
#include "engine/take/sound_record.hpp"

#include "engine/take/timing_log.hpp"
#include "tests/support/catch.hpp"

#include <bit>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>

#include <unistd.h>

using namespace tactus;

TEST_CASE("a record of the log keeps every bit of its samples, through a file, too") {
    float samples[take::sound_record_samples];
    for (int i = 0; i < take::sound_record_samples; ++i)
        samples[i] = std::bit_cast<float>(0x3F800000u + 77777u * static_cast<std::uint32_t>(i));
    samples[0] = std::bit_cast<float>(0x7F800001u);  // a signalling NaN
    samples[7] = std::bit_cast<float>(0xFFC12345u);
    samples[39] = std::numeric_limits<float>::denorm_min();
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("tactus_heard_" + std::to_string(::getpid()));
    {
        take::TimingLogWriter writer(file, 1, 1.0);
        take::TimingRecord record;
        record.kind = take::TimingKind::heard;
        record.count = record.value = take::sound_record_samples;
        record.sample = take::pack_sound(samples, take::sound_record_samples);
        writer.write(record);
        writer.finish();
    }
    const take::TimingLog log = take::TimingLog::load(file);
    std::filesystem::remove(file);
    REQUIRE(log.groups.at(0).records == 1);
    take::GroupRecords records(log, 0);
    REQUIRE(records.at(0));
    const auto back = take::unpack_sound(records.at(0)->sample);
    for (int i = 0; i < take::sound_record_samples; ++i)
        CHECK(std::bit_cast<std::uint32_t>(back[static_cast<std::size_t>(i)]) ==
              std::bit_cast<std::uint32_t>(samples[i]));
    const DeviceSample few = take::pack_sound(samples + 1, 3);
    CHECK(take::unpack_sound(few)[2] == samples[3]);
    CHECK(take::unpack_sound(few)[3] == 0.0F);
    CHECK_FALSE(few.valid);
}

TEST_CASE("a log whose record of what was heard has no samples, or more than it holds, is damaged") {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("tactus_heard_" + std::to_string(::getpid()));
    for (const auto& [count, value] : {std::pair{0, 0}, {10, 0}, {10, 11}, {100, 41}}) {
        take::TimingLogWriter writer(file, 1, 1.0);
        take::TimingRecord record;
        record.kind = take::TimingKind::heard;
        record.count = count;
        record.value = value;
        writer.write(record);
        writer.finish();
        CHECK_THROWS_WITH(take::TimingLog::load(file), Catch::Matchers::ContainsSubstring("damaged"));
    }
    std::filesystem::remove(file);
}
