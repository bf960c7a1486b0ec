// SPDX-License-Identifier: Apache-2.0
// Old spellings of option values, for VerbOptions::old.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace tactus::command {

/// Renames the value `before` of `option` to `now`, also in a list "a,b".
inline void rename_value(std::vector<std::string>& words, const std::string& option, const std::string& before,
                         const std::string& now) {
    const auto rename = [&](std::string& text, std::size_t from) {
        for (std::size_t at = from; at <= text.size();) {
            const std::size_t end = std::min(text.find(',', at), text.size());
            if (text.compare(at, end - at, before) == 0) {
                text.replace(at, end - at, now);
                at += now.size() + 1;
            } else at = end + 1;
        }
    };
    for (std::size_t i = 0; i < words.size(); ++i)
        if (words[i].starts_with(option + "=")) rename(words[i], option.size() + 1);
        else if (words[i] == option)
            for (std::size_t k = i + 1; k < words.size() && !words[k].starts_with('-'); ++k) rename(words[k], 0);
}

}  // namespace tactus::command
