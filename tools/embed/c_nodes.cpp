// SPDX-License-Identifier: Apache-2.0
// The C function that declares a node type of the program.
#include "tools/embed/c_errors.hpp"
#include "tools/embed/host_node.hpp"
#include "tools/embed/tactus.h"

using namespace tactus;

extern "C" {

int tactus_declare_node(const tactus_node_type* type, tactus_error* error) {
    return embed::guarded(error, -1, [&] {
        if (!type) throw Error("there is no node type: NULL was given");
        if (type->size != sizeof(*type))
            throw Error(
                "tactus_node_type.size must be sizeof(tactus_node_type) of the header that the program was compiled "
                "with");
        embed::declare_node(*type);
        return 0;
    });
}

}  // extern "C"
