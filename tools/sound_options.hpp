// SPDX-License-Identifier: Apache-2.0
// What the verbs that judge and shape vibration are given: compare, validate, measure, equalise.
#pragma once

#include "tools/verbs.hpp"

namespace CLI {
class App;
}

namespace tactus {

struct SoundChoices {
    CompareChoice compare;
    ValidateChoice validate;
    MeasureChoice measure;
    EqualiseChoice equalise;
};

void add_sound_verbs(CLI::App& app, SoundChoices& choices);

}  // namespace tactus
