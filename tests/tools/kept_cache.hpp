// SPDX-License-Identifier: Apache-2.0
// A cache folder of its own, for as long as this lives.
#pragma once

#include "tests/tools/run_command.hpp"

#include <cstdlib>

namespace tactus::test {

struct KeptCache {
    Folder folder;
    KeptCache() { ::setenv("XDG_CACHE_HOME", folder.path.c_str(), 1); }
    ~KeptCache() { ::unsetenv("XDG_CACHE_HOME"); }
    KeptCache(const KeptCache&) = delete;
    KeptCache& operator=(const KeptCache&) = delete;
};

}  // namespace tactus::test
