// SPDX-License-Identifier: Apache-2.0
#include "tests/support/refused_threads.hpp"

#include <atomic>

namespace tactus::test {

namespace {

constexpr int all = 1 << 30;
std::atomic<int> allowed_threads{all}, asked_for{0};

}  // namespace

RefusedThreads::RefusedThreads(int allowed) {
    asked_for = 0;
    allowed_threads = allowed;
}

RefusedThreads::~RefusedThreads() { allowed_threads = all; }

int RefusedThreads::asked() const { return asked_for; }

bool refuses_thread() noexcept { return asked_for.fetch_add(1) >= allowed_threads.load(); }

}  // namespace tactus::test
