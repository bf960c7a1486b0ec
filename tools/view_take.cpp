// SPDX-License-Identifier: Apache-2.0
#include "tools/stop_signals.hpp"
#include "tools/verbs.hpp"
#include "tools/view/view.hpp"

namespace tactus {

int view_verb(const TakeViewChoice& choice) { return view::view_take(choice, stop_on_signals()); }

}  // namespace tactus
