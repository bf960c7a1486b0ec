// SPDX-License-Identifier: Apache-2.0
#include "engine/take/take_sink.hpp"

#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"

#include <algorithm>
#include <exception>
#include <utility>

namespace tactus::take {

namespace {

constexpr std::int64_t update_every_ns = 500'000'000;

}  // namespace

TakeSink::TakeSink(std::filesystem::path folder, Flicks period, std::size_t frame_bytes, std::vector<TakeFile> files,
                   Told told)
    : folder_(std::move(folder)),
      period_(period),
      frame_bytes_(frame_bytes),
      files_(std::move(files)),
      told_(std::move(told)) {}

void TakeSink::take(std::int64_t first, const std::byte* frames, std::size_t count) {
    try {
        write(first, frames, count);
    } catch (const Error&) {
        told_.cut();
        throw;
    }
}

void TakeSink::write(std::int64_t first, const std::byte* frames, std::size_t count) {
    if (is_over_) return;
    if (const std::int64_t end = std::max(first, told_.end(first)); end < first + static_cast<std::int64_t>(count)) {
        count = static_cast<std::size_t>(end - first);
        is_over_ = true;
        told_.ended(end);
    }
    if (count == 0) return;
    for (std::size_t i = 0; i < files_.size(); ++i) {
        const bool is_first = i == writers_.size();
        if (is_first)
            writers_.push_back(std::make_unique<TakeStreamWriter>(folder_ / files_[i].name, period_, first,
                                                                  files_[i].columns, frame_bytes_));
        writers_[i]->write(first, frames, count);
        // A file without any frame is not listed.
        if (is_first) told_.opened(files_[i], first);
    }
    const std::int64_t now = steady_ns();
    if (now < update_ns_) return;
    update_ns_ = now + update_every_ns;
    for (const auto& writer : writers_) writer->update();
}

void TakeSink::finish() {
    std::exception_ptr failure;
    for (std::size_t i = 0; i < writers_.size(); ++i) {
        try {
            writers_[i]->finish();
            told_.finished(files_[i].name, writers_[i]->frames());
        } catch (const Error&) {
            told_.cut();
            failure = std::current_exception();
        }
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace tactus::take
