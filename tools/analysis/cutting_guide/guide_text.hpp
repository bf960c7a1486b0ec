// SPDX-License-Identifier: Apache-2.0
// What is engraved on a guide.
#pragma once

#include "dsp/cutting_guide/guide.hpp"
#include "tools/analysis/cutting_guide/plan_guide.hpp"

#include <string>
#include <string_view>

namespace tactus::analysis {

/// The chosen label, else the title, shortened. Throws Error for a label that is too long or not printable ASCII.
std::string label_of(const std::string& title, const std::string& chosen);

/// The pseudonym (the choice's label, else the title) with the side, then RESEARCH and an arrow, and a letter per slot or
/// fragment. Throws Error as label_of does.
void add_texts(cutting_guide::GuideDesign& design, const std::string& title, const GuideChoice& choice,
               const std::string& side, bool arrow_to_right, std::string_view marks);

/// Outlines of words whose capitals have this height, m.
cutting_guide::GuideText engraved(const std::string& words, double height);

}  // namespace tactus::analysis
