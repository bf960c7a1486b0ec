// SPDX-License-Identifier: Apache-2.0
#include "engine/take_compare.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <tuple>

namespace tactus {

namespace {

bool same_bits(const double* a, const double* b, std::size_t count) {
    return std::equal(a, a + count, b, [](double x, double y) {
        return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
    });
}

class CompareEnd : public StreamEnd {
public:
    CompareEnd(TakeComparison& comparison, const Take& take, const TakeStreamInfo& info, const ValueType& type)
        : comparison_(comparison),
          info_(info),
          type_(type),
          names_(channels_of(type)),
          got_(names_.size()),
          reader_(take.folder / info.file, info) {
        if (reader_.channels() != static_cast<int>(names_.size()))
            throw Error(fmt::format("{}: {} channels, but a {} has {}", info.file, reader_.channels(), type.name,
                                    names_.size()));
    }

    void take(std::int64_t first, const std::byte* values, std::size_t count) override {
        std::uint64_t compared = 0;
        for (std::size_t i = 0; i < count && !differs_; ++i) {
            const std::int64_t tick = first + static_cast<std::int64_t>(i);
            const double* expected = reader_.frame(tick);
            if (!expected) break;  // a run that was cut off
            to_frame(type_, values + i * type_.size, got_.data());
            ++compared;
            if (same_bits(expected, got_.data(), got_.size())) continue;
            // What follows a difference differs too.
            differs_ = true;
            comparison_.differs(
                {info_.port, tick, seconds(tick * info_.period), names_, {expected, expected + got_.size()}, got_});
        }
        comparison_.count(compared);
    }
    void finish() override {}

private:
    TakeComparison& comparison_;
    TakeStreamInfo info_;
    const ValueType& type_;
    std::vector<std::string> names_;
    std::vector<double> got_;
    TakeStreamReader reader_;
    bool differs_ = false;
};

}  // namespace

std::unique_ptr<Stream> TakeComparison::tap(const std::string& port, const ValueType& type, const GroupRuntime& group) {
    const auto info = std::ranges::find_if(take_.streams, [&](const TakeStreamInfo& stream) {
        return stream.port == port && stream.group_number == group.index && stream.type == type.name;
    });
    if (info == take_.streams.end()) return nullptr;
    StreamFormat format;
    format.file = info->file;
    format.type = &type;
    format.period = info->period;
    return std::make_unique<Stream>(format, std::make_unique<CompareEnd>(*this, take_, *info, type));
}

void TakeComparison::count(std::uint64_t values) {
    const std::lock_guard lock(lock_);
    compared_ += values;
}

void TakeComparison::differs(TakeDifference difference) {
    const std::lock_guard lock(lock_);
    if (!first_ || std::tie(difference.time, difference.port) < std::tie(first_->time, first_->port))
        first_ = std::move(difference);
}

}  // namespace tactus
