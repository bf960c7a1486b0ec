// SPDX-License-Identifier: Apache-2.0
#include "engine/io/async_sink.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

namespace tactus::io {

namespace {

constexpr std::chrono::seconds before_another_try{1};

}  // namespace

AsyncSink::AsyncSink(std::shared_ptr<StreamKeeper> keeper, std::size_t size)
    : keeper_(std::move(keeper)), size_(size), thread_([this] { work(); }) {}

AsyncSink::~AsyncSink() { stop(); }

void AsyncSink::take(std::int64_t first, const std::byte* values, std::size_t count) {
    const std::lock_guard lock(lock_);
    waiting_.push_back({first, {values, values + count * size_}});
    changed_.notify_one();
}

void AsyncSink::keep(const std::vector<Piece>& pieces) {
    for (const Piece& piece : pieces) keeper_->take(piece.first, piece.values.data(), piece.values.size() / size_);
    std::string said;
    try {
        keeper_->save();
        if (has_failed_) said = "all that could not be saved before is saved now";
        has_failed_ = false;
    } catch (const Error& error) {
        if (!has_failed_) said = fmt::format("{}; it is tried again every second", error.message());
        has_failed_ = true;
    }
    const std::lock_guard lock(lock_);
    if (!said.empty()) message_ = std::move(said);
}

void AsyncSink::work() {
    for (;;) {
        std::vector<Piece> pieces;
        {
            std::unique_lock lock(lock_);
            const auto wanted = [this] { return is_over_ || !waiting_.empty(); };
            if (has_failed_) changed_.wait_for(lock, before_another_try, wanted);
            else changed_.wait(lock, wanted);
            if (is_over_ && waiting_.empty()) return;
            pieces.swap(waiting_);
        }
        keep(pieces);
    }
}

void AsyncSink::stop() {
    if (!thread_.joinable()) return;
    {
        const std::lock_guard lock(lock_);
        is_over_ = true;
    }
    changed_.notify_one();
    thread_.join();
}

void AsyncSink::finish() {
    stop();
    keeper_->finish();
}

std::string AsyncSink::take_message() {
    const std::lock_guard lock(lock_);
    return std::exchange(message_, {});
}

}  // namespace tactus::io
