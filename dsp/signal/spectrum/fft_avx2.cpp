// SPDX-License-Identifier: Apache-2.0
// Compiled with -mavx2. It includes nothing else: inline functions of other headers would be compiled for AVX2 too, and
// the linker might use them everywhere.
#include "dsp/signal/spectrum/fft_kernel.hpp"

#if defined(__x86_64__)

namespace tactus::signal::detail {

namespace {
struct Avx2;
}

template <class T>
const LaneKernels<T>& lane_kernels_of_avx2() noexcept {
    static constexpr LaneKernels<T> kernels = LaneKernels<T>::template of<Avx2>();
    return kernels;
}

template const LaneKernels<double>& lane_kernels_of_avx2() noexcept;
template const LaneKernels<float>& lane_kernels_of_avx2() noexcept;

}  // namespace tactus::signal::detail

#endif
