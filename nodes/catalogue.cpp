// SPDX-License-Identifier: Apache-2.0
// One line per node type, sorted. A test fails when a file of nodes/ is missing here.
#include "nodes/catalogue.hpp"

#include <algorithm>
#include <vector>

// name of the struct, family (folder), file
#define TACTUS_NODES(X) \
    X(Constant, input)  \
    X(Gain, vibration)

namespace tactus {

#define X(Type, family) const NodeType& node_type_##Type();
TACTUS_NODES(X)
#undef X

Catalogue catalogue() {
    static const std::vector<const NodeType*> types = [] {
        std::vector<const NodeType*> all{
#define X(Type, family) &node_type_##Type(),
            TACTUS_NODES(X)
#undef X
        };
        std::ranges::sort(all, {}, &NodeType::name);
        return all;
    }();
    return types;
}

}  // namespace tactus
