// SPDX-License-Identifier: Apache-2.0
// A stream that is kept on a thread of its own: what waits for a disk holds nobody else up.
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

/// Values go to the keeper as they come and are saved at once, those that came meanwhile together. What cannot be saved
/// is tried again every second, and at last by `finish`; the run goes on.
class AsyncSink : public Sink {
public:
    /// `size` in bytes of a value; the keeper is open.
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
