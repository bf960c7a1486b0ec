// SPDX-License-Identifier: Apache-2.0
#include "engine/take/packed_records.hpp"

#include "dsp/core/random.hpp"
#include "dsp/simulate/device_model.hpp"
#include "dsp/simulate/script.hpp"
#include "engine/take/timing_log.hpp"
#include "tests/support/catch.hpp"

#include <bit>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <malloc.h>
#include <unistd.h>

using namespace tactus;
using take::TimingKind;
using take::TimingRecord;

namespace {

std::filesystem::path scratch_log() {
    return std::filesystem::temp_directory_path() / ("tactus_packed_" + std::to_string(::getpid()));
}

bool is_same(const TimingRecord& a, const TimingRecord& b) {
    return a.kind == b.kind && a.group == b.group && a.source == b.source && a.count == b.count && a.tick == b.tick &&
           a.value == b.value &&
           take::RecordPrediction::words_of(a.sample) == take::RecordPrediction::words_of(b.sample);
}

/// Any record that a run may write, and bits that it never would.
TimingRecord random_record(const Random& random, std::uint64_t i, std::int64_t tick) {
    const auto bits = [&](std::uint64_t which) { return random.bits(64 * i + which); };
    TimingRecord record;
    record.kind = static_cast<TimingKind>(bits(0) % 9);
    record.group = static_cast<std::uint16_t>(bits(1) % 3);
    record.source = bits(2) % 4 == 0 ? static_cast<std::uint32_t>(bits(3)) : static_cast<std::uint32_t>(bits(3) % 3);
    record.count = bits(4) % 8 == 0 ? std::numeric_limits<std::int32_t>::max() : static_cast<std::int32_t>(bits(5) % 4);
    record.tick = tick;
    record.value = bits(6) % 4 == 0 ? static_cast<std::int64_t>(bits(7)) : tick;
    if (record.kind != TimingKind::device_sample) return record;
    std::uint64_t which = 8;
    const auto number = [&] {
        const std::uint64_t raw = bits(which++);
        return raw % 3 == 0 ? std::bit_cast<double>(raw) : 1e-3 * static_cast<double>(tick);
    };
    for (int k = 0; k < 3; ++k) {
        record.sample.pose.position[k] = number();
        record.sample.twist.linear[k] = number();
        record.sample.twist.angular[k] = number();
    }
    record.sample.pose.orientation = {number(), number(), number(), number()};
    for (FingerSample& finger : record.sample.fingers) finger = {number(), number(), bits(which++)};
    record.sample.counter = static_cast<std::int64_t>(bits(which++));
    record.sample.buttons = static_cast<std::uint32_t>(bits(which++));
    record.sample.valid = bits(which++) % 2;
    record.sample.late = bits(which++) % 2;
    return record;
}

/// A hand of 0.2 kg on a device, 1 kHz.
template <class Operator>
std::vector<TimingRecord> samples_of(Operator moving, const simulate::DeviceModel& model, int count) {
    simulate::ModelledDevice device(model, {});
    device.place({});
    std::vector<TimingRecord> all;
    for (int i = 0; i < count; ++i) {
        device.advance(moving, {}, 1e-3);
        TimingRecord record;
        record.kind = TimingKind::device_sample;
        record.tick = i;
        record.count = 1;
        record.sample = {device.pose(), device.twist(), 0, i + 1, true};
        all.push_back(record);
    }
    return all;
}

double megabytes_an_hour(const std::vector<TimingRecord>& samples) {
    take::TimingLogWriter writer(scratch_log(), 1, 1.0, take::TimingLogWriter::Name::at_once);
    for (const TimingRecord& record : samples) {
        writer.write(record);
        if (record.tick % 500 == 0) writer.flush();
    }
    writer.finish();
    const auto bytes = static_cast<double>(std::filesystem::file_size(scratch_log()));
    std::filesystem::remove(scratch_log());
    return 1e-6 * bytes * 3.6e6 / static_cast<double>(samples.size());
}

}  // namespace

