// SPDX-License-Identifier: Apache-2.0
// Exceptions as texts, for functions that C calls.
#pragma once

#include "dsp/core/error.hpp"
#include "tools/embed/embedded.hpp"
#include "tools/embed/tactus.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <exception>
#include <new>
#include <string_view>

namespace tactus::embed {

template <std::size_t size>
void put_text(char (&to)[size], std::string_view text) {
    const std::size_t count = std::min(text.size(), size - 1);
    std::memcpy(to, text.data(), count);
    to[count] = '\0';
}

inline void put_error(tactus_error* error, std::string_view text, const SourceLocation& where = {}) {
    if (!error) return;
    put_text(error->text, text);
    put_text(error->file, where.file);
    error->line = where.line;
    error->column = where.column;
}

/// Runs `work` and gives what it returns, or `failed` with the reason in `error`.
template <class Result, class Work>
Result guarded(tactus_error* error, Result failed, const Work& work) noexcept {
    put_error(error, "");
    try {
        return work();
    } catch (const PatchErrors& failure) {
        put_error(error, failure.all(), failure.where());
    } catch (const Error& failure) {
        put_error(error, failure.what(), failure.where());
    } catch (const std::bad_alloc&) {
        put_error(error, "no memory is left");
    } catch (const std::exception& failure) {
        put_error(error, failure.what());
    } catch (...) {
        put_error(error, "an unknown failure");
    }
    return failed;
}

}  // namespace tactus::embed
