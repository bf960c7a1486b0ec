// SPDX-License-Identifier: Apache-2.0
// One object of a C program has one user at a time.
#pragma once

#include "dsp/core/error.hpp"

#include <fmt/format.h>

namespace tactus::embed {

/// The right to use an object with an atomic `is_used`. Throws Error if it is null, or if another thread uses it.
template <class Object>
class Use {
public:
    explicit Use(Object* object, const char* what) : object_(object) {
        if (!object) throw Error(fmt::format("there is no {}: NULL was given", what));
        if (object->is_used.exchange(true))
            throw Error(fmt::format("another thread is using this {}; one at a time", what));
    }
    ~Use() { object_->is_used = false; }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    Object* operator->() const { return object_; }

private:
    Object* object_;
};

}  // namespace tactus::embed
