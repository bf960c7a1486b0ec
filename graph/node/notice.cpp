// SPDX-License-Identifier: Apache-2.0
#include "graph/node/notice.hpp"

#include "graph/node/setup.hpp"

#include <algorithm>
#include <mutex>

namespace tactus {

namespace {

/// The notices of all nodes that exist: an edit makes nodes on one thread while another takes notices.
struct Notices {
    std::mutex mutex;
    std::vector<Notice*> all;
};

Notices& notices() {
    static Notices made;
    return made;
}

}  // namespace

Notice::Notice(const char* text) : text_(text) {
    const std::lock_guard lock(notices().mutex);
    notices().all.push_back(this);
}

Notice::~Notice() {
    const std::lock_guard lock(notices().mutex);
    std::erase(notices().all, this);
}

void Notice::attach(const Setup& setup) {
    const std::lock_guard lock(notices().mutex);
    node_ = setup.name;
    host_ = setup.host;
}

std::vector<std::string> take_notices(const Host& host) {
    std::vector<std::string> lines;
    const std::lock_guard lock(notices().mutex);
    for (Notice* one : notices().all) {
        if (one->host_ != &host) continue;
        const std::uint64_t told = one->told_.load(std::memory_order_relaxed);
        if (told == one->taken_) continue;
        one->taken_ = told;
        lines.push_back(one->node_ + ": " + one->text_);
    }
    return lines;
}

}  // namespace tactus
