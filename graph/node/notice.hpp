// SPDX-License-Identifier: Apache-2.0
// Messages of a node to the user during a run, such as the reason why a button press has no effect. The tick only
// increments a counter; a thread that may block formats the message.
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
    /// `text` must be a string literal.
    explicit Notice(const char* text);
    ~Notice();
    Notice(const Notice&) = delete;
    Notice& operator=(const Notice&) = delete;

    /// Call in `prepare`. Connects the node's notices to the run.
    void attach(const Setup& setup);
    /// Call in a tick. Wait-free.
    void tell() noexcept { told_.fetch_add(1, std::memory_order_relaxed); }

private:
    friend std::vector<std::string> take_notices(const Host& host);

    const char* text_;
    std::string node_;
    const Host* host_ = nullptr;
    std::atomic<std::uint64_t> told_{0};
    std::uint64_t taken_ = 0;
};

/// Returns "NODE: text" for each notice of a run's nodes that was raised since the last call, once however often it was
/// raised. For one thread of the run other than the tick thread.
std::vector<std::string> take_notices(const Host& host);

}  // namespace tactus
