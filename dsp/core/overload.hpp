// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tactus {

/// One function object of several, for std::visit: Overload{[](const A&) {…}, [](const B&) {…}}.
template <class... Each>
struct Overload : Each... {
    using Each::operator()...;
};
template <class... Each>
Overload(Each...) -> Overload<Each...>;

}  // namespace tactus
