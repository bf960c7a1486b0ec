// SPDX-License-Identifier: Apache-2.0
// What the verbs that read and write bones are given: import, info, export.
#pragma once

#include "tools/verbs.hpp"

namespace CLI {
class App;
}

namespace tactus {

struct BoneChoices {
    ImportChoice import;
    InfoChoice info;
    ExportChoice surface;
};

void add_bone_verbs(CLI::App& app, BoneChoices& choices);

}  // namespace tactus