TEST_CASE("packed records keep every bit of any record") {
    const Random random{17};
    std::vector<TimingRecord> written;
    {
        take::TimingLogWriter writer(scratch_log(), 7, 2.0);
        for (std::uint64_t i = 0; i < 20'000; ++i) {
            written.push_back(random_record(random, i, static_cast<std::int64_t>(i / 3)));
            writer.write(written.back());
            if (i % 777 == 0) writer.flush();
        }
        writer.finish();
    }
    const take::TimingLog log = take::TimingLog::load(scratch_log());
    std::filesystem::remove(scratch_log());
    CHECK(log.is_whole);
    CHECK(log.records == 20'001);
    std::size_t differing = 0;
    for (std::size_t group = 0; group < 3; ++group) {
        take::GroupRecords records(log, group);
        std::size_t at = 0;
        for (const TimingRecord& record : written) {
            if (record.group != group) continue;
            const TimingRecord* const read = records.at(at);
            REQUIRE(read);
            TimingRecord with_group = *read;
            with_group.group = record.group;
            differing += !is_same(with_group, record);
            records.forget_before(at++);
        }
        CHECK(records.at(at) == nullptr);
    }
    CHECK(differing == 0);
}

TEST_CASE("an hour of a moving 1 kHz hand takes at most 250 MB of log, of a resting one 40 MB") {
    simulate::DeviceModel ideal;
    ideal.max_force = 20.0;
    const simulate::ScriptOperator resting({{0.0, {}}}, {}), moving({{0.0, {}}}, {0.05, 0.5, 3.0});
    for (const simulate::DeviceModel* model :
         {static_cast<const simulate::DeviceModel*>(&ideal), simulate::find_device_model("touch"),
          simulate::find_device_model("omega"), simulate::find_device_model("falcon")}) {
        INFO(model->name);
        CHECK(megabytes_an_hour(samples_of(resting, *model, 20'000)) <= 40.0);
        CHECK(megabytes_an_hour(samples_of(moving, *model, 20'000)) <= 250.0);
    }
}

TEST_CASE("the memory that a log takes does not grow with its length") {
    const Random random{5};
    take::TimingLogWriter writer(scratch_log(), 1, 1.0, take::TimingLogWriter::Name::at_once);
    TimingRecord record;
    record.kind = TimingKind::device_sample;
    record.count = 1;
    for (record.tick = 0; record.tick < 200'000; ++record.tick) {
        record.sample.pose.position.x = random.uniform(static_cast<std::uint64_t>(record.tick));
        record.sample.counter = record.tick;
        writer.write(record);
    }
    writer.finish();
    const auto before = ::mallinfo2().uordblks;
    const take::TimingLog log = take::TimingLog::load(scratch_log());
    std::filesystem::remove(scratch_log());
    take::GroupRecords records(log, 0);
    std::size_t most = 0;
    for (std::size_t i = 0; i < 200'000; ++i) {
        const TimingRecord* const read = records.at(i);
        REQUIRE(read);
        if (read->sample.pose.position.x != random.uniform(i)) FAIL("record " << i);
        records.forget_before(i);
        if (i % 1000 == 0) most = std::max(most, ::mallinfo2().uordblks);
    }
    CHECK(most < before + 2'000'000);  // the records alone are 42 MB
}

TEST_CASE("a log that was cut off anywhere is read up to its last whole record, and one of other bytes is damaged") {
    const Random random{9};
    {
        take::TimingLogWriter writer(scratch_log(), 1, 1.0, take::TimingLogWriter::Name::at_once);
        for (std::uint64_t i = 0; i < 200; ++i) {
            TimingRecord record = random_record(random, i, static_cast<std::int64_t>(i));
            record.group = static_cast<std::uint16_t>(i % 2);
            writer.write(record);
            if (i % 60 == 59) writer.flush();
        }
        writer.finish();
    }
    std::string bytes;
    {
        std::ifstream file(scratch_log(), std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(file), {});
    }
    std::int64_t before = 0;
    for (std::size_t length = 24; length < bytes.size(); length += 7) {
        std::filesystem::resize_file(scratch_log(), length);
        std::ofstream(scratch_log(), std::ios::binary | std::ios::trunc)
            .write(bytes.data(), static_cast<std::streamsize>(length));
        const take::TimingLog log = take::TimingLog::load(scratch_log(), true);
        CHECK_FALSE(log.is_whole);
        CHECK(log.records >= before);
        before = log.records;
        CHECK_THROWS_WITH(take::TimingLog::load(scratch_log()),
                          Catch::Matchers::ContainsSubstring("stops before the end"));
    }
    CHECK(before > 150);
    std::string damaged = bytes;
    damaged[24 + 8] = '\x0f';  // a kind that there is none of
    std::ofstream(scratch_log(), std::ios::binary | std::ios::trunc)
        .write(damaged.data(), static_cast<std::streamsize>(damaged.size()));
    CHECK_THROWS_WITH(take::TimingLog::load(scratch_log(), true), Catch::Matchers::ContainsSubstring("damaged"));
    std::filesystem::remove(scratch_log());
}
