// SPDX-License-Identifier: Apache-2.0
#include "engine/take/take_compare.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <tuple>

namespace tactus::take {

namespace {

bool same_bits(const double* a, const double* b, std::size_t count) {
    return std::equal(a, a + count, b, [](double x, double y) {
        return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
    });
}

class CompareSink : public io::Sink {
public:
    /// `stretches`: the streams of that output, in the order of their times.
    CompareSink(TakeComparison& comparison, const Take& take, std::vector<TakeStreamInfo> stretches,
                const ValueType& type)
        : comparison_(comparison),
          folder_(take.folder),
          stretches_(std::move(stretches)),
          type_(type),
          names_(channels_of(type)),
          got_(names_.size()) {
        open();
    }

    void take(std::int64_t first, const std::byte* values, std::size_t count) override {
        std::uint64_t compared = 0;
        for (std::size_t i = 0; i < count && !differs_; ++i) {
            const std::int64_t tick = first + static_cast<std::int64_t>(i);
            const double* expected = recorded(tick);
            if (!expected) continue;
            to_frame(type_, values + i * type_.size, got_.data());
            ++compared;
            if (same_bits(expected, got_.data(), got_.size())) continue;
            // What follows a difference differs too.
            differs_ = true;
            comparison_.differs({stretches_.front().port,
                                 tick,
                                 seconds(tick * stretches_.front().period),
                                 names_,
                                 {expected, expected + got_.size()},
                                 got_});
        }
        comparison_.count(compared);
    }
    void finish() override {}

private:
    void open() {
        const TakeStreamInfo& info = stretches_[at_];
        reader_ = std::make_unique<TakeStreamReader>(folder_ / info.file, info);
        if (reader_->channels() != static_cast<int>(names_.size()))
            throw Error(fmt::format("{}: {} channels, but a {} has {}", info.file, reader_->channels(), type_.name,
                                    names_.size()));
    }
    /// Null where nothing was recorded: before, between and after.
    const double* recorded(std::int64_t tick) {
        while (tick >= stretches_[at_].start + reader_->frames() && at_ + 1 < stretches_.size()) {
            ++at_;
            open();
        }
        return reader_->frame(tick);
    }

    TakeComparison& comparison_;
    std::filesystem::path folder_;
    std::vector<TakeStreamInfo> stretches_;
    std::size_t at_ = 0;
    const ValueType& type_;
    std::vector<std::string> names_;
    std::vector<double> got_;
    std::unique_ptr<TakeStreamReader> reader_;
    bool differs_ = false;
};

}  // namespace

std::unique_ptr<io::Stream> TakeComparison::tap(const std::string& port, const ValueType& type,
                                                const run::GroupRuntime& group) {
    std::vector<TakeStreamInfo> stretches;
    for (const TakeStreamInfo& stream : take_.streams)
        if (stream.port == port && stream.group_number == group.index && stream.type == type.name)
            stretches.push_back(stream);
    if (stretches.empty()) return nullptr;
    std::ranges::sort(stretches, {}, &TakeStreamInfo::start);
    StreamFormat format;
    format.file = stretches.front().file;
    format.type = &type;
    format.period = stretches.front().period;
    return std::make_unique<io::Stream>(format,
                                        std::make_unique<CompareSink>(*this, take_, std::move(stretches), type));
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

}  // namespace tactus::take
