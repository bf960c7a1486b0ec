// SPDX-License-Identifier: Apache-2.0
// Sobol's low-discrepancy sequence: n samples in d dimensions leave gaps of about 1/n, where random ones leave 1/√n.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tactus::sweep {

inline constexpr std::size_t max_sobol_dimensions = 16;

/// Element `index` (below 2³²) of dimension `dimension`, as a fraction of 2³²: Gray-code order, direction numbers of Joe
/// and Kuo (2008, new-joe-kuo-6).
std::uint32_t sobol(std::uint64_t index, std::size_t dimension);

/// The same with a random digital shift (Cranley and Patterson's rotation in base 2): in (0, 1), uniform over seeds.
double shifted_sobol(std::uint64_t index, std::size_t dimension, std::uint64_t seed);

}  // namespace tactus::sweep
