// SPDX-License-Identifier: Apache-2.0
// The executable's own pthread_create comes before that of libc, also for calls from libstdc++.
#include "tests/engine/refused_threads.hpp"

#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>

namespace {

constexpr int all = 1 << 30;
std::atomic<int> allowed{all}, asked_for{0};

using Create = int(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);

}  // namespace

// Clang's sanitizers are part of the executable, so RTLD_NEXT would go past them.
extern "C" Create __interceptor_pthread_create __attribute__((weak));

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*),
                              void* argument) {
    static Create* const create = __interceptor_pthread_create
                                      ? __interceptor_pthread_create
                                      : reinterpret_cast<Create*>(dlsym(RTLD_NEXT, "pthread_create"));
    if (asked_for.fetch_add(1) >= allowed.load()) return EAGAIN;
    return create(thread, attributes, run, argument);
}

namespace tactus::test {

RefusedThreads::RefusedThreads(int number) {
    asked_for = 0;
    allowed = number;
}

RefusedThreads::~RefusedThreads() { allowed = all; }

int RefusedThreads::asked() const { return asked_for; }

}  // namespace tactus::test
