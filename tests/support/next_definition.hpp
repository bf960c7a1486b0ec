// SPDX-License-Identifier: Apache-2.0
// For functions of the C library that the test programs define themselves.
#pragma once

#include <dlfcn.h>

#include <atomic>

namespace tactus::test {

/// The next definition after the program's own, looked up once. pthread_cond_* exist in two versions; the old one is
/// incompatible.
inline void* next_definition(std::atomic<void*>& cached, const char* name) noexcept {
    void* found = cached.load(std::memory_order_relaxed);
    if (!found) found = ::dlvsym(RTLD_NEXT, name, "GLIBC_2.3.2");
    if (!found) found = ::dlsym(RTLD_NEXT, name);
    cached.store(found, std::memory_order_relaxed);
    return found;
}

}  // namespace tactus::test

/// TACTUS_NEXT(nanosleep)(&duration, &left) calls what `nanosleep` would be without the program's own definition.
#define TACTUS_NEXT(function)                                      \
    reinterpret_cast<decltype(&function)>([]() noexcept -> void* { \
        static std::atomic<void*> cached{nullptr};                 \
        return ::tactus::test::next_definition(cached, #function); \
    }())
