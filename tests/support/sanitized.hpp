// SPDX-License-Identifier: Apache-2.0
// Whether this program is built with a sanitizer that holds memory and threads of its own.
#pragma once

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)  // GCC
#define TACTUS_SANITIZED true
#elif defined(__has_feature)  // Clang
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define TACTUS_SANITIZED true
#endif
#endif
#ifndef TACTUS_SANITIZED
#define TACTUS_SANITIZED false
#endif

namespace tactus::test {

constexpr bool sanitized = TACTUS_SANITIZED;

}  // namespace tactus::test
