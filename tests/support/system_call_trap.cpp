// SPDX-License-Identifier: Apache-2.0
#include "tests/support/system_call_trap.hpp"

#include "tests/support/realtime_counters.hpp"

#if defined(__linux__) && defined(__x86_64__)

#include <sys/prctl.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>
#include <csignal>
#include <cstdint>

// Kernel headers of 5.10 do not name these.
#ifndef PR_SET_SYSCALL_USER_DISPATCH
#define PR_SET_SYSCALL_USER_DISPATCH 59
#endif

// System calls between begin and end are never trapped: the return from the handler, and the call done on behalf of
// the trapped code (number and six arguments, as in the C calling convention).
asm(R"(
    .text
    .type tactus_untrapped_begin, @function
tactus_untrapped_begin:
tactus_untrapped_return:
    mov $15, %eax
    syscall
    .type tactus_untrapped_call, @function
tactus_untrapped_call:
    mov %rdi, %rax
    mov %rsi, %rdi
    mov %rdx, %rsi
    mov %rcx, %rdx
    mov %r8, %r10
    mov %r9, %r8
    mov 8(%rsp), %r9
    syscall
    ret
tactus_untrapped_end:
)");

extern "C" {
void tactus_untrapped_begin();
void tactus_untrapped_return();
long tactus_untrapped_call(long number, long a, long b, long c, long d, long e, long f);
void tactus_untrapped_end();
}

namespace tactus {
namespace {

constexpr int dispatch_off = 0;
constexpr int dispatch_on = 1;
constexpr char allow = 0;
constexpr char block = 1;
thread_local constinit volatile char selector = allow;

// The kernel's sigaction, with a return path of our own: libc's would itself be trapped.
struct KernelAction {
    void (*handler)(int, siginfo_t*, void*);
    unsigned long flags;
    void (*restorer)();
    unsigned long mask;
};

// Calls that change the stack, the signal mask or the control flow cannot be done from within a handler.
bool must_run_in_place(long number) {
    return number == SYS_clone || number == SYS_clone3 || number == SYS_vfork || number == SYS_fork ||
           number == SYS_rt_sigreturn || number == SYS_rt_sigprocmask;
}

void on_trap(int, siginfo_t* info, void* context) {
    auto& registers = static_cast<ucontext_t*>(context)->uc_mcontext.gregs;
    const long number = info->si_syscall;
    count_system_call(number);
    if (must_run_in_place(number)) {
        constexpr int syscall_instruction_bytes = 2;
        selector = allow;  // and the trap stays open: one violation was counted
        registers[REG_RIP] -= syscall_instruction_bytes;
        registers[REG_RAX] = number;
        return;
    }
    registers[REG_RAX] = tactus_untrapped_call(number, registers[REG_RDI], registers[REG_RSI], registers[REG_RDX],
                                               registers[REG_R10], registers[REG_R8], registers[REG_R9]);
}

}  // namespace

bool arm_system_call_trap() {
    if (!interposes_locks()) return false;
    constexpr unsigned long restorer_flag = 0x04000000;
    const KernelAction action{on_trap, SA_SIGINFO | restorer_flag, tactus_untrapped_return, 0};
    if (syscall(SYS_rt_sigaction, SIGSYS, &action, nullptr, sizeof action.mask) != 0) return false;
    const auto begin = reinterpret_cast<std::uintptr_t>(&tactus_untrapped_begin);
    const auto end = reinterpret_cast<std::uintptr_t>(&tactus_untrapped_end);
    selector = allow;
    if (prctl(PR_SET_SYSCALL_USER_DISPATCH, dispatch_on, begin, end - begin, &selector) != 0) return false;
    selector = block;
    return true;
}

void disarm_system_call_trap() {
    selector = allow;
    prctl(PR_SET_SYSCALL_USER_DISPATCH, dispatch_off, 0, 0, 0);
}

bool traps_system_calls() noexcept { return selector == block; }

}  // namespace tactus

#else

namespace tactus {

bool arm_system_call_trap() { return false; }
void disarm_system_call_trap() {}
bool traps_system_calls() noexcept { return false; }

}  // namespace tactus

#endif
