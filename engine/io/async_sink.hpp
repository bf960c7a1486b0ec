// SPDX-License-Identifier: Apache-2.0
// A stream that is saved by its own thread, so that a slow disk delays no other stream.
#pragma once

#include "engine/io/streams.hpp"

#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace tactus::io {

/// Passes values to the keeper as they arrive and saves them immediately; values that arrive during a save are saved
/// together. A failed save is repeated every second, and finally by `finish`; the run continues.
class AsyncSink : public Sink {
public:
    /// `size`: bytes per value. The keeper must be open.
    AsyncSink(std::shared_ptr<StreamKeeper> keeper, std::size_t size);
    ~AsyncSink() override;

    void take(std::int64_t first, const std::byte* values, std::size_t count) override;
    void finish() override;
    std::string take_message() override;

private:
    struct Piece {
        std::int64_t first;
        std::vector<std::byte> values;
    };
    void work();
    void keep(const std::vector<Piece>& pieces);
    void stop();

    std::shared_ptr<StreamKeeper> keeper_;
    std::size_t size_;
    std::mutex lock_;
    std::condition_variable changed_;
    std::vector<Piece> waiting_;
    std::string message_;
    bool is_over_ = false, has_failed_ = false;
    std::thread thread_;
};

}  // namespace tactus::io
