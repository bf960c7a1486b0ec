// SPDX-License-Identifier: Apache-2.0
// --from and --to: the stretch of a record that a verb analyses.
#pragma once

#include "assets/sound/stretch.hpp"
#include "tools/command/options.hpp"

#include <vector>

namespace tactus::command {

struct StretchChoice {
    std::vector<double> from, to;  ///< s; none: start, end
};

enum class StretchOf { each, both };  ///< one stretch of each record; of two records, one of both or one each

void add_stretch_options(VerbOptions& verb, StretchChoice& choice, StretchOf of = StretchOf::each);

/// Of record 0, or 1 of two. One value is for both.
sound::Stretch stretch_of(const StretchChoice& choice, std::size_t record = 0);

}  // namespace tactus::command
