// SPDX-License-Identifier: Apache-2.0
// A lane of background work in which nothing goes on.
#pragma once

#include "tools/analysis/beside.hpp"

#include <atomic>
#include <memory>

namespace tactus::test {

/// Keeps a lane busy until its end.
class HeldLane {
public:
    explicit HeldLane(analysis::Lane lane) {
        job_.begin(lane, [begun = begun_, goes_on = goes_on_] {
            *begun = true;
            begun->notify_all();
            goes_on->wait(false);
            return true;
        });
        begun_->wait(false);
    }
    ~HeldLane() {
        *goes_on_ = true;
        goes_on_->notify_all();
        job_.take();
    }

private:
    std::shared_ptr<std::atomic<bool>> begun_ = std::make_shared<std::atomic<bool>>(false),
                                       goes_on_ = std::make_shared<std::atomic<bool>>(false);
    analysis::Beside<bool> job_;
};

}  // namespace tactus::test
