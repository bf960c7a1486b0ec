// SPDX-License-Identifier: Apache-2.0
#include "tools/verbs.hpp"
#include "tools/view/view.hpp"

#include <csignal>

namespace tactus {

namespace {

std::atomic<bool> interrupted{false};

}  // namespace

int view_verb(const TakeViewChoice& choice) {
    std::signal(SIGINT, [](int) { interrupted = true; });
    std::signal(SIGTERM, [](int) { interrupted = true; });
    return view::view_take(choice, interrupted);
}

}  // namespace tactus
