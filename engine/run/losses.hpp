// SPDX-License-Identifier: Apache-2.0
// What a run could not write to its end.
#pragma once

#include <string>
#include <vector>

namespace tactus::run {

/// Control thread.
class Losses {
public:
    /// Losses are added to `notices`, too.
    explicit Losses(std::vector<std::string>& notices) : notices_(notices) {}

    /// Adds a loss once; an empty text is none.
    void note(const std::string& loss);
    const std::vector<std::string>& list() const { return list_; }

private:
    std::vector<std::string>& notices_;
    std::vector<std::string> list_;
};

}  // namespace tactus::run
