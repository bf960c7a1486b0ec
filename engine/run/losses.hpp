// SPDX-License-Identifier: Apache-2.0
// Recordings that a run could not complete.
#pragma once

#include <string>
#include <vector>

namespace tactus::run {

/// Control thread.
class Losses {
public:
    /// Losses are also added to `notices`.
    explicit Losses(std::vector<std::string>& notices) : notices_(notices) {}

    /// Adds a loss once; ignores an empty text.
    void note(const std::string& loss);
    const std::vector<std::string>& list() const { return list_; }

private:
    std::vector<std::string>& notices_;
    std::vector<std::string> list_;
};

}  // namespace tactus::run
