// SPDX-License-Identifier: Apache-2.0
// What a plug-in and the program that loads it must have in common: C++ fixes neither the layout of std::string nor the names
// of functions, so both must be compiled from the same headers, by the same compiler, with the same options that matter.
#pragma once

#include "graph/node/abi_headers.hpp"
#include "graph/node/node.hpp"

#include <cstdint>
#include <initializer_list>

namespace tactus {

// The compiler and its major version: "GCC 12".
#define TACTUS_ABI_TEXT_OF(x) #x
#define TACTUS_ABI_TEXT(x) TACTUS_ABI_TEXT_OF(x)
#ifdef __clang__
#define TACTUS_ABI_COMPILER "clang " TACTUS_ABI_TEXT(__clang_major__)
#else
#define TACTUS_ABI_COMPILER "GCC " TACTUS_ABI_TEXT(__GNUC__)
#endif

// Options that change layouts or arithmetic; "" with none of them.
#if defined(_GLIBCXX_USE_CXX11_ABI) && !_GLIBCXX_USE_CXX11_ABI
#define TACTUS_ABI_STRINGS " -D_GLIBCXX_USE_CXX11_ABI=0"
#else
#define TACTUS_ABI_STRINGS ""
#endif
#ifdef _GLIBCXX_DEBUG
#define TACTUS_ABI_CONTAINERS " -D_GLIBCXX_DEBUG"
#else
#define TACTUS_ABI_CONTAINERS ""
#endif
#ifdef __FAST_MATH__
#define TACTUS_ABI_ARITHMETIC " -ffast-math"
#else
#define TACTUS_ABI_ARITHMETIC ""
#endif
#ifdef GLM_FORCE_QUAT_DATA_WXYZ
#define TACTUS_ABI_QUATERNIONS " -DGLM_FORCE_QUAT_DATA_WXYZ"
#else
#define TACTUS_ABI_QUATERNIONS ""
#endif

/// One side of the comparison. Texts have static lifetime.
struct Abi {
    const char* headers;  ///< version and digest of the headers: "0.1.0-5e884898da280471"
    const char* compiler;  ///< "GCC 12"
    const char* options;  ///< " -ffast-math"; "" for none
    std::uint64_t layout;  ///< of sizes and alignments, which other options may change
};

/// That of the code that calls it.
constexpr Abi this_abi() {
    std::uint64_t layout = 0xcbf29ce484222325ULL;  // FNV-1a, which is constexpr
    for (const std::size_t size :
         {sizeof(Input),      alignof(Input),     sizeof(Output),    sizeof(SnapshotOutput), sizeof(Param),
          sizeof(Choice),     sizeof(Text),       sizeof(Flag),      sizeof(Vector),         alignof(Vector),
          sizeof(AssetParam), sizeof(NodeType),   sizeof(ValueType), sizeof(Tick),           sizeof(Setup),
          sizeof(Report),     sizeof(DevicePort), sizeof(Event),     sizeof(Pose),           alignof(Pose),
          sizeof(Wrench),     sizeof(long double)})
        layout = (layout ^ size) * 0x100000001b3ULL;
    return {TACTUS_ABI_HEADERS, TACTUS_ABI_COMPILER,
            TACTUS_ABI_STRINGS TACTUS_ABI_CONTAINERS TACTUS_ABI_ARITHMETIC TACTUS_ABI_QUATERNIONS, layout};
}

}  // namespace tactus
