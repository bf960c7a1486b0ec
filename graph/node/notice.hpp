// SPDX-License-Identifier: Apache-2.0
// What a node tells the user while it runs, as why a press of a button does nothing. The tick only counts; a thread that
// may wait makes a line of it.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

namespace tactus {

class Host;
struct Setup;

/// A member of a node, with its text. It need not be listed in TACTUS_NODE.
class Notice {
public:
    /// `text`: a literal.
    explicit Notice(const char* text);
    ~Notice();
    Notice(const Notice&) = delete;
    Notice& operator=(const Notice&) = delete;

    /// In `prepare`: from now on the notices of this node reach the run.
    void attach(const Setup& setup);
    /// In a tick. Wait-free.
    void tell() noexcept { told_.fetch_add(1, std::memory_order_relaxed); }

private:
    friend std::vector<std::string> take_notices(const Host& host);

    const char* text_;
    std::string node_;
    const Host* host_ = nullptr;
    std::atomic<std::uint64_t> told_{0};
    std::uint64_t taken_ = 0;
};

/// "NODE: text" of each notice of a run's nodes that was told since the last call; once, however often it was told. For
/// one thread of the run, which does not tick.
std::vector<std::string> take_notices(const Host& host);

}  // namespace tactus
